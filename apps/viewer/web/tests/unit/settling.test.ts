// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vec3 } from "../../src/geometry/vec";
import { crossingNear, distinct, settled } from "../../src/tools/settling";
import { CORONAL, near, square } from "./support";

const coronal = (half: number): Vec3[] => [
  [-half, 0, -half],
  [half, 0, -half],
  [half, 0, half],
  [-half, 0, half],
];
const upright = (id: number, half: number) => square(id, { plane: { ...CORONAL, origin: [0, 0, 0] }, points: coronal(half) });

test("the one that yields is bent to where the other crosses its plane, on the side of the conflict", () => {
  const flat = square(5);
  const tall = upright(6, 7); // they cross the x axis at 10 and at 7
  const conflict = { at: [-8.5, 0, 0] as Vec3, distance_mm: 3, contours: [5, 6] as [number, number] };
  assert.deepEqual(settled(conflict, flat, tall)?.id, 6);
  near(settled(conflict, flat, tall)!.from, [-7, 0, 0]);
  near(settled(conflict, flat, tall)!.to, [-10, 0, 0]);
  near(settled(conflict, tall, flat)!.from, [-10, 0, 0]);
});

test("a line that does not cross the plane cannot be settled, and has no crossing", () => {
  const far = upright(6, 7);
  const beside = { ...far, plane: { ...far.plane, origin: [0, 50, 0] as Vec3 }, points: far.points.map(([x, y, z]): Vec3 => [x, y + 50, z]) };
  assert.equal(settled({ at: [0, 0, 0], distance_mm: 3, contours: [5, 6] }, square(5), beside), null);
  assert.equal(crossingNear([], far.plane, [0, 0, 0]), null);
});

test("the same two at the same place are one conflict, whichever is named first", () => {
  const at = (x: number, contours: [number, number]) => ({ at: [x, 0, 0] as Vec3, distance_mm: 3, contours });
  assert.equal(distinct([at(0, [5, 6]), at(1, [6, 5]), at(9, [5, 6]), at(0, [5, 7])]).length, 3);
});
