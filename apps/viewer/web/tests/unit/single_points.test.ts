// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import type { Vec3 } from "../../src/geometry/vec";
import { editing, screen } from "./editing";
import { square } from "./support";

/** With points on the active structure, as an event of the server would have them. */
function withPoints(tool: "point" | "edit", ...places: Vec3[]) {
  const all = editing(tool);
  const { project } = all;
  const tell = (...now: Vec3[]) =>
    project.apply({
      event: "changed",
      structures: { set: [{ ...project.structures.get(1)!, surface_points: now.map((at) => ({ at })) }] },
      history: { undo: null, redo: null },
    });
  tell(...places);
  return { ...all, points: all.editor.points, tell, seen: () => all.editor.points.shown().map(({ at }) => at) };
}

test("a click sets a point where it began, and a drag where it ends; it is seen before the server knows it", () => {
  const { drag, edits, seen, tell } = withPoints("point");
  drag([300, 200], [302, 201]);
  drag([100, 200], [100, 120]);
  assert.deepEqual(edits(), [
    { name: "point.add", args: { structure: 1, at: [50, 0, 0], kind: "surface" } },
    { name: "point.add", args: { structure: 1, at: [-50, -40, 0], kind: "surface" } },
  ]);
  assert.deepEqual(seen(), [[-50, -40, 0]]);
  tell([50, 0, 0], [-50, -40, 0]);
  assert.deepEqual(seen(), [
    [50, 0, 0],
    [-50, -40, 0],
  ]);
});

test("a point is dragged with Point and with Edit, and a press alone leaves it where it is", () => {
  for (const tool of ["point", "edit"] as const) {
    const { points, drag, edits, seen } = withPoints(tool, [30, 0, 0.4], [0, 30, 0]);
    drag([260, 200], [261, 200]);
    assert.deepEqual([edits(), points.selected], [[], { structure: 1, kind: "surface", at: [30, 0, 0.4] }]);
    drag([260, 200], [280, 200], [300, 220]);
    assert.deepEqual(edits(), [{ name: "point.move", args: { structure: 1, at: [30, 0, 0.4], to: [50, 10, 0] } }]);
    assert.deepEqual(
      [seen(), points.selected?.at],
      [
        [
          [0, 30, 0],
          [50, 10, 0],
        ],
        [50, 10, 0],
      ],
    );
  }
});

test("Esc lets go of what the hand holds, and a refused edit shows what is", async () => {
  const { press, edits, seen, server, settled, complaints } = withPoints("point", [30, 0, 0]);
  const gesture = press([260, 200])!;
  gesture.move([300, 200]);
  assert.deepEqual(seen(), [[50, 0, 0]]);
  gesture.cancel!();
  assert.deepEqual([seen(), edits()], [[[30, 0, 0]], []]);
  server.refusal = new Error("too far") as never;
  press([100, 100])!.end([100, 100]);
  assert.equal(seen().length, 2);
  await settled();
  assert.deepEqual([seen(), complaints.length], [[[30, 0, 0]], 1]);
});

test("Del removes the selected point, and a contour only where none is selected", () => {
  const { editor, project, drag, edits, points } = withPoints("edit", [30, 0, 0]);
  drag([260, 200], [260, 200]);
  editor.remove();
  project.select({ contour: 5, point: null });
  assert.equal(points.selected, null);
  editor.remove();
  assert.deepEqual(edits(), [
    { name: "point.remove", args: { structure: 1, at: [30, 0, 0] } },
    { name: "contour.remove", args: { ids: [5] } },
  ]);
});

test("a click in 3D sets a point of the structure that is hit; near one that is there it selects that", () => {
  const { editor, project, edits, points } = withPoints("point", [30, 0, 0]);
  project.apply({
    event: "changed",
    structures: { set: [{ id: 2, name: "Spleen", color: "#56b4e9", visible: true }] },
    contours: { set: [square(6, { structure: 2 })] },
    history: { undo: null, redo: null },
  });
  const click = (structure: number, at: Vec3) => editor.tool.clickSurface!(editor, { structure, at, reach_mm: 3 });
  click(1, [31, 2, 0]);
  assert.deepEqual([edits(), points.selected?.at], [[], [30, 0, 0]]);
  click(2, [31, 2, 0]);
  assert.deepEqual(edits(), [{ name: "point.add", args: { structure: 2, at: [31, 2, 0], kind: "surface" } }]);
  assert.equal(project.activeStructure?.id, 2, "it is the one that is worked on");
});

test("nothing is set on a structure that is hidden, or has no contour; points of other slices are not taken", () => {
  const { project, editor, drag, edits, complaints, points } = withPoints("point", [30, 0, 8]);
  assert.equal(points.lyingIn(screen, 2).length, 0);
  project.apply({ event: "changed", structures: { set: [{ ...project.structures.get(1)!, visible: false }] }, history: { undo: null, redo: null } });
  drag([100, 100], [100, 100]);
  assert.match(complaints.at(-1)!, /hidden/);
  project.apply({
    event: "changed",
    structures: { set: [{ ...project.structures.get(1)!, visible: true }] },
    contours: { removed: [5] },
    history: { undo: null, redo: null },
  });
  drag([100, 100], [100, 100]);
  assert.match(complaints.at(-1)!, /Liver has no contour yet/);
  assert.deepEqual([edits(), editor.points.shown().length], [[], 1]);
});
