// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { isSamePlane, type PixelPlane } from "../../src/geometry/plane";
import { newestOutlines, toldOutline } from "../../src/view/outlines";

const LINES = [
  [0, 0, 4, 0, 4, 4],
  [1, 1, 2, 1, 2, 2],
];
const asked = (structure: number, revision: number) => ({ structure, revision, lines: [{ first: 0, count: 3, closed: true }] });

test("lines that were told are kept as runs of points", () => {
  const outline = toldOutline(7, 3, LINES);
  assert.deepEqual(outline.lines, [
    { first: 0, count: 3, closed: true },
    { first: 3, count: 3, closed: true },
  ]);
  assert.deepEqual([...(outline.points as number[])], LINES.flat());
});

test("a slice that was asked for earlier does not bring older outlines back", () => {
  const told = new Map([
    [1, toldOutline(1, 5, LINES)],
    [2, toldOutline(2, 5, LINES)],
    [3, toldOutline(3, 5, LINES)],
  ]);
  const points = new Float32Array(6);
  const shown = newestOutlines([asked(1, 4), asked(2, 6)], points, told);
  assert.equal(shown.get(1), told.get(1), "newer than the slice");
  assert.deepEqual(shown.get(2), { ...asked(2, 6), points }, "older than the slice");
  assert.ok(!shown.has(3), "what the slice does not show is hidden or gone");
  assert.equal(newestOutlines([asked(1, 4)], points, null).get(1)!.revision, 4, "of another plane nothing was told");
});

test("planes are the same when every pixel is", () => {
  const plane: PixelPlane = { origin: [0.1 + 0.2, 0, 0], u: [1, 0, 0], v: [0, 1, 0], normal: [0, 0, 1], mm_per_pixel: 0.7 };
  assert.ok(isSamePlane(plane, JSON.parse(JSON.stringify(plane)) as PixelPlane));
  assert.ok(!isSamePlane(plane, { ...plane, origin: [0.3, 0, 0] }));
  assert.ok(!isSamePlane(plane, { ...plane, mm_per_pixel: 0.8 }));
});
