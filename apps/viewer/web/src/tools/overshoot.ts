// SPDX-License-Identifier: Apache-2.0
import { gap, type Point2, type Screen, toScreen } from "../geometry/screen";
import { mix, type Vec3 } from "../geometry/vec";

const SHARE = 1 / 8; // of a stroke's length, at either end: what is longer is meant

/** A stroke all round, without what the hand drew before and beyond the place where its end crosses its beginning. */
export function withoutOvershoot(screen: Screen, stroke: readonly Vec3[]): readonly Vec3[] {
  const line = stroke.map((p) => toScreen(screen, p));
  const along = [0];
  for (let n = 1; n < line.length; ++n) along.push(along[n - 1]! + gap(line[n - 1]!, line[n]!));
  const part = SHARE * along.at(-1)!;
  for (let last = line.length - 2; last > 0 && along[last + 1]! > along.at(-1)! - part; --last)
    for (let first = 0; first < last - 1 && along[first]! < part; ++first) {
      const t = crossing(line[first]!, line[first + 1]!, line[last]!, line[last + 1]!);
      if (t !== null) return [mix(stroke[first]!, stroke[first + 1]!, t), ...stroke.slice(first + 1, last + 1)];
    }
  return stroke;
}

/** How far from a to b the two segments cross, from 0 to 1; null where they do not. */
function crossing(a: Point2, b: Point2, c: Point2, d: Point2): number | null {
  const [ux, uy, vx, vy] = [b[0] - a[0], b[1] - a[1], d[0] - c[0], d[1] - c[1]];
  const turn = ux * vy - uy * vx;
  const t = ((c[0] - a[0]) * vy - (c[1] - a[1]) * vx) / turn;
  const s = ((c[0] - a[0]) * uy - (c[1] - a[1]) * ux) / turn;
  return t >= 0 && t <= 1 && s >= 0 && s <= 1 ? t : null; // NaN of parallel ones is neither
}
