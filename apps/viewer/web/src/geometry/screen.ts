// SPDX-License-Identifier: Apache-2.0
import { heightOver, type Axes, type PixelPlane, type Plane } from "./plane";
import { add, cross, dot, scale, sub, type Vec3 } from "./vec";

/** CSS pixels from a view's left and top edge. */
export type Point2 = readonly [number, number];

/** A view's canvas laid onto a plane: `center` is seen at its middle. */
export interface Screen {
  readonly axes: Axes;
  readonly center: Vec3;
  readonly mm_per_pixel: number; // CSS pixel
  readonly width: number;
  readonly height: number;
  /** How many times as far from a line or a point as by a mouse it is still taken: a finger hides what it touches. */
  readonly reach?: number;
}

export const planeOf = (screen: Screen): Plane => ({ ...screen.axes, origin: screen.center });

export function toScreen(screen: Screen, p: Vec3): Point2 {
  const d = sub(p, screen.center);
  return [screen.width / 2 + dot(d, screen.axes.u) / screen.mm_per_pixel, screen.height / 2 + dot(d, screen.axes.v) / screen.mm_per_pixel];
}

export function toWorld(screen: Screen, [x, y]: Point2): Vec3 {
  const right = scale(screen.axes.u, (x - screen.width / 2) * screen.mm_per_pixel);
  const down = scale(screen.axes.v, (y - screen.height / 2) * screen.mm_per_pixel);
  return add(screen.center, add(right, down));
}

/** The plane to ask a slice for, with `ratio` of its pixels to a CSS pixel. */
export function slicePlane(screen: Screen, ratio: number): PixelPlane {
  return {
    ...screen.axes,
    origin: toWorld(screen, [0.5 / ratio, 0.5 / ratio]),
    mm_per_pixel: screen.mm_per_pixel / ratio,
  };
}

/** What lies to the left of someone who walks along this direction of the screen, upright on the side to which the plane's normal points. */
export function leftOnScreen({ axes }: Screen, plane: Axes, [x, y]: Point2): Point2 {
  const left = cross(plane.normal, add(scale(axes.u, x), scale(axes.v, y)));
  return [dot(left, axes.u), dot(left, axes.v)];
}

export const depthBelow = (screen: Screen, p: Vec3): number => heightOver(planeOf(screen), p);

/** Where pixels of a slice lie on the screen: `x = a * column + dx`, `y = a * row + dy`. For slices parallel to the screen. */
export function sliceOnScreen(screen: Screen, slice: PixelPlane): { a: number; dx: number; dy: number } {
  const [dx, dy] = toScreen(screen, slice.origin);
  return { a: slice.mm_per_pixel / screen.mm_per_pixel, dx, dy };
}

export const gap = (a: Point2, b: Point2): number => Math.hypot(a[0] - b[0], a[1] - b[1]);

/** How wide the points lie across the direction in which they are spread most. */
export function narrowWidth(points: readonly Point2[]): number {
  const mean = (of: (p: Point2) => number) => points.reduce((sum, p) => sum + of(p), 0) / points.length;
  const x0 = mean(([x]) => x);
  const y0 = mean(([, y]) => y);
  const xx = mean(([x]) => (x - x0) ** 2);
  const yy = mean(([, y]) => (y - y0) ** 2);
  const xy = mean(([x, y]) => (x - x0) * (y - y0));
  const longest = Math.atan2(2 * xy, xx - yy) / 2; // the principal axis
  const across = points.map(([x, y]) => (y - y0) * Math.cos(longest) - (x - x0) * Math.sin(longest));
  return across.reduce((a, b) => Math.max(a, b)) - across.reduce((a, b) => Math.min(a, b));
}

/** The nearest point of the line from `a` to `b`: its distance, and where it lies from 0 (`a`) to 1 (`b`). */
export function nearestOnLine(p: Point2, a: Point2, b: Point2): { distance: number; t: number } {
  const dx = b[0] - a[0];
  const dy = b[1] - a[1];
  const squared = dx * dx + dy * dy;
  const t = squared === 0 ? 0 : Math.min(1, Math.max(0, ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared));
  return { distance: Math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy), t };
}

/** The part of the line through `p` along `d` that lies within width x height; null when none does. */
export function clippedLine(p: Point2, d: Point2, width: number, height: number): [Point2, Point2] | null {
  let from = -Infinity;
  let to = Infinity;
  for (const [at, step, size] of [
    [p[0], d[0], width],
    [p[1], d[1], height],
  ] as const) {
    if (Math.abs(step) < 1e-9) {
      if (at < 0 || at > size) return null;
      continue;
    }
    const ends = [-at / step, (size - at) / step].sort((a, b) => a - b) as [number, number];
    from = Math.max(from, ends[0]);
    to = Math.min(to, ends[1]);
  }
  if (from >= to) return null;
  return [
    [p[0] + from * d[0], p[1] + from * d[1]],
    [p[0] + to * d[0], p[1] + to * d[1]],
  ];
}
