// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { isInside, nearestOnPath, pulled, pullReach } from "../../src/geometry/loop";
import type { PixelPlane } from "../../src/geometry/plane";
import type { Point2 } from "../../src/geometry/screen";
import { distance, type Vec3 } from "../../src/geometry/vec";
import type { SketchPoint } from "../../src/net/protocol";
import { nearestOutline } from "../../src/tools/free_outlines";
import { toldOutline } from "../../src/view/outlines";
import { editing, screen } from "./editing";
import { AXIAL, near, square } from "./support";

/** Its pixels are those of the screen of `editing`. */
const plane: PixelPlane = { ...AXIAL, origin: [-100, -100, 0], mm_per_pixel: 0.5 };

const ring = (radius: number, x = 200, y = 200, count = 120): Point2[] =>
  Array.from({ length: count }, (_, i) => [x + radius * Math.cos((2 * Math.PI * i) / count), y + radius * Math.sin((2 * Math.PI * i) / count)]);

/** An editor in whose axial view these lines of structure 1 are fitted. */
function fitted(lines: Point2[][], contours = [] as ReturnType<typeof square>[], shownOn = plane) {
  const all = editing("edit", contours);
  all.server.outlines = {
    plane: shownOn,
    outlines: [
      toldOutline(
        1,
        1,
        lines.map((line) => line.flat()),
      ),
    ],
  };
  all.editor.toggleLines(); // which would be hit, too
  return { ...all, hoverAt: (p: Point2) => (all.editor.moved("axial", screen, p), all.editor.hover) };
}

const world = (points: readonly Point2[]): Vec3[] => points.map(([x, y]) => [(x - 200) / 2, (y - 200) / 2, 0]);
const lineOf = (args: Record<string, unknown>): Vec3[] => {
  const [{ at, path }] = args["control"] as [SketchPoint];
  return [at, ...path!];
};

test("a pull moves the point by all of it, those within its reach by less and less, and the rest not", () => {
  const line = world(ring(100));
  const bent = pulled(line, 7, [3, 1, 0], 20);
  near(bent[7]!, [line[7]![0] + 3, line[7]![1] + 1, 0]);
  const moved = bent.map((p, i) => distance(p, line[i]!));
  for (let i = 8; i < 14; ++i) assert.ok(moved[i]! < moved[i - 1]!);
  for (let i = 20; i < 110; ++i) assert.equal(moved[i], 0, "farther than 20 mm along the line");
  near([moved[6]!], [moved[8]!], 1e-12);
  near([moved[119]!], [moved[15]!], 1e-12); // beyond the line's first point
  near([pullReach(line)], [(2 * Math.PI * 50) / 8], 0.01);
});

test("the nearest place of a closed line may lie between its last point and its first", () => {
  const corners: Point2[] = [
    [0, 0],
    [10, 0],
    [10, 10],
    [0, 10],
  ];
  assert.deepEqual(nearestOnPath(corners, [-3, 4]), { index: 3, at: [0, 4], distance: 3 });
  assert.deepEqual(nearestOnPath(corners, [4, 1]), { index: 0, at: [4, 0], distance: 1 });
});

test("the inside of a line that turns back is inside", () => {
  const hook: Point2[] = [
    [0, 0],
    [10, 0],
    [10, 10],
    [8, 10],
    [8, 2],
    [0, 2],
  ];
  assert.ok(isInside(hook, [9, 8]) && isInside(hook, [4, 1]));
  assert.ok(!isInside(hook, [4, 5]) && !isInside(hook, [12, 5]) && !isInside(hook, [-1, 1]));
});

test("a dragged outline becomes a contour in one edit, which the surface follows on the way", async () => {
  const { press, settled, calls, edits, drawing, project } = fitted([ring(80)]);
  const gesture = press([280, 201])!;
  for (const x of [290, 300]) {
    gesture.move([x, 201]);
    await settled();
  }
  const drafts = calls.filter(({ args }) => args["draft"] === true);
  assert.deepEqual(
    drafts.map(({ name }) => name),
    ["contour.add", "contour.add"],
  );
  assert.ok(Math.max(...drawing.handLine.map(([x]) => x)) > 49.9, "the line is seen at once");
  gesture.end([306, 201]);
  await settled();
  assert.deepEqual(
    edits().map(({ name }) => name),
    ["contour.add"],
  );
  const line = lineOf(edits()[0]!.args);
  near([Math.max(...line.map(([x]) => x))], [53], 0.05);
  near([Math.min(...line.map(([x]) => x))], [-40], 1e-9);
  assert.equal(edits()[0]!.args["structure"], 1);
  assert.equal(edits()[0]!.args["hole"], undefined);
  assert.deepEqual(drawing.handLine, []);
  assert.equal(project.activeStructure?.id, 1);
});

test("a click on an outline moves the crosshair there, and Esc gives a pull up", async () => {
  const { press, settled, calls, edits, navigation } = fitted([ring(80)]);
  press([280, 200])!.end([281, 200]);
  near(navigation.crosshair, [40, 0, 0]);
  const gesture = press([200, 280])!;
  gesture.move([200, 300]);
  gesture.cancel!();
  await settled();
  assert.equal(calls.at(-1)!.name, "draft.drop");
  assert.deepEqual(
    edits().filter(({ name }) => name !== "draft.drop"),
    [],
  );
});

test("with a drawing tool an outline is not in the way", async () => {
  const { editor, drawing, press } = fitted([ring(80)]);
  editor.choose("wire");
  press([280, 200])!.end([280, 200]);
  assert.equal(drawing.sketch?.points.length, 1);
});

test("where the structure is drawn on the slice its outline cannot be taken, elsewhere on the slice it can", () => {
  const { hoverAt } = fitted([ring(30), ring(20, 320, 320)], [square(5)]);
  assert.deepEqual(hoverAt([230, 200]), null);
  assert.ok("outline" in hoverAt([340, 320])!);
  const besides = fitted([ring(30)], [square(5, { plane: { ...AXIAL, origin: [0, 0, 4] } })]);
  assert.ok("outline" in besides.hoverAt([230, 200])!, "a contour two slices away is none on this slice");
  const hidden = fitted([ring(30)], [square(5, { visible: false })]);
  assert.equal(hidden.hoverAt([230, 200]), null, "hidden contours count for the surface");
});

test("outlines of the slice that was shown before are not taken for this one's", () => {
  assert.ok("outline" in fitted([ring(80)]).hoverAt([280, 200])!);
  assert.equal(fitted([ring(80)], [], { ...plane, origin: [-100, -100, 2] }).hoverAt([280, 200]), null);
});

test("a key makes a contour of the outline as it is: the one under the pointer, or else the nearest", async () => {
  const lines = [ring(80), ring(20, 330, 330)];
  const { editor, hoverAt, settled, edits } = fitted(lines);
  hoverAt([281, 200]);
  editor.adoptOutline("axial");
  hoverAt([352, 335]);
  editor.adoptOutline("axial");
  editor.left();
  editor.adoptOutline("axial");
  await settled();
  await settled();
  await settled();
  assert.deepEqual(
    edits().map(({ name }) => name),
    ["contour.add", "contour.add", "contour.add"],
  );
  [0, 1, 0].forEach((which, i) => {
    const line = lineOf(edits()[i]!.args);
    assert.equal(line.length, 120);
    line.forEach((p, k) => near(p, world(lines[which]!)[k]!, 1e-9));
  });
});

test("the outline of a cavity becomes a hole", async () => {
  const { editor, hoverAt, settled, edits } = fitted([ring(80), ring(20)]);
  hoverAt([221, 200]);
  editor.adoptOutline("axial");
  await settled();
  assert.equal(edits()[0]!.args["hole"], true);
});

test("where there is nothing to adopt, or a contour is being drawn, the key says so", () => {
  const { editor, drawing, complaints, calls } = fitted([]);
  editor.adoptOutline("axial");
  assert.match(complaints[0]!, /^Liver has no outline on this slice/);
  editor.choose("spline");
  editor.press("axial", screen, [100, 100], { ctrl: false, shift: false })!.end([100, 100]);
  assert.ok(drawing.sketch);
  editor.adoptOutline("axial");
  assert.match(complaints[1]!, /^Close the contour that you are drawing first/);
  assert.deepEqual(
    calls.filter(({ name }) => name === "contour.add"),
    [],
  );
});

test("of several outlines the nearest is found", () => {
  const outlines = [80, 20].map((radius, structure) => ({ structure, points: world(ring(radius)), seen: ring(radius), isHole: false }));
  assert.equal(nearestOutline(outlines, [225, 200])!.outline.structure, 1);
  assert.equal(nearestOutline(outlines, [270, 200])!.outline.structure, 0);
  assert.equal(nearestOutline([], [0, 0]), null);
});

test("an outline that the image has moved comes with what the contours alone make", () => {
  const told = toldOutline(1, 7, [[0, 0, 4, 0, 4, 4]], [[1, 1, 3, 1, 3, 3, 1, 3]]);
  assert.deepEqual(told.lines, [{ first: 0, count: 3, closed: true }]);
  assert.deepEqual(told.without_image, [{ first: 3, count: 4, closed: true }]);
  assert.deepEqual([...(told.points as number[])].slice(6), [1, 1, 3, 1, 3, 3, 1, 3]);
  assert.ok(!("without_image" in toldOutline(1, 8, [[0, 0, 4, 0, 4, 4]])));
});
