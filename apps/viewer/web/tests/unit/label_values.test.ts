// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { labelValues } from "../../src/model/label_values";
import { csv } from "../../src/ui/csv";

/** The same cases as those of the server, tests/viewer/label_values_test.cpp. */
test("label values of one's own stay, and others get the smallest that is free", () => {
  const values = (...own: (number | undefined)[]) =>
    labelValues(own.map((label_value, id) => ({ id, name: "", color: "#000000", visible: true, ...(label_value === undefined ? {} : { label_value }) })));
  assert.deepEqual(values(), []);
  assert.deepEqual(values(undefined, undefined, undefined), [1, 2, 3]);
  assert.deepEqual(values(26, 27, 33), [26, 27, 33]);
  assert.deepEqual(values(undefined, 1, undefined, 3, undefined), [2, 1, 4, 3, 5]);
  assert.deepEqual(values(5, 5, undefined), [5, 1, 2]);
});

test("a table as CSV has names with commas and quotes in one field", () => {
  assert.equal(
    csv([
      ["label", "name"],
      [26, 'T8, "old"'],
    ]),
    'label,name\r\n26,"T8, ""old"""\r\n',
  );
});
