// SPDX-License-Identifier: Apache-2.0
// A round brush that pushes a line before it, closed or open, on the screen.
import { gap, nearestOnLine, type Point2 } from "./screen";

/** A point of a line under the brush: where it was before is told by its number then, as long as nothing has touched it. */
export interface BrushPoint {
  readonly at: Point2;
  readonly original?: number;
}

const STEPS_PER_RADIUS = 2; // so that the brush does not leap over a line
const POINTS_PER_RADIUS = 8; // of the line around the brush

/** What is left of the line outside of the brush after it went straight from one place to the other: the same array where it touched nothing. */
export function brushed(line: readonly BrushPoint[], from: Point2, to: Point2, radius: number, isClosed = true): readonly BrushPoint[] {
  const steps = Math.max(1, Math.ceil((gap(from, to) * STEPS_PER_RADIUS) / radius));
  let left = line;
  for (let i = 1; i <= steps; ++i)
    left = pushedOut(left, [from[0] + ((to[0] - from[0]) * i) / steps, from[1] + ((to[1] - from[1]) * i) / steps], radius, isClosed);
  return left;
}

function pushedOut(line: readonly BrushPoint[], center: Point2, radius: number, isClosed: boolean): readonly BrushPoint[] {
  const isTouched = line.some(({ at }, i) => nearestOnLine(center, at, following(line, i, isClosed).at).distance < radius);
  if (!isTouched) return line;
  const moved = subdivided(line, center, radius, isClosed).map((point) => (gap(point.at, center) < radius ? { at: onRim(point.at, center, radius) } : point));
  return thinned(moved, radius / POINTS_PER_RADIUS / 2);
}

/** An open line's last point is followed by itself. */
const following = (line: readonly BrushPoint[], i: number, isClosed: boolean): BrushPoint => line[i + 1] ?? line[isClosed ? 0 : i]!;

function onRim(p: Point2, center: Point2, radius: number): Point2 {
  const away = gap(p, center);
  if (away < 1e-9) return [center[0] + radius, center[1]];
  return [center[0] + ((p[0] - center[0]) * radius) / away, center[1] + ((p[1] - center[1]) * radius) / away];
}

/** Stretches that the brush touches get points so close that they can follow its rim. */
function subdivided(line: readonly BrushPoint[], center: Point2, radius: number, isClosed: boolean): BrushPoint[] {
  const spacing = radius / POINTS_PER_RADIUS;
  return line.flatMap((point, i) => {
    const a = point.at;
    const b = following(line, i, isClosed).at;
    const parts = nearestOnLine(center, a, b).distance < radius ? Math.max(1, Math.ceil(gap(a, b) / spacing)) : 1;
    const between = Array.from({ length: parts - 1 }, (_, k): BrushPoint => ({
      at: [a[0] + ((b[0] - a[0]) * (k + 1)) / parts, a[1] + ((b[1] - a[1]) * (k + 1)) / parts],
    }));
    return [point, ...between];
  });
}

/** Without points that lie too close to the one before; those that nothing has touched stay. */
function thinned(line: readonly BrushPoint[], spacing: number): BrushPoint[] {
  const kept: BrushPoint[] = [];
  for (const point of line) if (point.original !== undefined || kept.length === 0 || gap(point.at, kept.at(-1)!.at) >= spacing) kept.push(point);
  return kept;
}

/** A part of a brushed line, and the numbers that its ends, which nothing has touched, had before. */
export interface NewPart {
  points: BrushPoint[];
  from: number;
  to: number;
}

/** The part of a brushed open line of once `count` points that is new; null where the brush has touched one of its ends. */
export function newPartOfOpen(line: readonly BrushPoint[], count: number): NewPart | null {
  let before = 0;
  while (before < line.length && line[before]!.original === before) ++before;
  let behind = 0;
  while (behind < line.length && line.at(-1 - behind)!.original === count - 1 - behind) ++behind;
  if (before < 2 || behind < 2 || before + behind > line.length) return null;
  return { points: line.slice(before - 1, line.length - behind + 1), from: before - 1, to: count - behind };
}

/** The part of a brushed closed line that is new; null: hardly any of it is old. */
export function newPart(line: readonly BrushPoint[]): NewPart | null {
  const count = line.length;
  let best = { start: 0, length: 0 };
  for (let start = 0; start < count; ++start) {
    if (line[start]!.original === undefined || line[(start + count - 1) % count]!.original !== undefined) continue;
    let length = 1;
    while (length < count && line[(start + length) % count]!.original !== undefined) ++length;
    if (length > best.length) best = { start, length };
  }
  if (best.length < 2) return null;
  const first = best.start + best.length - 1; // the last one of the longest old run, from which the new part goes on to its first
  const points = Array.from({ length: count - best.length + 2 }, (_, i) => line[(first + i) % count]!);
  return { points, from: points[0]!.original!, to: points.at(-1)!.original! };
}
