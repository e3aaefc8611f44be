// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Plane } from "../../src/geometry/plane";
import type { Point2, Screen } from "../../src/geometry/screen";
import type { Vec3 } from "../../src/geometry/vec";
import { ServerError } from "../../src/net/http";
import type { Contour, SketchPoint } from "../../src/net/protocol";
import { hitContour, hitPlaneLines, planeLine } from "../../src/tools/hit";
import { Sketch } from "../../src/tools/sketch";
import { editing, round, screen, type Call } from "./editing";
import { AXIAL, CORONAL, near, SAGITTAL, session, SKEW, square } from "./support";

const plane = { ...AXIAL, origin: [0, 0, 0] as Vec3 };
const line = (count: number): Vec3[] => Array.from({ length: count }, (_, i) => [i, i * i * 0.1, 0]);

test("hand-drawn and clicked stretches make one sketch", () => {
  const sketch = new Sketch(plane, 1, "wire");
  sketch.place([0, 0, 0]);
  sketch.drawFree(line(10));
  sketch.setKind("spline");
  sketch.place([20, 5, 0]);
  assert.deepEqual(
    sketch.points.map((point) => point.kind),
    ["free", "spline", "spline"],
  );
  assert.equal(sketch.points[0]!.path!.length, 8);
  near(sketch.points[1]!.at, [9, 8.1, 0]);
});

test("a hand-drawn stretch keeps its kind when the tool changes", () => {
  const sketch = new Sketch(plane, 1, "line");
  sketch.drawFree(line(10));
  sketch.setKind("wire");
  assert.deepEqual(
    sketch.points.map((point) => point.kind),
    ["free", "wire"],
  );
});

test("removing the last point takes the stretch to it away", () => {
  const sketch = new Sketch(plane, 1, "wire");
  sketch.drawFree(line(10));
  sketch.removeLast();
  assert.deepEqual(sketch.points, [{ at: [0, 0, 0], kind: "wire" }]);
});

test("a contour drawn by hand is one free stretch around", () => {
  const { points } = Sketch.closedFree(plane, 1, line(12));
  assert.equal(points.length, 1);
  assert.equal(points[0]!.kind, "free");
  assert.equal(points[0]!.path!.length, 11);
});

test("a spline's rubber band sends the neighbours that bend it, a wire only its start", () => {
  const sketch = new Sketch(plane, 1, "spline");
  for (const x of [0, 10, 20, 30, 40]) sketch.place([x, 0, 0]);
  assert.equal(sketch.rubberBand([50, 0, 0]).length, 4);
  sketch.setKind("wire");
  assert.equal(sketch.rubberBand([50, 0, 0]).length, 2);
});

test("points snapped to an edge are taken over, unless the server sends others", () => {
  const sketch = new Sketch(plane, 1, "wire");
  sketch.place([0, 0, 0]);
  sketch.adopt([{ at: [1, 1, 0], kind: "wire", index: 0 }]);
  near(sketch.first!, [1, 1, 0]);
  sketch.adopt([]);
  near(sketch.first!, [1, 1, 0]);
});

test("the pointer hits control points before lines, and only contours of this plane", () => {
  const contours = [square(1), square(2, { plane: { ...AXIAL, origin: [0, 0, 8] } }), square(3, { plane: { ...CORONAL, origin: [0, 0, 0] } })];
  const at = (p: Point2) => hitContour(contours, screen, 2, p, null);
  assert.deepEqual(at([181, 179]), { on: "point", contour: 1, index: 0, at: [-10, -10, 0] });
  assert.deepEqual(at([200, 183]), { on: "line", contour: 1, at: [0, -10, 0] });
  assert.equal(at([200, 200]), null);
});

test("of contours that coincide the selected one is hit", () => {
  assert.equal(hitContour([square(1), square(2)], screen, 2, [200, 180], 2)?.contour, 2);
});

test("the mark where a hand-drawn contour begins is no handle", () => {
  const drawn = square(1, { control: square(1).control.slice(0, 1) });
  assert.equal(hitContour([drawn], screen, 2, [180, 180], null)?.on, "line");
});

test("plane lines are hit on their line, their handles and the crosshair", () => {
  const lines = [planeLine(screen, [10, 0, 0], "sagittal", SAGITTAL)!, planeLine(screen, [10, 0, 0], "coronal", CORONAL)!];
  assert.equal(planeLine(screen, [0, 0, 0], "axial", AXIAL), null);
  const crosshair: Point2 = [220, 200];
  assert.deepEqual(hitPlaneLines(lines, crosshair, [221, 203]), { on: "crosshair" });
  assert.deepEqual(hitPlaneLines(lines, crosshair, [222, 90]), { on: "move", view: "sagittal" });
  assert.deepEqual(hitPlaneLines(lines, crosshair, [352, 199]), { on: "turn", view: "coronal" });
  assert.equal(hitPlaneLines(lines, crosshair, [100, 100]), null);
});

test("the freehand tool makes a contour when the button is released", async () => {
  const { drag, edits, settled } = editing("freehand", []);
  drag(...round(40, 90));
  await settled();
  assert.deepEqual(
    edits().map((call) => call.name),
    ["contour.add"],
  );
  const [point] = edits()[0]!.args["control"] as SketchPoint[];
  near(point!.at, [45, 0, 0], 1e-9);
  assert.ok(point!.path!.length > 30);
});

test("with any drawing tool a stroke that comes back to where it began is a contour; one that does not goes on from its end", async () => {
  const { editor, drawing, drag, edits, settled } = editing("wire", []);
  const around = (radius: number): Point2[] => [...round(40, radius), [200 + radius, 194]];
  drag(...around(90));
  await settled();
  editor.choose("spline");
  drag(...around(60));
  await settled();
  assert.deepEqual(
    edits().map(({ args }) => (args["control"] as SketchPoint[]).map(({ kind }) => kind)),
    [["free"], ["free"]],
  );
  drag(...round(40, 90).slice(0, -10)); // open
  await settled();
  drawing.leave();
  drag(...around(4)); // too small to tell
  await settled();
  assert.equal(edits().length, 2);
  assert.notEqual(drawing.sketch, null);
});

test("a slip of the hand is no contour, unless the user insists; a small thing drawn large is one", async () => {
  const { drag, edits, settled, remedies, complaints } = editing("freehand", []);
  drag([200, 200], [203, 203], [207, 202]);
  drag([100, 200], [200, 201], [300, 203], [200, 202]);
  await settled();
  assert.deepEqual(edits(), []);
  assert.match(complaints[0]!, /less than 5 pixels wide/);
  remedies[0]!.act();
  await settled();
  assert.equal(edits().length, 1);
  drag(...round(12, 4));
  await settled();
  assert.equal(edits().length, 2);
});

test("a slip comes back by undo, and Enter makes a contour of it", async () => {
  const { drawing, drag, edits, settled } = editing("freehand", []);
  drag([200, 200], [203, 203], [207, 202]);
  assert.equal(drawing.undoLabel, "Leave the contour");
  drawing.undo();
  drawing.close();
  await settled();
  assert.equal(edits().length, 1);
});

test("nothing is drawn into a hidden structure, proposed or redrawn where it is not seen, until it is shown", async () => {
  const { editor, drawing, project, drag, edits, settled, complaints, remedies } = editing("freehand");
  const [liver] = project.structures.values();
  project.select({ contour: 5, point: null });
  project.apply({ event: "changed", structures: { set: [{ ...liver!, visible: false }] }, history: { undo: null, redo: null } });
  drag(...round(40, 90));
  await editor.proposals.next("axial", 1);
  editor.choose("redraw");
  drag(...round(40, 90));
  await settled();
  assert.deepEqual(edits(), []);
  assert.equal(complaints.filter((text) => text.startsWith("Liver is hidden")).length, 3);
  remedies[0]!.act();
  assert.deepEqual(
    edits().map(({ name, args }) => [name, args]),
    [["structure.set", { id: 1, visible: true }]],
  );
  assert.equal(drawing.sketch, null);
});

test("a hidden structure takes no contour that was begun before, and keeps what is drawn of it", async () => {
  const { drawing, project, drag, edits, settled } = editing("spline", []);
  for (const p of [
    [100, 100],
    [300, 100],
    [300, 300],
  ] as Point2[])
    drag(p);
  const [liver] = project.structures.values();
  project.apply({ event: "changed", structures: { set: [{ ...liver!, visible: false }] }, history: { undo: null, redo: null } });
  drawing.close();
  await settled();
  assert.deepEqual(edits(), []);
  assert.equal(drawing.sketch!.points.length, 3);
});

test("clicks place points of the tool's kind, and a click on the first point closes", async () => {
  const { drawing, drag, edits, settled } = editing("wire", []);
  for (const p of [
    [100, 100],
    [300, 100],
    [300, 300],
  ] as Point2[])
    drag(p);
  await settled();
  assert.equal(drawing.sketch!.points.length, 3);
  drag([103, 98]);
  await settled();
  assert.equal(drawing.sketch, null);
  const control = edits()[0]!.args["control"] as SketchPoint[];
  assert.deepEqual(
    control.map((point) => point.kind),
    ["wire", "wire", "wire"],
  );
});

test("points on an edge lie there, however fast the contour is closed", async () => {
  const { drawing, drag, edits, settled } = editing("wire", [], ([x, y, z]) => [5 * Math.round(x / 5), 5 * Math.round(y / 5), z]);
  for (const p of [
    [103, 98],
    [304, 102],
    [297, 303],
  ] as Point2[])
    drag(p);
  drawing.close();
  await settled();
  const control = edits()[0]!.args["control"] as SketchPoint[];
  assert.deepEqual(
    control.map((point) => point.at),
    [
      [-50, -50, 0],
      [50, -50, 0],
      [50, 50, 0],
    ],
  );
});

test("a hand-drawn stretch in between keeps the contour open, and a second tool continues it", async () => {
  const { editor, drawing, drag, edits, settled } = editing("wire", []);
  drag([100, 100]);
  drag([100, 100], [150, 90], [200, 80], [250, 90], [300, 100]);
  editor.choose("spline");
  drag([300, 300]);
  drawing.close();
  await settled();
  const control = edits()[0]!.args["control"] as SketchPoint[];
  assert.deepEqual(
    control.map((point) => point.kind),
    ["free", "spline", "spline"],
  );
});

test("two points do not make a contour", async () => {
  const { drawing, drag, edits, settled } = editing("spline", []);
  drag([100, 100]);
  drag([200, 100]);
  drawing.close();
  await settled();
  assert.equal(drawing.sketch!.points.length, 2);
  assert.deepEqual(edits(), []);
});

test("dragging a control point sends drafts, then one edit with the last place", async () => {
  const { drag, calls, edits, settled } = editing("edit");
  drag([180, 180], [170, 170], [160, 160]);
  await settled();
  assert.ok(calls.some(({ args }) => args["draft"] === true));
  assert.deepEqual(edits(), [{ name: "contour.move_point", args: { id: 5, index: 0, to: [-20, -20, 0], mm_per_pixel: 0.5 } }]);
});

test("a contour that is removed under the hand is not edited any more, and nobody is told of an error", async () => {
  const { press, project, edits, complaints, server, settled } = editing("edit");
  const gesture = press([180, 180])!;
  gesture.move([170, 170]);
  await settled();
  server.refusal = new ServerError("invalid_input", "there is no contour 5");
  gesture.move([165, 165]); // on its way when Del comes
  project.apply({ event: "changed", contours: { removed: [5] }, history: { undo: null, redo: null } });
  gesture.end([160, 160]);
  await settled();
  assert.deepEqual(edits(), []);
  assert.deepEqual(complaints, []);
});

test("dragging the line bends it there, with Shift it moves the contour", async () => {
  const { drag, press, edits, settled } = editing("edit");
  drag([200, 180], [200, 160]);
  const gesture = press([200, 180], { shift: true })!;
  gesture.move([220, 180]);
  gesture.end([220, 180]);
  await settled();
  assert.deepEqual(
    edits().map(({ name, args }) => [name, args["from"] ?? args["by"]]),
    [
      ["contour.pull", [0, -10, 0]],
      ["contour.translate", [10, 0, 0]],
    ],
  );
});

test("a click on a contour selects it and changes nothing; Ctrl + click inserts a point", async () => {
  const { project, drag, press, edits, settled } = editing("edit");
  drag([200, 180]);
  assert.deepEqual(project.selection, { contour: 5, point: null });
  assert.deepEqual(edits(), []);
  press([210, 180], { ctrl: true });
  await settled();
  assert.deepEqual(
    edits().map((call) => call.name),
    ["contour.insert_point"],
  );
});

test("Del deletes the selected point, then the contour", () => {
  const { editor, drag, edits } = editing("edit");
  drag([180, 180]);
  editor.edits.deleteSelected();
  editor.edits.deleteSelected();
  assert.deepEqual(
    edits().map(({ name, args }) => [name, args["index"] ?? args["ids"]]),
    [
      ["contour.delete_point", 0],
      ["contour.remove", [5]],
    ],
  );
});

test("redrawing sends the path that the hand drew to the contour where it began", async () => {
  const { drag, edits, settled } = editing("redraw");
  drag([180, 190], [170, 195], [165, 200], [170, 205], [180, 210]);
  await settled();
  assert.equal(edits()[0]!.name, "contour.redraw");
  assert.equal((edits()[0]!.args["path"] as Vec3[]).length, 5);
});

test("dragging the coronal plane's line moves the crosshair across it only", () => {
  const { navigation, drag } = editing("edit", []);
  drag([100, 200], [140, 240]);
  near(navigation.crosshair, [0, 20, 0], 1e-9);
});

test("dragging the line of a tilted plane follows the pointer, and leaves the slice that is seen", () => {
  const { navigation, drag } = editing("edit", []);
  navigation.rotate("coronal", "sagittal", 0.4);
  drag([100, 200], [100, 240]);
  near(navigation.crosshair, [0, 20, 0], 1e-9);
});

test("the next slice lies onward, whichever way the contour looks", () => {
  for (const normal of [
    [0, 0, 1],
    [0, 0, -1],
  ] as const) {
    const drawn = square(5);
    const { editor, project, edits } = editing("edit", [{ ...drawn, plane: { ...drawn.plane, normal } }]);
    project.select({ contour: 5, point: null });
    void editor.proposals.next("axial", 1);
    assert.deepEqual(
      edits().map(({ name, args }) => [name, args["structure"], (args["plane"] as Plane).origin]),
      [["outline", 1, [0, 0, -2]]],
    );
  }
});

test("a click on a plane's line moves the crosshair there", () => {
  const { navigation, drag } = editing("edit", []);
  drag([100, 200], [101, 200]);
  near(navigation.crosshair, [-49.5, 0, 0], 1e-9);
});

test("a drawing tool mends the selected contour, and draws over others", async () => {
  const { drawing, project, drag, edits, settled } = editing("wire", [
    square(5),
    square(6, { points: square(6).points.map(([x, y, z]) => [2 * x, 2 * y, z]) }),
  ]);
  project.select({ contour: 5, point: null });
  drag([180, 180], [170, 170]);
  await settled();
  assert.deepEqual(
    edits().map((call) => call.name),
    ["contour.move_point"],
  );
  drag([200, 160]);
  assert.equal(drawing.sketch!.points.length, 1);
});

test("turning a line turns that plane by the pointer's angle about the crosshair", () => {
  const { navigation, drag } = editing("edit", []);
  drag([332, 200], [200, 332]);
  near(navigation.cameras.coronal.axes.u.map(Math.abs), [0, 1, 0], 1e-9);
  assert.ok(!navigation.isTurned("sagittal"));
});

test("a sketch goes on in its own plane only", () => {
  const { editor, drawing, drag } = editing("wire", []);
  drag([100, 100]);
  const elsewhere: Screen = { ...screen, axes: SKEW };
  assert.equal(editor.press("oblique", elsewhere, [50, 50], { ctrl: false, shift: false }), null);
  assert.equal(drawing.sketch!.points.length, 1);
});

test("points of a sketch undo and redo, down to none and back", () => {
  const { drawing, drag } = editing("wire", []);
  const places: Point2[] = [
    [100, 100],
    [200, 100],
    [300, 100],
  ];
  for (const place of places) drag(place);
  const drawn = drawing.sketch!.points.map((point) => point.at);
  for (let i = 0; i < 3; ++i) assert.ok(drawing.undo());
  assert.equal(drawing.sketch, null);
  assert.equal(drawing.undo(), false, "the project's history comes next");
  assert.equal(drawing.redoLabel, "Place a point");
  for (let i = 0; i < 3; ++i) assert.ok(drawing.redo());
  assert.deepEqual(
    drawing.sketch!.points.map((point) => point.at),
    drawn,
  );
  assert.ok(drawing.redo(), "a sketch keeps redo to itself");
  drag([320, 120]);
  drawing.undo();
  drag([330, 130]);
  assert.equal(drawing.redoLabel, null, "a new point drops what was undone");
});

test("a sketch that was left comes back by undo, with its tool, until something else is done", async () => {
  const { editor, drawing, drag, settled } = editing("spline", []);
  drag([100, 100]);
  drag([200, 100]);
  editor.choose("edit");
  assert.equal(drawing.sketch, null);
  assert.equal(drawing.undoLabel, "Leave the contour");
  assert.ok(drawing.undo());
  assert.equal(editor.tool.id, "spline");
  assert.equal(drawing.sketch!.points.length, 2);
  drawing.leave();
  editor.edits.make("structure.add", {});
  await settled();
  assert.equal(drawing.undo(), false);
});

const DISK_FULL = new ServerError("io", "cannot write the project: the disk is full", true);
const LOST = new ServerError("lost", "The connection to kontur was lost.", true);

/** What the server makes of a sketch: lines by hand thinned, control points as they were sent. */
function madeOf(id: number, call: Call): Contour {
  const points: Vec3[] = [];
  const control = (call.args["control"] as SketchPoint[]).map(({ at, kind, path = [] }) => {
    const index = points.length;
    points.push(at, ...path.filter((_, i) => i % 3 === 0));
    return { at, kind, index };
  });
  return square(id, { points, control });
}

test("a closed contour that the server does not take stays, whatever tool comes next, until it does", async () => {
  const { editor, drawing, outbox, drag, settled, server, complaints, savedByTryingAgain } = editing("spline", []);
  for (const p of [
    [100, 100],
    [300, 100],
    [300, 300],
  ] as Point2[])
    drag(p);
  const drawn = drawing.sketch!.points.map((point) => point.at);
  server.refusal = DISK_FULL;
  drawing.close();
  await settled();
  assert.deepEqual(complaints, [DISK_FULL.message]);
  editor.choose("edit");
  assert.ok(outbox.hasUnsaved);
  assert.deepEqual(
    drawing.sketch!.points.map((point) => point.at),
    drawn,
  );
  await savedByTryingAgain();
});

test("a line by hand that the server does not take stays closed, as it was drawn", async () => {
  for (const begun of [false, true]) {
    const { drawing, drag, edits, settled, server } = editing(begun ? "wire" : "freehand", []);
    if (begun)
      for (const p of [
        [100, 100],
        [300, 100],
      ] as Point2[])
        drag(p);
    server.refusal = DISK_FULL;
    if (begun) drag([300, 100], [300, 200], [300, 300], [250, 250], [200, 200], [100, 100]);
    else drag(...round(40, 90));
    await settled();
    assert.ok(drawing.sketch!.isClosed);
    assert.ok(drawing.placedLine.length > 4, "it is seen");
    assert.deepEqual(drawing.placedLine[0], drawing.placedLine.at(-1));
    const drawn = structuredClone(drawing.sketch!.points);
    const tries = edits().length;
    drag([50, 50], [60, 60], [70, 70]);
    server.refusal = null;
    drawing.close();
    await settled();
    assert.deepEqual(
      edits()
        .slice(tries)
        .map(({ name, args }) => [name, args["control"]]),
      [["contour.add", drawn]],
    );
  }
});

test("a contour that was saved before its reply was lost is not offered once more", async () => {
  for (const tool of ["freehand", "spline"] as const) {
    const { drawing, outbox, project, drag, edits, settled, server } = editing(tool, []);
    server.refusal = LOST;
    if (tool === "freehand") drag(...round(40, 90));
    else
      for (const p of [
        [100, 100],
        [300, 100],
        [300, 300],
      ] as Point2[])
        drag(p);
    drawing.close();
    await settled();
    assert.ok(outbox.hasUnsaved);
    project.start(session({ contours: [square(5)] }));
    assert.ok(outbox.hasUnsaved, "another contour is there");
    project.start(session({ contours: [square(5), madeOf(6, edits()[0]!)] }));
    assert.equal(drawing.sketch, null);
    assert.ok(!outbox.hasUnsaved);
  }
});

test("while the next contour is drawn one that was not saved waits, and then comes back", async () => {
  const { drawing, outbox, drag, settled, server } = editing("spline", []);
  for (const p of [
    [100, 100],
    [300, 100],
    [300, 300],
  ] as Point2[])
    drag(p);
  const first = drawing.sketch!;
  const line0 = first.first;
  server.refusal = DISK_FULL;
  drawing.close();
  drag([120, 120]);
  const second = drawing.sketch!;
  await settled();
  assert.equal(drawing.sketch, second);
  assert.ok(outbox.hasUnsaved);
  assert.deepEqual(
    outbox.saved().map((saved) => saved.points),
    [first.saved().points],
  );
  assert.deepEqual(
    outbox.lines().map(({ line }) => [line.length, line[0]]),
    [[4, line0]],
    "and is seen",
  );
  drag([320, 120]);
  drag([320, 320]);
  server.refusal = null;
  drawing.close();
  await settled();
  assert.equal(drawing.sketch, first);
  drawing.leave();
  assert.ok(!outbox.hasUnsaved, "the user gave it up");
});

/** What the server makes of a square by a stroke: it replaces the last side, thinned, and backwards if it was drawn so. */
function redrawnBy(path: Vec3[], backwards = false): Contour {
  const { points, control } = square(5);
  const stroke = [path[0]!, ...path.slice(1, -1).filter((_, i) => i % 2 === 0), path.at(-1)!];
  return square(5, {
    points: [...points, ...(backwards ? stroke.reverse() : stroke)],
    control: control.map((point, i) => (i < 3 ? point : { ...point, kind: "free" })),
  });
}

const STROKE: Point2[] = [
  [180, 215],
  [172, 210],
  [168, 205],
  [166, 200],
  [168, 195],
  [172, 190],
  [180, 185],
];

test("a redrawn piece that the server does not take stays, whatever tool comes next, until it does", async () => {
  const { editor, drawing, outbox, drag, edits, settled, server, complaints, savedByTryingAgain } = editing("redraw");
  server.refusal = DISK_FULL;
  drag(...STROKE);
  await settled();
  assert.deepEqual(complaints, [DISK_FULL.message]);
  assert.ok(outbox.hasUnsaved);
  assert.deepEqual(drawing.placedLine, edits()[0]!.args["path"], "it is seen, as it was drawn");
  drag(...STROKE);
  assert.match(complaints.at(-1)!, /Enter tries again/);
  editor.choose("edit");
  editor.choose("wire");
  await savedByTryingAgain();
  assert.equal(edits()[1]!.name, "contour.redraw");
});

test("a redrawn piece that is given up comes back by undo, one that is undone by redo", async () => {
  const { editor, drawing, outbox, drag, settled, server } = editing("redraw");
  server.refusal = DISK_FULL;
  drag(...STROKE);
  await settled();
  const stroke = drawing.sketch!;
  assert.equal(drawing.undoLabel, "Redraw a part");
  drawing.undo();
  assert.equal(drawing.sketch, null);
  assert.ok(!outbox.hasUnsaved);
  assert.equal(drawing.redoLabel, "Redraw a part");
  editor.choose("edit");
  drawing.redo();
  assert.equal(editor.tool.id, "redraw");
  assert.equal(drawing.sketch, stroke);
  drawing.leave();
  assert.equal(drawing.undoLabel, "Leave the piece");
  drawing.undo();
  assert.equal(drawing.sketch, stroke);
});

test("a redrawn piece that was saved before its reply was lost is not offered once more", async () => {
  for (const backwards of [false, true]) {
    const { drawing, outbox, project, drag, edits, settled, server } = editing("redraw");
    server.refusal = LOST;
    drag(...STROKE);
    await settled();
    const path = edits()[0]!.args["path"] as Vec3[];
    project.start(session({ contours: [square(5), { ...redrawnBy(path), id: 6 }] }));
    project.start(session({ contours: [redrawnBy(path.map(([x, y, z]) => [x + 0.1, y, z]))] }));
    assert.ok(outbox.hasUnsaved, "only other strokes were saved");
    project.start(session({ contours: [redrawnBy(path, backwards)] }));
    assert.equal(drawing.sketch, null);
    assert.ok(!outbox.hasUnsaved);
  }
});

test("a next visit brings back a redrawn piece that was not saved, and not one that was", async () => {
  const { outbox, drag, edits, settled, server } = editing("redraw");
  server.refusal = LOST;
  drag(...STROKE);
  const unsaved = JSON.parse(JSON.stringify(outbox.saved())) as ReturnType<typeof outbox.saved>;
  await settled();
  const path = edits()[0]!.args["path"] as Vec3[];
  const later = editing("edit");
  later.outbox.restore(undefined, unsaved);
  assert.ok(later.outbox.hasUnsaved);
  later.drawing.close();
  await later.settled();
  assert.deepEqual(later.edits(), [{ name: "contour.redraw", args: { id: 5, path } }]);
  const other = editing("edit", [redrawnBy(path)]);
  other.outbox.restore(undefined, unsaved);
  assert.ok(!other.outbox.hasUnsaved);
});

test("a stroke beside the contour's plane is redrawn in that plane", async () => {
  const { drag, edits, settled } = editing("redraw", [
    square(5, { plane: { ...plane, origin: [0, 0, 0.5] }, points: square(5).points.map(([x, y]) => [x, y, 0.5]) }),
  ]);
  drag(...STROKE);
  await settled();
  assert.deepEqual(
    (edits()[0]!.args["path"] as Vec3[]).map((p) => p[2]),
    STROKE.map(() => 0.5),
  );
});

test("a stroke that redraws nothing is put aside with a word", async () => {
  const { drawing, outbox, drag, settled, server, complaints } = editing("redraw");
  server.refusal = new ServerError("invalid_input", "the new part of a contour starts and ends at the same place of it", true);
  drag(...STROKE);
  await settled();
  assert.equal(drawing.sketch, null);
  assert.ok(!outbox.hasUnsaved);
  assert.equal(complaints.length, 1);
});

test("a next visit brings back what was not saved, and not what was", async () => {
  const { drawing: before, drag, edits, settled, server } = editing("spline", []);
  for (const p of [
    [100.123456789, 100],
    [300, 100],
    [300, 300],
  ] as Point2[])
    drag(p);
  server.refusal = LOST;
  before.close();
  const unsaved = before.outbox.saved();
  await settled();
  const { drawing, outbox, complaints } = editing("edit", []);
  outbox.restore(undefined, unsaved);
  assert.equal(drawing.sketch!.points.length, 3);
  assert.ok(outbox.hasUnsaved);
  assert.equal(complaints.length, 1);
  const other = editing("edit", [madeOf(6, edits()[0]!)]).drawing;
  other.outbox.restore({ ...unsaved[0]!, isUnsaved: false }, unsaved);
  assert.equal(other.sketch, null);
  assert.ok(!other.outbox.hasUnsaved);
});

test("a stroke that is no contour is put aside with a word", async () => {
  const { drawing, drag, settled, server, complaints } = editing("freehand", []);
  server.refusal = new ServerError("invalid_input", "a contour needs at least three points that do not lie on one line", true);
  drag([100, 100], [110, 110], [120, 120]);
  await settled();
  assert.equal(drawing.sketch, null);
  assert.equal(complaints.length, 1);
  assert.equal(drawing.undoLabel, "Leave the contour");
});

test("an edit waits for the contour that was closed before it", async () => {
  const { editor, drawing, outbox, drag, edits, settled } = editing("wire", []);
  for (const p of [
    [100, 100],
    [300, 100],
    [300, 300],
  ] as Point2[])
    drag(p);
  drawing.close();
  assert.equal(outbox.lines().length, 1, "it is seen meanwhile");
  editor.edits.make("undo", {});
  await settled();
  assert.equal(outbox.lines().length, 0);
  assert.deepEqual(
    edits().map((call) => call.name),
    ["contour.add", "undo"],
  );
});

test("a sketch survives being saved", () => {
  const sketch = new Sketch(plane, 3, "wire");
  sketch.place([1, 2, 0]);
  sketch.drawFree(line(5));
  const again = Sketch.from(JSON.parse(JSON.stringify(sketch.saved())) as ReturnType<Sketch["saved"]>);
  assert.deepEqual(again.points, sketch.points);
  again.place([9, 9, 0]);
  assert.equal(again.last!.kind, "wire");
});
