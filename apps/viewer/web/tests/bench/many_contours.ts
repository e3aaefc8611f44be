// SPDX-License-Identifier: Apache-2.0
// An organ that somebody has worked on for a while: many contours, across all three axes, none of them exact.
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { run } from "../e2e/support";
import { along, type Vec3 } from "./truth";

const STEP_MM = 1.5; // from point to point, as live-wire leaves them
const WAVES = [
  { mm: 0.7, length_mm: 45 },
  { mm: 0.4, length_mm: 19 },
] as const; // by which a hand is off

interface FilePlane {
  origin: Vec3;
  normal: Vec3;
  u: Vec3;
  v: Vec3;
  contours: { closed: boolean; hole: boolean; points: Vec3[] }[];
}

const read = (path: string) => JSON.parse(readFileSync(path, "utf8")) as { planes: FilePlane[]; provenance?: unknown };
const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const between = (a: Vec3, b: Vec3, t: number): Vec3 => a.map((value, i) => value + t * (b[i]! - value)) as Vec3;
const gap = (a: Vec3, b: Vec3): number => Math.hypot(...a.map((value, i) => value - b[i]!));

/** Planes across each axis of the box of a structure's contours, evenly from near one end to near the other. */
function planesAcross(points: readonly Vec3[], each: number): Omit<FilePlane, "contours">[] {
  const ends = [0, 1, 2].map((axis) =>
    points.reduce(([low, high], p) => [Math.min(low, p[axis]!), Math.max(high, p[axis]!)] as const, [Infinity, -Infinity] as const),
  );
  const unit = (axis: number) => [0, 1, 2].map((i) => (i === axis % 3 ? 1 : 0)) as Vec3;
  return [0, 1, 2].flatMap((axis) =>
    Array.from({ length: each }, (_, n) => {
      const origin = ends.map(([low, high]) => (low + high) / 2) as Vec3;
      const [low, high] = ends[axis]!;
      origin[axis] = low + (high - low) * (0.08 + (0.84 * n) / (each - 1));
      return { origin, normal: unit(axis), u: unit(axis + 1), v: unit(axis + 2) };
    }),
  );
}

/** Points at equal steps along a closed line, each the mean of five, so that a mask's steps are gone. */
function evened(line: readonly Vec3[]): Vec3[] {
  const lengths = line.map((p, i) => gap(p, line[(i + 1) % line.length]!));
  const length = lengths.reduce((a, b) => a + b);
  const count = Math.max(8, Math.round(length / STEP_MM));
  const spaced: Vec3[] = [];
  for (let n = 0, i = 0, before = 0; n < count; ++n) {
    const at = (length * n) / count;
    while (before + lengths[i]! < at) before += lengths[i++]!;
    spaced.push(between(line[i]!, line[(i + 1) % line.length]!, (at - before) / lengths[i]!));
  }
  const near = (n: number) => spaced[(n + count) % count]!;
  return spaced.map(
    (_, n) =>
      [-2, -1, 0, 1, 2]
        .map((k) => near(n + k))
        .reduce((a, b) => along(a, b, 1))
        .map((sum) => sum / 5) as Vec3,
  );
}

/** The line as a hand draws it: it sways to both sides, in its plane. */
function swayed(line: readonly Vec3[], normal: Vec3, seed: number): Vec3[] {
  const length_mm = line.length * STEP_MM;
  return line.map((p, n) => {
    const before = line.at(n - 1)!,
      after = line[(n + 1) % line.length]!;
    const aside = cross(normal, between([0, 0, 0], along(after, before, -1), 1 / Math.max(gap(before, after), 1e-9)));
    const off = WAVES.map(
      ({ mm, length_mm: wave_mm }, i) => mm * Math.sin((2 * Math.PI * n * Math.max(3, Math.round(length_mm / wave_mm))) / line.length + seed * (1.7 + 1.2 * i)),
    );
    return along(p, aside, off[0]! + off[1]!);
  });
}

/** Writes `3 * each` contours of a mask in `folder`, which `drawn` shows where to look for; returns the file's path. */
export function writeManyContours(folder: string, mask: string, drawn: string, each: number): string {
  const planes = join(folder, "many_planes.json"),
    traced = join(folder, "many_traced.json"),
    path = join(folder, "many.json");
  const points = read(join(folder, drawn)).planes.flatMap(({ contours }) => contours.flatMap((contour) => contour.points));
  writeFileSync(planes, JSON.stringify({ version: 1, frame: "LPS mm", planes: planesAcross(points, each) }));
  run("trace", join(folder, mask), "--planes", planes, "--output", traced);
  const { provenance: _, ...document } = read(traced);
  document.planes.forEach(({ normal, contours }, seed) => {
    for (const contour of contours) contour.points = swayed(evened(contour.points), normal, seed);
  });
  writeFileSync(path, JSON.stringify(document));
  return path;
}
