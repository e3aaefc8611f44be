// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { between, groupsOf, isGrouped, isOpenByItself } from "../../src/model/contour_list";
import { Project } from "../../src/model/project";
import type { Contour } from "../../src/net/protocol";
import { groupsOf as studiesOf, volumeLines } from "../../src/start/volume_cards";
import { sizeText } from "../../src/start/folder_view";
import { AXIAL, CORONAL, session, SKEW, started } from "./support";

let id = 0;
const contour = (axes: { u: Contour["plane"]["u"]; v: Contour["plane"]["v"]; normal: Contour["plane"]["normal"] }, height: number, structure = 1): Contour => ({
  id: ++id,
  structure,
  kind: "freehand",
  closed: true,
  hole: false,
  visible: true,
  points: [],
  control: [],
  self_crossings: [],
  plane: { ...axes, origin: [axes.normal[0] * height, axes.normal[1] * height, axes.normal[2] * height] },
});

describe("a long list of contours", () => {
  test("is grouped by view, each group in the order in which one scrolls", () => {
    const high = contour(AXIAL, 20);
    const low = contour(AXIAL, -20);
    const front = contour(CORONAL, 10);
    const across = contour({ u: [0, 1, 0], v: [0, 0, 1], normal: [0.6, 0.8, 0] }, 5);
    const navigation = started();
    const groups = groupsOf([across, front, low, high], navigation);
    assert.deepEqual(
      groups.map(({ view }) => view),
      ["axial", "coronal", null],
    );
    const slices = groups[0]!.contours.map(({ plane }) => navigation.unturnedSliceOf("axial", plane.origin));
    assert.deepEqual(
      slices,
      [...slices].sort((a, b) => a - b),
    );
    assert.equal(groupsOf([contour(SKEW, 1)], navigation)[0]!.view, "oblique");
    assert.ok(!isGrouped(12) && isGrouped(13));
  });

  test("is shown of the active structure alone, once there are many", () => {
    const project = new Project();
    const structures = [1, 2].map((structure) => ({ id: structure, name: `S${structure}`, color: "#ffffff", visible: true }));
    project.start(session({ structures, contours: [contour(AXIAL, 1, 1), contour(AXIAL, 2, 2)] }));
    assert.ok(isOpenByItself(1, project) && isOpenByItself(2, project));
    project.start(session({ structures, contours: Array.from({ length: 30 }, (_, i) => contour(AXIAL, i, 1 + (i % 2))) }));
    assert.ok(isOpenByItself(1, project) && !isOpenByItself(2, project));
    project.activate(2);
    assert.ok(!isOpenByItself(1, project) && isOpenByItself(2, project));
  });

  test("gives ranges either way", () => {
    assert.deepEqual(between([5, 9, 2, 7], 9, 7), [9, 2, 7]);
    assert.deepEqual(between([5, 9, 2, 7], 2, 5), [2, 9, 5]);
    assert.deepEqual(between([5, 9], 1, 9), [9]);
  });
});

describe("marks", () => {
  const project = new Project();
  const contours = [contour(AXIAL, 1), contour(AXIAL, 2), contour(AXIAL, 3)];
  const [a, b, c] = contours.map((one) => one.id) as [number, number, number];
  const start = () => project.start(session({ contours }));

  test("are added one by one, and one selection takes them away", () => {
    start();
    project.select({ contour: a, point: null });
    project.toggleMark(b);
    assert.deepEqual([...project.marked], [a, b]);
    assert.equal(project.selection?.contour, b);
    project.toggleMark(b);
    assert.equal(project.selection?.contour, a);
    project.toggleMark(c);
    project.select({ contour: c, point: null });
    assert.deepEqual([...project.marked], [c]);
    project.select(null);
    assert.equal(project.marked.size, 0);
  });

  test("are for contours that are there", () => {
    start();
    project.mark([a, b, c]);
    project.apply({ event: "changed", contours: { removed: [c, a] }, history: { undo: null, redo: null } });
    assert.deepEqual([...project.marked], [b]);
    assert.equal(project.selection?.contour, b);
    project.apply({ event: "changed", contours: { removed: [b] }, history: { undo: null, redo: null } });
    assert.equal(project.selection, null);
  });
});

describe("the start page", () => {
  const volume = {
    series: "1.2",
    volume: 1,
    modality: "CT",
    description: "Thorax",
    distinction: "",
    slices: 40,
    columns: 512,
    rows: 512,
    patient_name: "Doe, Jane",
    patient_id: "7",
    frame_of_reference_uid: "1.2.3",
    study_date: "2026-11-23",
    study_description: "",
    series_number: "3",
    picture: { file: "/a", frame: 1 },
  };

  test("puts volumes together by patient and study", () => {
    const groups = studiesOf([volume, { ...volume, patient_id: "8" }, { ...volume, series: "1.3" }]);
    assert.deepEqual(
      groups.map(([title, members]) => [title, members.length]),
      [
        ["Doe, Jane · ID 7 · 2026-11-23", 2],
        ["Doe, Jane · ID 8 · 2026-11-23", 1],
      ],
    );
    assert.deepEqual(volumeLines(volume), ["Thorax", "CT · series 3", "40 slices of 512 × 512"]);
    assert.deepEqual(volumeLines({ ...volume, description: "", distinction: "echo 2", slices: 1 }), [
      "Without a description",
      "echo 2",
      "CT · series 3",
      "1 slice of 512 × 512",
    ]);
  });

  test("says sizes as people read them", () => {
    assert.deepEqual([0, 999, 1000, 52_345, 1_020_000_000].map(sizeText), ["0 bytes", "999 bytes", "1.0 kB", "52 kB", "1.0 GB"]);
  });
});
