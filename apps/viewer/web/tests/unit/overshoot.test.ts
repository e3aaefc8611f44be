// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { distance, type Vec3 } from "../../src/geometry/vec";
import { withoutOvershoot } from "../../src/tools/overshoot";
import { screen } from "./editing";

/** A stroke by so many degrees round a circle that grows by so many mm on the way. */
function spiral(degrees: number, growth: number): Vec3[] {
  return Array.from({ length: 101 }, (_, i): Vec3 => {
    const angle = (((degrees * i) / 100 - 180) * Math.PI) / 180;
    const radius = 40 + (growth * i) / 100 - 6 * Math.max(0, i / 100 - 0.95) * 20; // the end turns inwards
    return [radius * Math.cos(angle), radius * Math.sin(angle), 0];
  });
}

test("where the end of a stroke crosses its beginning, it is closed", () => {
  const stroke = spiral(380, 3);
  const closed = withoutOvershoot(screen, stroke);
  assert.ok(closed.length > 90 && closed.length < 100, String(closed.length));
  const [first, last] = [closed[0]!, closed.at(-1)!];
  assert.ok(distance(first, last) < 4, "less than a step of the stroke");
  assert.ok(!stroke.includes(first), "the place of the crossing");
  assert.deepEqual(closed.slice(1), stroke.slice(stroke.indexOf(closed[1]!), stroke.indexOf(last) + 1));
});

test("a stroke that ends before its beginning, and one that crosses itself elsewhere, stay", () => {
  const short = spiral(350, 3);
  assert.equal(withoutOvershoot(screen, short), short);
  const eight = Array.from({ length: 100 }, (_, i): Vec3 => [40 * Math.sin((2 * Math.PI * (i + 10)) / 100), 20 * Math.sin((4 * Math.PI * (i + 10)) / 100), 0]);
  assert.equal(withoutOvershoot(screen, eight), eight);
});
