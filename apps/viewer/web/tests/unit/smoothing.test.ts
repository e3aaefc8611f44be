// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { SMOOTHINGS, stepOf } from "../../src/ui/smoothing";

test("each step of the slider is found again, and others go to the nearest", () => {
  SMOOTHINGS.forEach((smoothing, step) => assert.equal(stepOf(smoothing ?? undefined), step));
  assert.equal(stepOf(1e-5), 2);
  assert.equal(stepOf(2e-3), 4);
  assert.equal(stepOf(99), 5);
  assert.deepEqual(
    [...SMOOTHINGS].map((value) => value ?? 1e-5).sort((a, b) => a - b),
    SMOOTHINGS.map((value) => value ?? 1e-5),
    "from exact to smooth",
  );
});
