// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Point2 } from "../../src/geometry/screen";
import { replacedPiece } from "../../src/view/replaced_piece";

const ring = (radius: number, x = 0): Point2[] =>
  Array.from({ length: 90 }, (_, n) => [x + radius * Math.cos((Math.PI * n) / 45), radius * Math.sin((Math.PI * n) / 45)]);
const at = (radius: number, degrees: number, x = 0): Point2 => [x + radius * Math.cos((degrees * Math.PI) / 180), radius * Math.sin((degrees * Math.PI) / 180)];
const lengthOf = (line: readonly Point2[]) => line.slice(1).reduce((sum, p, i) => sum + Math.hypot(p[0] - line[i]![0], p[1] - line[i]![1]), 0);

test("a stroke replaces the shorter piece of the outline between its ends, whichever way it is drawn", () => {
  for (const [from, to] of [
    [-30, 30],
    [30, -30],
    [100, 200],
  ] as const) {
    const piece = replacedPiece([ring(40), ring(10, 200)], [at(42, from), at(60, (from + to) / 2), at(41, to)])!;
    assert.ok(Math.abs(lengthOf(piece) - (40 * Math.abs(to - from) * Math.PI) / 180) < 0.2, `${lengthOf(piece)}`);
    const ends = [piece[0]!, piece.at(-1)!].map(([x, y]) => Math.round((Math.atan2(y, x) * 180) / Math.PI));
    assert.deepEqual([...ends].sort(), [from, to > 180 ? to - 360 : to].sort());
  }
});

test("it replaces nothing between two outlines, far from all, and where there is none", () => {
  assert.equal(replacedPiece([ring(40), ring(10, 100)], [at(40, 0), at(10, 180, 100)]), null);
  assert.equal(replacedPiece([ring(40)], [at(80, 0), at(80, 20)]), null);
  assert.equal(replacedPiece([], [at(40, 0), at(40, 20)]), null);
  assert.equal(replacedPiece([ring(40)], [at(40, 0)]), null);
});
