// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { identityLines } from "../../src/ui/identity";
import { asCsv, beyond } from "../../src/ui/statistics";
import { session } from "./support";

const row = {
  structure: 1,
  name: 'Liver, "left"',
  contours: 3,
  volume_ml: 1.25,
  volume_90_ml: [1, 1.5] as [number, number],
  surface_cm2: 2,
  diameter_mm: 3,
  diameter: [
    [0, 0, 0],
    [3, 0, 0],
  ] as [[number, number, number], [number, number, number]],
  extent_mm: [3, 2, 1] as [number, number, number],
  voxels: 7,
  mean: -1,
  deviation: 2,
  range: [-4, 5] as [number, number],
};

test("a table of statistics has names with commas and quotes in one field, and units in the head", () => {
  const [head, liver, end] = asCsv({ unit: "HU", structures: [row] }).split("\r\n");
  assert.ok(head!.startsWith('Structure,Contours,"Volume, ml"') && head!.includes('"Mean, HU"'));
  assert.equal(liver, '"Liver, ""left""",3,1.25,1,1.5,2,3,3,2,1,-1,2,-4,5,7');
  assert.equal(end, "");
  const { volume_90_ml: _, ...little } = row;
  assert.ok(asCsv({ unit: "HU", structures: [little] }).includes(",3,1.25,,,2,3"), "too little is drawn to tell");
});

test("the image says whose it is, or else its file's name; what DICOM leaves out leaves no gap", () => {
  const plain = session();
  assert.deepEqual(identityLines(plain), ["image", "values in HU · 100 × 80 × 51, 2 × 2 × 2 mm"]);
  const identity = { ...plain.identity, patient_name: "Doe, Jane", patient_id: "17", modality: "PT", series_number: "4", study_date: "2024-03-01" };
  const lines = identityLines({ ...plain, identity, image: { ...plain.image, unit: "" } });
  assert.deepEqual(lines.slice(0, 3), ["Doe, Jane · ID 17", "2024-03-01", "PT · series 4"]);
  assert.match(lines[3]!, /^values without a unit/);
  assert.equal(identityLines({ ...plain, identity: { ...identity, patient_name: "", patient_id: "" } })[0], "Patient without a name");
});

test("a second image's values have columns of their own, empty where a structure lies beyond it, and one sentence says so", () => {
  const within = { voxels: 3, mean: 4.5, deviation: 1, range: [3, 6] as [number, number], points_beyond: 0 };
  const structures = [
    { ...row, name: "A", second: within },
    { ...row, name: "B", second: { ...within, points_beyond: 7 } },
    { ...row, name: "C", second: { voxels: 0 } },
  ];
  const [head, a, , c] = asCsv({ unit: "HU", second: { modality: "PT", unit: "SUV (g/ml)" }, structures }).split("\r\n");
  assert.ok(head!.endsWith('Voxels,"PT: mean, SUV (g/ml)","PT: deviation, SUV (g/ml)","PT: least, SUV (g/ml)","PT: most, SUV (g/ml)",PT: voxels'), head);
  assert.ok(a!.endsWith(",7,4.5,1,3,6,3"), a);
  assert.ok(c!.endsWith(",7,,,,,0"), c);
  assert.deepEqual(beyond(structures), [
    "B reaches beyond the second image, whose values are those of the part within.",
    "C holds no voxel of the second image.",
  ]);
  assert.deepEqual(beyond([row]), []);
});
