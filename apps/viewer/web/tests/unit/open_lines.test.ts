// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { alongLine } from "../../src/geometry/loop";
import { leftOnScreen, type Point2 } from "../../src/geometry/screen";
import type { Vec3 } from "../../src/geometry/vec";
import { ServerError } from "../../src/net/http";
import { stretchAlong } from "../../src/tools/alongside";
import { hitContour } from "../../src/tools/hit";
import { Sketch } from "../../src/tools/sketch";
import { editing, screen } from "./editing";
import { AXIAL, square } from "./support";

const line = (id: number) => square(id, { closed: false });
/** Along the square's upper side, by hand. */
const stroke: Point2[] = Array.from({ length: 20 }, (_, i) => [150 + 5 * i, 150 + (i % 2)]);

test("U ends what is drawn as an open line, and Enter closes it", async () => {
  const { editor, press, edits, settled } = editing("spline");
  const click = (p: Point2) => press(p)!.end(p);
  click([100, 100]);
  click([140, 100]);
  editor.openOrClose();
  await settled();
  const [added] = edits();
  assert.equal(added!.name, "contour.add");
  assert.equal(added!.args["closed"], false);
  assert.equal((added!.args["control"] as unknown[]).length, 2);
});

test("one point is no line", () => {
  const { editor, press, complaints } = editing("spline");
  press([100, 100])!.end([100, 100]);
  editor.openOrClose();
  assert.deepEqual(complaints, ["An open line needs at least two points."]);
  assert.ok(editor.drawing.sketch);
});

test("where lines stay open Enter, a second click on the last point and a stroke by hand end them so", async () => {
  const { drawing, press, drag, edits, settled } = editing("spline");
  const click = (p: Point2) => press(p)!.end(p);
  drawing.setEndsOpen(true);
  click([100, 100]);
  click([140, 100]);
  click([140, 100]);
  click([100, 100]);
  click([140, 120]);
  drawing.finish();
  await settled();
  assert.deepEqual(
    edits().map(({ args }) => args["closed"]),
    [false, false],
  );
  const free = editing("freehand");
  free.drawing.setEndsOpen(true);
  free.drag(...stroke);
  await free.settled();
  assert.equal(free.edits()[0]!.args["closed"], false);
  assert.equal((free.edits()[0]!.args["control"] as unknown[]).length, 2, "both ends can be dragged");
  void drag;
});

test("a line that comes back to where it began is closed, whatever is chosen", async () => {
  const { drawing, press, edits, settled } = editing("spline");
  const click = (p: Point2) => press(p)!.end(p);
  drawing.setEndsOpen(true);
  for (const p of [
    [100, 100],
    [160, 100],
    [160, 160],
    [100, 100],
  ] as Point2[])
    click(p);
  await settled();
  assert.equal(edits().length, 1);
  assert.ok(!("closed" in edits()[0]!.args));
});

test("what was not saved of an open line is tried again as one, and kept for the next visit", async () => {
  const { drawing, drag, edits, settled, server, savedByTryingAgain } = editing("freehand");
  server.refusal = new ServerError("io", "the disk is full");
  drawing.setEndsOpen(true);
  drag(...stroke);
  await settled();
  drawing.setEndsOpen(false);
  assert.equal(edits().length, 1);
  assert.match(drawing.sketch!.title, /open line/);
  const again = Sketch.from(JSON.parse(JSON.stringify(drawing.sketch!.saved())) as ReturnType<Sketch["saved"]>);
  assert.ok(again.isOpen && again.isFinished);
  await savedByTryingAgain(() => drawing.finish());
});

test("U opens the selected contour at the stretch under the pointer, or closes an open line", async () => {
  const { editor, project, edits } = editing("edit", [square(5), line(6)]);
  project.select({ contour: 5, point: null });
  editor.moved("axial", screen, [200, 180]); // the middle of the upper side
  editor.openOrClose();
  assert.deepEqual(edits().at(-1), { name: "contour.set", args: { id: 5, closed: false, at: [0, -10, 0] } });
  editor.left();
  project.select({ contour: 5, point: 1 });
  editor.openOrClose();
  assert.deepEqual(edits().at(-1)!.args["at"], [10, 0, 0], "behind the selected point");
  project.select({ contour: 6, point: null });
  editor.openOrClose();
  assert.deepEqual(edits().at(-1), { name: "contour.set", args: { id: 6, closed: true } });
  await Promise.resolve();
});

test("no pointer hits the edge that an open line does not have", () => {
  const left: Point2 = [180, 200]; // between its last corner and its first
  assert.equal(hitContour([square(5)], screen, 1, left, null)?.on, "line");
  assert.equal(hitContour([line(5)], screen, 1, left, null), null);
  assert.equal(hitContour([line(5)], screen, 1, [220, 200], null)?.on, "line");
});

test("the side is turned from where it was found, or told", () => {
  const { editor, project, edits } = editing("edit", [line(6)]);
  project.setSurface({ structure: 1, revision: 1, stage: "finished", triangles: 0, sides: [{ contour: 6, inside: "left", sure: true }] });
  assert.equal(project.sideOf(project.contour(6)!), "left");
  editor.edits.turnSide(project.contour(6)!, "other");
  assert.equal(edits().at(-1)!.args["inside"], "right");
  assert.equal(project.sideOf({ ...project.contour(6)!, inside: "right" }), "right");
  editor.edits.turnSide(project.contour(6)!, "auto");
  assert.equal(edits().at(-1)!.args["inside"], "auto");
});

test("ticks stand at equal distances, on the left hand of whoever walks on the side to which the normal points", () => {
  const ticks = alongLine(
    [
      [0, 0],
      [30, 0],
      [30, 30],
    ],
    20,
  );
  assert.deepEqual(ticks, [
    { at: [10, 0], direction: [1, 0] },
    { at: [30, 0], direction: [1, 0] },
    { at: [30, 20], direction: [0, 1] },
  ]);
  assert.deepEqual(leftOnScreen(screen, AXIAL, [1, 0]), [0, 1], "the normal points into the screen: down, seen from before it");
});

test("what runs along an open line is the nearer part of the loop", () => {
  const loop: Vec3[] = Array.from({ length: 36 }, (_, i) => [10 * Math.cos((i * Math.PI) / 18), 10 * Math.sin((i * Math.PI) / 18), 1]);
  const upper: Vec3[] = [
    [11, 0, 1],
    [0, 11, 1],
    [-11, 0, 1],
  ];
  const part = stretchAlong([loop], upper)!;
  assert.equal(part.length, 19);
  assert.deepEqual([part[0], part.at(-1)], [loop[0], loop[18]]);
  assert.ok(part.every(([, y]) => y > -1e-9));
  const back = stretchAlong([loop], [...upper].reverse())!;
  assert.deepEqual(back, [...part].reverse());
  assert.equal(stretchAlong([], upper), null);
});
