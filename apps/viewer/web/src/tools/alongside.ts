// SPDX-License-Identifier: Apache-2.0
import { distance, type Vec3 } from "../geometry/vec";

const nearest = (points: readonly Vec3[], p: Vec3): number => points.reduce((best, q, i) => (distance(q, p) < distance(points[best]!, p) ? i : best), 0);

/** The part of closed lines that runs along an open one, from where it begins to where it ends; null where no line is. */
export function stretchAlong(loops: readonly (readonly Vec3[])[], line: readonly Vec3[]): Vec3[] | null {
  const middle = line[Math.floor(line.length / 2)]!;
  const away = (loop: readonly Vec3[]) => distance(loop[nearest(loop, middle)]!, middle);
  const loop = [...loops].sort((a, b) => away(a) - away(b))[0];
  if (!loop) return null;
  const from = nearest(loop, line[0]!);
  const to = nearest(loop, line.at(-1)!);
  if (from === to) return null;
  const count = loop.length;
  const part = (direction: 1 | -1) =>
    Array.from({ length: (((to - from) * direction + count) % count) + 1 }, (_, i) => loop[(from + direction * i + count * 2) % count]!);
  const [forwards, backwards] = [part(1), part(-1)];
  const off = (points: readonly Vec3[]) => distance(points[nearest(points, middle)]!, middle);
  return off(forwards) <= off(backwards) ? forwards : backwards;
}
