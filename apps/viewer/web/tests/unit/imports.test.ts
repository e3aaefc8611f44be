// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { accepted, importKind, sentence } from "../../src/ui/endings";
import { session } from "./support";

const { imports } = session();

test("a file's name, in capitals or not, says what it is imported as", () => {
  const names = ["a.json", "a.mrk.json", "A.NII.GZ", "b.mgz", "b.gz", "b.txt", "nii"];
  assert.deepEqual(
    names.map((name) => importKind(name, imports)),
    ["contours", "contours", "mask", "mask", null, null, null],
  );
});

test("the file chooser is given the last part of every ending, once", () => {
  assert.equal(accepted(imports), ".json,.gz,.nii,.mgz");
});

test("what cannot be imported is told what can", () => {
  assert.equal(sentence(imports), "contours are imported from .mrk.json and .json, masks from .nii.gz, .nii and .mgz.");
  assert.equal(sentence({ contours: [], masks: [] }), "kontur has not said yet what it imports.");
});
