// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { changesDrawing } from "../../src/net/calls";

test("names, colours and what is seen change nothing that is drawn; all else does", () => {
  assert.ok(!changesDrawing("structure.set", { id: 1, name: "Liver", color: "#ffffff", visible: false }));
  assert.ok(!changesDrawing("contour.set", { ids: [1, 2], visible: false }));
  assert.ok(!changesDrawing("structure.add", {}));
  assert.ok(changesDrawing("structure.set", { id: 1, visible: true, smoothing: 0 }));
  assert.ok(changesDrawing("contour.set", { id: 1, hole: true }));
  assert.ok(changesDrawing("contour.remove", { ids: [1] }));
  assert.ok(changesDrawing("point.set", { structure: 1, at: [0, 0, 0], kind: "interior" }));
});
