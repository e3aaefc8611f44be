// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Navigation } from "../../src/model/navigation";
import { LEAST, MOST, PaneSizes, type SavedSizes } from "../../src/model/pane_sizes";
import { session } from "./support";

test("a divider leaves room on both sides, and goes back to where it was", () => {
  const sizes = new PaneSizes();
  const usual = sizes.share("surface");
  for (const [share, stays] of [
    [0.4, 0.4],
    [-3, LEAST],
    [7, MOST],
  ] as const) {
    sizes.move("surface", share);
    assert.equal(sizes.share("surface"), stays);
  }
  sizes.move("surface", NaN);
  assert.equal(sizes.share("surface"), MOST);
  sizes.reset("surface");
  assert.equal(sizes.share("surface"), usual);
  assert.deepEqual(sizes.saved(), {});
});

test("what was saved comes back, and only what is a share", () => {
  const sizes = new PaneSizes();
  sizes.move("rows", 0.3);
  const saved = sizes.saved();
  const others = new PaneSizes();
  others.restore(saved);
  assert.deepEqual(others.saved(), { rows: 0.3 });
  others.restore({ columns: "wide", rows: 0, big: 0.5, panel: 99, nobody: 0.5 } as unknown as SavedSizes);
  assert.deepEqual(others.saved(), { big: 0.5 });
  others.restore(undefined);
  assert.deepEqual(others.saved(), {});
});

test("a new project begins with its modality's layout, an old one with its own", () => {
  const arrangement = { modality: "MR", state: { layout: "single", big: "coronal" } };
  const fresh = new Navigation();
  fresh.start(session({ arrangement }), null);
  assert.deepEqual([fresh.layout, fresh.big], ["single", "coronal"]);
  const known = new Navigation();
  known.start(session({ arrangement }), { ...fresh.saved(), layout: "big-slice", big: "axial" });
  assert.deepEqual([known.layout, known.big], ["big-slice", "axial"]);
  const damaged = new Navigation();
  damaged.start(session({ arrangement: { modality: "MR", state: { layout: "none", big: "nothing" } } }), null);
  assert.deepEqual([damaged.layout, damaged.big], ["overview", "axial"]);
});
