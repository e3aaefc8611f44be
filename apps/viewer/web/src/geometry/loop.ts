// SPDX-License-Identifier: Apache-2.0
// Lines, closed (the last point is followed by the first) or open.
import { gap, nearestOnLine, type Point2 } from "./screen";
import { add, distance, scale, type Vec3 } from "./vec";

/** The place of a line that is nearest to `p`; it lies between the points `index` and `index + 1`. */
export interface NearPlace {
  index: number;
  at: Point2;
  distance: number;
}

export function nearestOnPath(points: readonly Point2[], p: Point2, isClosed = true): NearPlace {
  let nearest: NearPlace = { index: 0, at: points[0]!, distance: gap(points[0]!, p) };
  points.slice(0, isClosed ? undefined : -1).forEach((a, index) => {
    const b = points[(index + 1) % points.length]!;
    const { distance: away, t } = nearestOnLine(p, a, b);
    if (away < nearest.distance) nearest = { index, at: [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])], distance: away };
  });
  return nearest;
}

/** Whether a ray from `p` to the right crosses the line an odd number of times. */
export function isInside(points: readonly Point2[], [x, y]: Point2): boolean {
  let inside = false;
  points.forEach((a, i) => {
    const b = points[(i + 1) % points.length]!;
    if (a[1] > y !== b[1] > y && x < a[0] + ((y - a[1]) / (b[1] - a[1])) * (b[0] - a[0])) inside = !inside;
  });
  return inside;
}

/** How far along the closed line each point is, and last how long it is. */
export function arcLengths(points: readonly Vec3[]): number[] {
  const at = [0];
  points.forEach((p, i) => void at.push(at[i]! + distance(p, points[(i + 1) % points.length]!)));
  return at;
}

/** An eighth of the line: how far the server lets a pull reach. */
export const pullReach = (points: readonly Vec3[]): number => arcLengths(points).at(-1)! / 8;

/** The line with the point `grabbed` moved by `by`, and its neighbours along the line within `radius_mm` less and less, as the server bends contours. */
export function pulled(points: readonly Vec3[], grabbed: number, by: Vec3, radius_mm: number): Vec3[] {
  const at = arcLengths(points);
  const whole = at.at(-1)!;
  return points.map((p, i) => {
    const direct = Math.abs(at[i]! - at[grabbed]!);
    const away = Math.min(direct, whole - direct) / radius_mm;
    return away >= 1 ? p : add(p, scale(by, (1 - away * away) ** 2));
  });
}

/** Places of an open line that are this far apart, the first one half as far from its beginning, and the way it leads there, of length 1. */
export function alongLine(points: readonly Point2[], step: number): { at: Point2; direction: Point2 }[] {
  const places: { at: Point2; direction: Point2 }[] = [];
  const whole = points.slice(1).reduce((sum, p, i) => sum + gap(points[i]!, p), 0);
  let next = Math.min(step, whole) / 2;
  points.slice(1).forEach((b, i) => {
    const a = points[i]!;
    const length = gap(a, b);
    for (; length > 0 && next <= length; next += step) {
      const direction: Point2 = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
      places.push({ at: [a[0] + next * direction[0], a[1] + next * direction[1]], direction });
    }
    next -= length;
  });
  return places;
}
