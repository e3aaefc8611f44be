// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Appearance } from "../../src/model/appearance";

test("the look of lines is kept within its limits, whatever a saved page says", () => {
  const appearance = new Appearance();
  let changes = 0;
  appearance.on(["changed"], () => ++changes);
  appearance.set({ fill: 0.4 });
  assert.deepEqual(appearance.saved(), { fill: 0.4, width: 1 });
  appearance.set({ fill: 7, width: -2 });
  assert.deepEqual(appearance.saved(), { fill: 0.6, width: 0.5 });
  appearance.set({ fill: "red", width: Number.NaN } as never);
  assert.deepEqual(appearance.saved(), { fill: 0.6, width: 0.5 });
  assert.equal(changes, 3);
});
