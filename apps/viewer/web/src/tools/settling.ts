// SPDX-License-Identifier: Apache-2.0
import { heightOver, type Plane } from "../geometry/plane";
import { distance, mix, type Vec3 } from "../geometry/vec";
import type { Conflict, Contour } from "../net/protocol";

/** A pull that takes a contour's line from one place to another. */
export interface Pull {
  id: number;
  from: Vec3;
  to: Vec3;
}

/** Where the line crosses the plane, nearest to `at`; null where it does not. */
export function crossingNear(points: readonly Vec3[], plane: Plane, at: Vec3, isClosed = true): Vec3 | null {
  let nearest: Vec3 | null = null;
  points.forEach((p, i) => {
    const q = points[i + 1] ?? points[isClosed ? 0 : i]!;
    const a = heightOver(plane, p);
    const b = heightOver(plane, q);
    if (a > 0 === b > 0) return;
    const crossing = mix(p, q, a / (a - b));
    if (!nearest || distance(crossing, at) < distance(nearest, at)) nearest = crossing;
  });
  return nearest;
}

/** Bends `yielding` at the conflict to where `kept` crosses its plane; null where one of them does not cross the other's plane. */
export function settled({ at }: Conflict, kept: Contour, yielding: Contour): Pull | null {
  const to = crossingNear(kept.points, yielding.plane, at, kept.closed);
  const from = crossingNear(yielding.points, kept.plane, at, yielding.closed);
  return from && to && { id: yielding.id, from, to };
}

/** Of conflicts of the same two contours at one place the largest. */
export function distinct(conflicts: readonly Conflict[], apart_mm = 2): Conflict[] {
  const pair = ({ contours }: Conflict) => [...contours].sort((a, b) => a - b).join();
  return conflicts.filter((one, i) => !conflicts.slice(0, i).some((other) => pair(other) === pair(one) && distance(other.at, one.at) < apart_mm));
}
