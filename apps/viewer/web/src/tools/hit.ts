// SPDX-License-Identifier: Apache-2.0
import { nearestOnPath } from "../geometry/loop";
import { commonDirection, coincide, type Axes } from "../geometry/plane";
import { clippedLine, gap, nearestOnLine, planeOf, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import { dot, type Vec3 } from "../geometry/vec";
import type { Contour, ViewName } from "../net/protocol";

export type ContourHit = { on: "point"; contour: number; index: number; at: Vec3 } | { on: "line"; contour: number; at: Vec3 };

const POINT_PIXELS = 8;
export const LINE_PIXELS = 6;

/** A contour drawn by hand has one control point, which only marks where it began: there is nothing to drag. */
export const hasHandles = (contour: Contour): boolean => contour.control.length > 1;

export function inView(contour: Contour, screen: Screen, step_mm: number): boolean {
  return coincide(contour.plane, planeOf(screen), step_mm / 2);
}

/** The contour under the pointer; points before lines, the selected contour before others. */
export function hitContour(contours: readonly Contour[], screen: Screen, step_mm: number, pointer: Point2, selected: number | null): ContourHit | null {
  const seen = contours.filter((contour) => inView(contour, screen, step_mm)).sort((a, b) => Number(b.id === selected) - Number(a.id === selected));
  for (const contour of seen) {
    const point = hitPoint(contour, screen, pointer);
    if (point) return point;
  }
  for (const contour of seen) {
    const line = hitLine(contour, screen, pointer);
    if (line) return line;
  }
  return null;
}

function hitPoint(contour: Contour, screen: Screen, pointer: Point2): ContourHit | null {
  if (!hasHandles(contour)) return null;
  let nearest = POINT_PIXELS * (screen.reach ?? 1);
  let hit: ContourHit | null = null;
  contour.control.forEach(({ at }, index) => {
    const distance = gap(toScreen(screen, at), pointer);
    if (distance > nearest) return;
    nearest = distance;
    hit = { on: "point", contour: contour.id, index, at };
  });
  return hit;
}

function hitLine(contour: Contour, screen: Screen, pointer: Point2): ContourHit | null {
  const { at, distance } = nearestOnPath(
    contour.points.map((p) => toScreen(screen, p)),
    pointer,
    contour.closed,
  );
  return distance > LINE_PIXELS * (screen.reach ?? 1) ? null : { on: "line", contour: contour.id, at: toWorld(screen, at) };
}

/** The line in which another view's plane cuts this one, with the handles that turn it. */
export interface PlaneLine {
  view: ViewName;
  ends: [Point2, Point2];
  handles: [Point2, Point2];
}

/** Null where the planes are parallel, or the line is out of sight. */
export function planeLine(screen: Screen, crosshair: Vec3, view: ViewName, other: Axes): PlaneLine | null {
  const direction = commonDirection(screen.axes, other);
  if (!direction) return null;
  const d: Point2 = [dot(direction, screen.axes.u), dot(direction, screen.axes.v)];
  const through = toScreen(screen, crosshair);
  const ends = clippedLine(through, d, screen.width, screen.height);
  if (!ends) return null;
  const reach = 0.33 * Math.min(screen.width, screen.height);
  const along = (s: number): Point2 => [through[0] + s * d[0], through[1] + s * d[1]];
  return { view, ends, handles: [along(-reach), along(reach)] };
}

export type LineHit = { on: "turn" | "move"; view: ViewName } | { on: "crosshair" };

export function hitPlaneLines(lines: readonly PlaneLine[], crosshair: Point2, pointer: Point2, reach = 1): LineHit | null {
  if (gap(crosshair, pointer) < 9 * reach) return { on: "crosshair" };
  for (const { view, handles } of lines) if (handles.some((handle) => gap(handle, pointer) < POINT_PIXELS * reach)) return { on: "turn", view };
  for (const { view, ends } of lines) if (nearestOnLine(pointer, ends[0], ends[1]).distance < LINE_PIXELS * reach) return { on: "move", view };
  return null;
}
