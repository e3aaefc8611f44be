// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { bandColors, bandScale, distanceColors } from "../../src/three/band";
import { near } from "./support";

test("the scale ends at 1, 2 or 5 times a power of ten, which 98 % of the points stay below", () => {
  const widths = Float32Array.from({ length: 1000 }, (_, i) => (4.1 * i) / 999);
  assert.equal(bandScale(widths), 5);
  assert.equal(bandScale(new Float32Array(10).fill(2)), 2);
  near([bandScale(new Float32Array(10).fill(0.3))], [0.5]);
  assert.ok(bandScale(new Float32Array(0)) > 0 && bandScale(new Float32Array(3)) > 0);
});

test("the wider the band, the lighter the colour; beyond the scale it is the last one", () => {
  const colors = bandColors(Float32Array.from([0, 1, 2, 3, 4, 5, 9]), 5);
  const light = (point: number) => 0.2126 * colors[3 * point]! + 0.7152 * colors[3 * point + 1]! + 0.0722 * colors[3 * point + 2]!;
  for (let i = 1; i < 6; ++i) assert.ok(light(i) > light(i - 1), `${i}`);
  near([...colors.slice(15, 18)], [...colors.slice(18, 21)]);
});

test("far inside is blue, far outside orange, and the lighter the nearer", () => {
  const colors = distanceColors(Float32Array.from([-9, -4, 0, 4, 9]), 5);
  const of = (point: number) => [...colors.slice(3 * point, 3 * point + 3)] as [number, number, number];
  const light = (point: number) => of(point).reduce((sum, value) => sum + value);
  assert.ok(of(0)[2] > of(0)[0] && of(1)[2] > of(1)[0] && of(3)[0] > of(3)[2] && of(4)[0] > of(4)[2]);
  assert.ok(light(2) > light(1) && light(1) > light(0) && light(2) > light(3) && light(3) > light(4));
});
