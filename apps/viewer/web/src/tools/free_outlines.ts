// SPDX-License-Identifier: Apache-2.0
import { heightOver, pixelToWorld, type PixelPlane, type Plane } from "../geometry/plane";
import { isInside, nearestOnPath, type NearPlace } from "../geometry/loop";
import { planeOf, toScreen, type Point2, type Screen } from "../geometry/screen";
import { dot, sub, type Vec3 } from "../geometry/vec";
import type { Project } from "../model/project";
import type { LineRun } from "../net/protocol";
import { inView } from "./hit";

/** Where the surface of this revision cuts a view's plane, in pixels of the plane, column and row alternating. */
export interface Outline {
  structure: number;
  revision: number;
  points: ArrayLike<number>;
  lines: LineRun[];
  /** What the contours alone make, where the image was used. */
  without_image?: LineRun[];
}

/** The outlines that a view shows, and the plane that they were cut with. */
export interface ShownOutlines {
  plane: PixelPlane;
  outlines: Iterable<Outline>;
}

/** A closed line in which a computed surface cuts the slice, where nothing of that structure is drawn on it. */
export interface FreeOutline {
  structure: number;
  points: readonly Vec3[];
  seen: readonly Point2[]; // the same on the screen
  isHole: boolean;
}

const SAME_SLICE_MM = 1e-3; // outlines of a slice that was shown before are not this slice's

/** What of the outlines can be made a contour. Where the structure has one already, that one is to be changed, and not a second one laid over it. */
export function freeOutlines({ plane, outlines }: ShownOutlines, project: Project, screen: Screen, step_mm: number): FreeOutline[] {
  if (Math.abs(heightOver(planeOf(screen), plane.origin)) > SAME_SLICE_MM) return [];
  const drawn = [...project.contours.values()].filter((contour) => project.isOfTime(contour) && inView(contour, screen, step_mm));
  return [...outlines].flatMap((outline) => {
    if (!project.structures.get(outline.structure)?.visible) return [];
    const contours = drawn.filter(({ structure }) => structure === outline.structure).map(({ points }) => points.map((p) => toScreen(screen, p)));
    return closedLines(outline, plane, screen).filter(({ seen }) => !contours.some((contour) => boxesMeet(contour, seen)));
  });
}

/** A structure's closed outlines as the screen has them; none of a slice that was shown before. */
export function linesOf({ plane, outlines }: ShownOutlines, structure: number, screen: Screen): Point2[][] {
  if (Math.abs(heightOver(planeOf(screen), plane.origin)) > SAME_SLICE_MM) return [];
  const own = [...outlines].filter((outline) => outline.structure === structure);
  return own.flatMap((outline) => closedLines(outline, plane, screen).map(({ seen }) => [...seen]));
}

function closedLines({ structure, points, lines }: Outline, plane: PixelPlane, screen: Screen): FreeOutline[] {
  const world = lines
    .filter(({ closed, count }) => closed && count >= 3)
    .map(({ first, count }) => Array.from({ length: count }, (_, i) => pixelToWorld(plane, points[2 * (first + i)]!, points[2 * (first + i) + 1]!)));
  const seen = world.map((line) => line.map((p) => toScreen(screen, p)));
  return world.map((line, i) => {
    return { structure, points: line, seen: seen[i]!, isHole: isHole(seen[i]!, seen) };
  });
}

/** Whether the structure lies outside of this line, one of those in which its surface cuts a plane. */
function isHole(line: readonly Point2[], all: readonly (readonly Point2[])[]): boolean {
  return all.filter((other) => other !== line && isInside(other, line[0]!)).length % 2 === 1;
}

/** The same of lines in space. */
export function isHoleOf(line: readonly Vec3[], all: readonly (readonly Vec3[])[], { origin, u, v }: Plane): boolean {
  const laid = all.map((one) => one.map((p): Point2 => [dot(sub(p, origin), u), dot(sub(p, origin), v)]));
  return isHole(laid[all.indexOf(line)]!, laid);
}

function boxesMeet(a: readonly Point2[], b: readonly Point2[]): boolean {
  return ([0, 1] as const).every((axis) => {
    const [from, to] = rangeOf(a, axis);
    const [first, last] = rangeOf(b, axis);
    return from <= last && first <= to;
  });
}

function rangeOf(points: readonly Point2[], axis: 0 | 1): [number, number] {
  let least = Infinity;
  let most = -Infinity;
  for (const p of points) {
    least = Math.min(least, p[axis]);
    most = Math.max(most, p[axis]);
  }
  return [least, most];
}

/** The outline that is nearest to the pointer, and where; null where there is none. */
export function nearestOutline(outlines: readonly FreeOutline[], pointer: Point2): { outline: FreeOutline; place: NearPlace } | null {
  const places = outlines.map((outline) => ({ outline, place: nearestOnPath(outline.seen, pointer) }));
  return places.reduce<(typeof places)[number] | null>((best, next) => (best && best.place.distance <= next.place.distance ? best : next), null);
}
