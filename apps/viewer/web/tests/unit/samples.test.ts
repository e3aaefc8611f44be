// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { spread } from "../../src/view/samples";

const CODES = Uint32Array.from({ length: 65536 }, (_, code) => code); // the colour of a code is the code
const coding = { first: 0, step: 1 };

type Pair = [number, number];

function pixels(codes: number[], [columns, rows]: Pair, [width, height]: Pair, first: Pair, step: Pair): number[] {
  const into = new Uint32Array(width * height).fill(99999);
  spread({ codes: Uint16Array.from(codes), coding, samples: { columns, rows, first, step }, width, height }, CODES, into);
  return [...into];
}

test("as many samples as pixels are the pixels", () => {
  assert.deepEqual(pixels([5, 0, 7, 65535], [2, 2], [2, 2], [0, 0], [1, 1]), [5, 0, 7, 65535]);
});

test("between samples values are interpolated along both sides", () => {
  const at = (column: number, row: number) => 1000 + 40 * column + 300 * row; // of the screen's pixels
  const codes = [0, 1, 2].flatMap((j) => [0, 1, 2, 3].map((i) => at(-1 + 2.5 * i, 0.5 + 4 * j)));
  const found = pixels(codes, [4, 3], [6, 9], [-1, 0.5], [2.5, 4]);
  for (let row = 1; row < 9; ++row) for (let column = 0; column < 6; ++column) assert.equal(found[column + 6 * row], at(column, row), `${column}, ${row}`);
});

test("the outermost samples reach half a step farther, and beyond there is no value", () => {
  assert.deepEqual(pixels([10, 20], [2, 1], [11, 1], [3, 0], [4, 1]), [0, 10, 10, 10, 13, 15, 18, 20, 20, 20, 0]);
  assert.deepEqual(pixels([10, 20], [1, 2], [1, 11], [0, 3], [1, 4]), [0, 10, 10, 10, 13, 15, 18, 20, 20, 20, 0]);
});

test("between a value and none there is nothing: each pixel takes the nearer one", () => {
  assert.deepEqual(pixels([0, 1000], [2, 1], [5, 1], [0, 0], [4, 1]), [0, 0, 1000, 1000, 1000]);
  assert.deepEqual(pixels([1000, 0], [1, 2], [1, 5], [0, 0], [1, 4]), [1000, 1000, 0, 0, 0]);
});

test("one sample is all that is seen of a voxel that fills the screen", () => {
  assert.deepEqual(pixels([7], [1, 1], [3, 2], [1, 1], [40, 40]), [7, 7, 7, 7, 7, 7]);
});
