// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { BODY, lineOf, NO_RULE } from "../../src/model/rule_menu";

test("choices write the line that a planner would type", () => {
  const ptv = { ...NO_RULE, name: "PTV", of: "CTV", margin: 5 };
  assert.equal(lineOf(ptv), "PTV = CTV + 5 mm");
  assert.equal(lineOf({ ...ptv, crop: BODY }), "PTV = crop(CTV + 5 mm, body())");
  assert.equal(lineOf({ ...ptv, crop: BODY, cropGap: 3, spare: "Cord", spareMargin: 2.5 }), "PTV = crop(CTV + 5 mm, body(), 3 mm) - (Cord + 2.5 mm)");
  assert.equal(lineOf({ ...ptv, spare: "Cord" }), "PTV = CTV + 5 mm - Cord");
  assert.equal(lineOf({ ...NO_RULE, name: "In 2", of: "Lung L", margin: -4 }), "'In 2' = 'Lung L' - 4 mm");
  assert.equal(lineOf({ ...NO_RULE, name: "Copy", of: "CTV" }), "Copy = CTV");
});

test("there is no line before there is a name and a structure", () => {
  assert.equal(lineOf(NO_RULE), "");
  assert.equal(lineOf({ ...NO_RULE, name: "PTV" }), "");
  assert.equal(lineOf({ ...NO_RULE, name: "  ", of: "CTV" }), "");
});
