// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { coordinateText, lengthText } from "../../src/model/lengths";
import { placeText } from "../../src/ui/values";

test("lengths and places in images of cells have digits, too", () => {
  assert.deepEqual([lengthText(12.34), lengthText(0.85), lengthText(0.0123), lengthText(0)], ["12.3 mm", "0.85 mm", "0.012 mm", "0.0 mm"]);
  assert.deepEqual([lengthText(0.5, 2), lengthText(0.000123, 2)], ["0.50 mm", "0.00012 mm"]);
  assert.deepEqual([coordinateText(12.34, 0.6), coordinateText(0.1234, 0.01)], ["12.3", "0.12"]);
  assert.equal(placeText([0.123, -0.05, 0], 0.005), "L 0.123  A 0.050  S 0.000 mm");
});
