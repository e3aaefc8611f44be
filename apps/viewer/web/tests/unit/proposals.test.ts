// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Plane } from "../../src/geometry/plane";
import type { Vec3 } from "../../src/geometry/vec";
import { editing, type Call } from "./editing";
import { AXIAL, near, SKEW, square } from "./support";

const ring = (half: number, z: number): Vec3[] => [
  [-half, -half, z],
  [half, -half, z],
  [half, half, z],
  [-half, half, z],
];

/** With the contour on the slice 0 selected; the server knows these outlines of any plane. */
function proposing(lines: (z: number) => Vec3[][], contours = [square(5)]) {
  const all = editing("edit", contours);
  all.project.select({ contour: 5, point: null });
  all.server.lines = (plane: Plane) => lines(plane.origin[2]);
  const added = () => all.edits().filter(({ name }) => name === "contour.add");
  return { ...all, proposals: all.editor.proposals, added };
}

const heights = (calls: Call[]) => calls.filter(({ name }) => name === "outline").map(({ args }) => (args["plane"] as Plane).origin[2]);

test("a proposal is no contour before it is accepted, and then it is one by that name, with its holes", async () => {
  const { proposals, drawing, settled, added } = proposing((z) => [ring(5, z), ring(2, z)]);
  await proposals.next("axial", 1);
  assert.deepEqual(proposals.shown?.lines, [ring(5, -2), ring(2, -2)]);
  assert.deepEqual(added(), []);
  assert.equal(proposals.accept(), true);
  await drawing.outbox.afterSending(() => undefined);
  await settled();
  assert.deepEqual(
    added().map(({ args }) => [args["origin"], args["hole"] ?? false, (args["plane"] as Plane).origin]),
    [
      ["proposed", false, [0, 0, -2]],
      ["proposed", true, [0, 0, -2]],
    ],
  );
  assert.equal(proposals.accept(), false);
});

test("the neighbouring slice's contours are the other proposal, in turns, and what is seen is accepted", async () => {
  const { proposals, drawing, settled, added, project } = proposing((z) => [ring(4, z)], [square(5)]);
  const drawn = project.contour(5)!.points;
  assert.equal(proposals.other(), false, "nothing is proposed");
  await proposals.next("axial", 1);
  const fitted = proposals.shown!.lines;
  const copied = [drawn.map(([x, y]): Vec3 => [x, y, -2])];
  assert.equal(proposals.other(), true);
  assert.deepEqual(proposals.shown!.lines, copied);
  proposals.other();
  assert.deepEqual(proposals.shown!.lines, fitted);
  proposals.other();
  proposals.accept();
  await drawing.outbox.afterSending(() => undefined);
  await settled();
  assert.equal(added().length, 1);
});

test("the next one lies a slice on from what is proposed; dropped, it begins again from the contour", async () => {
  const { proposals, calls, navigation } = proposing((z) => [ring(5, z)]);
  await proposals.next("axial", 1);
  await proposals.next("axial", 1);
  assert.equal(navigation.crosshair[2], -4);
  assert.equal(proposals.drop(), true);
  assert.equal(proposals.shown, null);
  await proposals.next("axial", -1);
  assert.deepEqual(heights(calls), [-2, -4, 2]);
});

test("what is not seen any more is not accepted, nor what contours have changed since", async () => {
  const { proposals, navigation, project, added } = proposing((z) => [ring(5, z)]);
  await proposals.next("axial", 1);
  navigation.scroll("axial", 1);
  assert.equal(proposals.shown, null);
  await proposals.next("axial", 1);
  project.apply({ event: "changed", contours: { set: [square(6)] }, history: { undo: null, redo: null } });
  assert.equal(proposals.accept(), false);
  assert.deepEqual(added(), []);
});

test("Enter while the next outline is on its way accepts nothing: the one before is not seen any more", async () => {
  const { proposals, drawing, settled, added } = proposing((z) => [ring(5, z)]);
  await proposals.next("axial", 1);
  const next = proposals.next("axial", 1);
  assert.equal(proposals.accept(), false);
  await next;
  assert.equal(proposals.accept(), true);
  await drawing.outbox.afterSending(() => undefined);
  await settled();
  assert.deepEqual(
    added().map(({ args }) => (args["plane"] as Plane).origin[2]),
    [-4],
  );
});

test("an answer that comes after the next key or after Esc shows nothing", async () => {
  const { proposals } = proposing((z) => [ring(5, z)]);
  const late = proposals.next("axial", 1);
  const newer = proposals.next("axial", 1);
  await Promise.all([late, newer]);
  assert.equal(proposals.shown?.plane.origin[2], -4);
  const dropped = proposals.next("axial", 1);
  proposals.drop();
  await dropped;
  assert.equal(proposals.shown, null);
});

test("where the surface has ended the contour itself is proposed, and a slice that is drawn is passed with a word", async () => {
  const beyond = square(6, { plane: { ...square(6).plane, origin: [0, 0, -2] }, points: ring(9, -2) });
  const { proposals, project, complaints } = proposing(() => [], [square(5), beyond]);
  await proposals.next("axial", -1);
  assert.deepEqual(proposals.shown?.lines, [square(5).points.map(([x, y]) => [x, y, 2])]);
  proposals.drop();
  await proposals.next("axial", 1);
  assert.deepEqual([proposals.shown, project.selection?.contour], [null, 6]);
  assert.match(complaints.at(-1)!, /has a contour of Liver already/);
});

test("beyond the image's last slice nothing is proposed, and the crosshair stays", async () => {
  const last = square(5, { plane: { ...square(5).plane, origin: [0, 0, -49] }, points: ring(5, -49) });
  const { proposals, navigation, calls, complaints } = proposing((z) => [ring(5, z)], [last]);
  const before = navigation.crosshair;
  await proposals.next("axial", 30);
  assert.deepEqual([heights(calls), navigation.crosshair], [[], before]);
  assert.match(complaints.at(-1)!, /no slice further on/);
});

test("a proposal that shows nothing becomes an empty plane of its structure, beside those it had", async () => {
  const { proposals, project, edits, settled, complaints } = proposing((z) => [ring(5, z)]);
  assert.equal(proposals.nothingHere(), false);
  await proposals.next("axial", 1);
  const { plane } = proposals.shown!;
  assert.equal(proposals.nothingHere(), true);
  assert.equal(proposals.shown, null);
  assert.match(complaints.at(-1)!, /Nothing of Liver in this plane/);
  project.apply({ event: "changed", structures: { set: [{ ...project.structures.get(1)!, empty_planes: [plane] }] }, history: { undo: null, redo: null } });
  await proposals.next("axial", -1);
  const other = proposals.shown!.plane;
  proposals.nothingHere();
  await settled();
  const told = edits()
    .filter(({ name }) => name === "structure.set")
    .map(({ args }) => args["empty_planes"]);
  assert.deepEqual(told, [[plane], [plane, other]]);
});

test("where to draw next is shown on the oblique view with the expected outline; asked once more, that place is skipped", async () => {
  const { editor, server, calls, navigation, project, proposals, complaints } = proposing(() => []);
  assert.equal(await proposals.suggest(), null);
  assert.match(complaints.at(-1)!, /before the surface of Liver is finished/);
  project.setSurface({ structure: 1, revision: 1, stage: "finished", triangles: 10, uncertainty: { known: true, planes: 3, text: "" } });
  const steep: Plane = { ...SKEW, origin: [5, 0, 0] };
  server.planes = [{ plane: steep, gain: 0.3, lines: [ring(4, 0)] }];
  assert.equal(await proposals.suggest(), "oblique");
  assert.deepEqual(proposals.shown, { structure: 1, plane: steep, lines: [ring(4, 0)] });
  near(navigation.cameras.oblique.axes.normal, steep.normal);
  near(navigation.crosshair, steep.origin);
  assert.equal(editor.proposals.drop(), true);
  server.planes = [{ plane: { ...AXIAL, origin: [0, 0, 8] }, gain: 0.1, lines: [ring(4, 8)] }];
  assert.equal(await proposals.suggest(), "axial");
  assert.equal(navigation.crosshair[2], 8);
  server.planes = [];
  assert.equal(await proposals.suggest(), null);
  assert.match(complaints.at(-1)!, /No other plane is suggested/);
  assert.deepEqual(
    calls.filter(({ name }) => name === "suggest").map(({ args }) => (args["skip"] as Plane[]).length),
    [0, 1, 2],
  );
});

test("a suggestion that was asked of contours that have changed since is not shown", async () => {
  const { proposals, project, server } = proposing((z) => [ring(5, z)]);
  project.setSurface({ structure: 1, revision: 1, stage: "finished", triangles: 10, uncertainty: { known: true, planes: 3, text: "" } });
  server.planes = [{ plane: { ...AXIAL, origin: [0, 0, 4] }, gain: 1, lines: [ring(5, 4)] }];
  const asked = proposals.suggest();
  project.apply({ event: "changed", structures: { removed: [1] }, contours: { removed: [5] }, history: { undo: null, redo: null } });
  assert.equal(await asked, null);
  assert.equal(proposals.shown, null);
});
