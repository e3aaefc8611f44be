// SPDX-License-Identifier: Apache-2.0
import { add, dot, length, cross, normalized, rotated, scale, sub, type Vec3 } from "./vec";

/** Orthonormal: `u` to the right of the screen, `v` down, `normal` into it. */
export interface Axes {
  readonly u: Vec3;
  readonly v: Vec3;
  readonly normal: Vec3;
}

export interface Plane extends Axes {
  readonly origin: Vec3;
}

/** The centre of pixel (column, row) lies at `origin + mm_per_pixel * (column * u + row * v)`. */
export interface PixelPlane extends Plane {
  readonly mm_per_pixel: number;
}

export const pixelToWorld = ({ origin, u, v, mm_per_pixel }: PixelPlane, column: number, row: number): Vec3 =>
  add(origin, add(scale(u, column * mm_per_pixel), scale(v, row * mm_per_pixel)));

/** Whether both name the same pixels, to the last bit. */
export const isSamePlane = (a: PixelPlane, b: PixelPlane): boolean =>
  a.mm_per_pixel === b.mm_per_pixel && (["origin", "u", "v"] as const).every((key) => a[key].every((value, axis) => value === b[key][axis]));

/** Signed distance in mm along the normal. */
export const heightOver = (plane: Plane, p: Vec3): number => dot(sub(p, plane.origin), plane.normal);

export const projected = (plane: Plane, p: Vec3): Vec3 => sub(p, scale(plane.normal, heightOver(plane, p)));

export function areParallel(a: Axes, b: Axes): boolean {
  return Math.abs(dot(a.normal, b.normal)) > 1 - 1e-6;
}

/** Whether `a` lies in `b`, or beside it by less than `tolerance_mm`. */
export function coincide(a: Plane, b: Plane, tolerance_mm: number): boolean {
  return areParallel(a, b) && Math.abs(heightOver(b, a.origin)) < tolerance_mm;
}

/** Turned about a unit axis, and orthonormal again whatever was lost by rounding. */
export function rotatedAxes(axes: Axes, axis: Vec3, angle: number): Axes {
  const normal = normalized(rotated(axes.normal, axis, angle));
  const turned = rotated(axes.u, axis, angle);
  const u = normalized(sub(turned, scale(normal, dot(turned, normal))));
  return { u, v: cross(normal, u), normal };
}

/** Direction of the line that both planes share, a unit vector; null for parallel planes. */
export function commonDirection(a: Axes, b: Axes): Vec3 | null {
  const direction = cross(a.normal, b.normal);
  return length(direction) < 1e-3 ? null : normalized(direction);
}

/** The least and largest distance of points along a direction, from `origin`. */
export function extent(points: readonly Vec3[], direction: Vec3, origin: Vec3): [number, number] {
  const along = points.map((p) => dot(sub(p, origin), direction));
  return [Math.min(...along), Math.max(...along)];
}

/** The polygon in which the plane cuts a box given by its 8 corners (corner k: bit 0 = i, bit 1 = j, bit 2 = k). */
export function boxSection(corners: readonly Vec3[], plane: Plane): Vec3[] {
  const hits: Vec3[] = [];
  for (let a = 0; a < 8; ++a)
    for (const bit of [1, 2, 4]) {
      const b = a | bit;
      if (b === a) continue;
      const from = corners[a]!;
      const to = corners[b]!;
      const above = heightOver(plane, from);
      const below = heightOver(plane, to);
      if (above > 0 === below > 0) continue;
      hits.push(add(from, scale(sub(to, from), above / (above - below))));
    }
  return aroundTheirCentre(hits, plane);
}

function aroundTheirCentre(points: Vec3[], axes: Axes): Vec3[] {
  if (points.length < 3) return [];
  const centre = scale(points.reduce(add), 1 / points.length);
  const angle = (p: Vec3) => Math.atan2(dot(sub(p, centre), axes.v), dot(sub(p, centre), axes.u));
  return points.sort((p, q) => angle(p) - angle(q));
}
