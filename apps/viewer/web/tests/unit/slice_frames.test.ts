// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { SliceFrames } from "../../src/view/slice_frames";

test("slices that are kept for playing are bounded, and the ones used last stay", () => {
  const frames = new SliceFrames<string>();
  for (const key of ["a", "b", "c"]) frames.keep(key, key.toUpperCase(), 20 << 20);
  assert.deepEqual(
    ["a", "b", "c"].map((key) => frames.get(key)),
    ["A", "B", "C"],
  );
  frames.get("a");
  frames.keep("d", "D", 20 << 20);
  assert.deepEqual(
    ["a", "b", "c", "d"].map((key) => frames.get(key)),
    ["A", null, "C", "D"],
  );
  frames.keep("d", "newer", 1);
  frames.keep("b", "B", 20 << 20);
  assert.deepEqual(
    ["a", "b", "c", "d"].map((key) => frames.get(key)),
    ["A", "B", "C", "newer"],
    "what is replaced takes no room",
  );
  frames.clear();
  assert.equal(frames.get("a"), null);
});
