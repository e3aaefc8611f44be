// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { cross, type Vec3 } from "../../src/geometry/vec";
import { cubeMatrix, SIDES, sideMatrix, sidesInSight } from "../../src/three/cube";
import { near } from "./support";

/** The rows of the stylesheet's matrix, which names columns. */
function rows(matrix: string): number[][] {
  const numbers = matrix.match(/-?\d+\.\d+/g)!.map(Number);
  return [0, 1, 2].map((row) => [0, 1, 2].map((column) => numbers[4 * column + row]!));
}

const product = (a: number[][], b: number[][]) => a.map((row) => [0, 1, 2].map((column) => row.reduce((sum, value, i) => sum + value * b[i]![column]!, 0)));
const lookingFrom = (back: Vec3, up: Vec3) => ({ right: cross(up, back), up, back });

test("who looks from a side sees its letter upright and nothing else", () => {
  for (const side of SIDES) {
    const seen = product(rows(cubeMatrix(lookingFrom(side.from, side.up))), rows(sideMatrix(side)));
    near(seen.flat(), [1, 0, 0, 0, 1, 0, 0, 0, 1], 1e-9);
    assert.deepEqual(sidesInSight(lookingFrom(side.from, side.up)), [side]);
  }
});

test("from the front the patient's left is to the right, and from below the front is up", () => {
  const [front, below] = [SIDES.find(({ letter }) => letter === "A")!, SIDES.find(({ letter }) => letter === "I")!];
  near(lookingFrom(front.from, front.up).right, [1, 0, 0]);
  near(lookingFrom(below.from, below.up).right, [1, 0, 0]);
});
