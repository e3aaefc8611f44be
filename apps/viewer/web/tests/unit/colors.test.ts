// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { PLANE_COLORS } from "../../src/model/palette";
import { least, VISION } from "./colors";

test("the planes' colours differ for readers of any colour vision", () => {
  for (const [name, vision] of Object.entries(VISION)) assert.ok(least(Object.values(PLANE_COLORS), vision) > 25, name);
});

test("red and green of the same lightness would not", () => {
  const before = ["#f0625a", "#4cc36b", "#5b9cff", "#c792ea"];
  assert.ok(least(before, VISION["deuteranopia"]!) < 10);
});
