// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { brushed, newPart, newPartOfOpen, type BrushPoint } from "../../src/geometry/brush";
import { nearestOnPath } from "../../src/geometry/loop";
import { gap, type Point2 } from "../../src/geometry/screen";
import { distance, type Vec3 } from "../../src/geometry/vec";
import type { Contour, SketchPoint } from "../../src/net/protocol";
import { toldOutline } from "../../src/view/outlines";
import { editing } from "./editing";
import { AXIAL, near, square } from "./support";

const ring = (radius: number, count = 90): Point2[] =>
  Array.from({ length: count }, (_, i) => [200 + radius * Math.cos((2 * Math.PI * i) / count), 200 + radius * Math.sin((2 * Math.PI * i) / count)]);
const line = (points: readonly Point2[]): BrushPoint[] => points.map((at, original) => ({ at, original }));
const places = (points: readonly BrushPoint[]) => points.map(({ at }) => at);

test("a brush leaves no line within it, also where it moved far at once, and all else as it was", () => {
  for (const [from, to] of [
    [
      [200, 200],
      [290, 200],
    ],
    [
      [320, 200],
      [270, 200],
    ],
  ] as [Point2, Point2][]) {
    const before = line(ring(80));
    const after = brushed(before, from, to, 24);
    const { distance: away } = nearestOnPath(places(after), to);
    assert.ok(Math.abs(away - 24) < 0.4, `the line lies ${away} pixels from the brush's middle, which has a radius of 24`);
    for (const { at, original } of after) if (original !== undefined) assert.deepEqual(at, before[original]!.at);
    const old = after.filter(({ original }) => original !== undefined).length;
    assert.ok(old > 60 && old < 90, `${old} points are as they were`);
    assert.ok(Math.max(...places(after).map((p, i) => gap(p, places(after)[(i + 1) % after.length]!))) < 8, "no gap");
  }
});

test("an open line has no edge from its end to its beginning that a brush could push", () => {
  const bow = line(ring(80).slice(0, 60)); // from the right by the bottom to the upper left
  assert.equal(brushed(bow, [215, 120], [235, 140], 10, false), bow);
  assert.notEqual(brushed(bow, [215, 140], [235, 170], 30), bow);
  const pushed = brushed(bow, [200, 240], [200, 270], 24, false);
  const part = newPartOfOpen(pushed, bow.length)!;
  assert.ok(part.from > 5 && part.to < 55 && part.points.length > 5);
  assert.deepEqual([part.points[0]!.at, part.points.at(-1)!.at], [bow[part.from]!.at, bow[part.to]!.at]);
  const end = brushed(bow, [300, 200], [275, 200], 24, false);
  assert.equal(newPartOfOpen(end, bow.length), null, "its end is touched: all of it is new");
});

test("a brush that touches nothing changes nothing", () => {
  const before = line(ring(80));
  assert.equal(brushed(before, [200, 200], [220, 200], 24), before);
  assert.equal(brushed(before, [400, 200], [305, 200], 24), before);
});

test("a brush between two points of a straight line finds it", () => {
  const corners = line([
    [0, 0],
    [100, 0],
    [100, 100],
    [0, 100],
  ]);
  const after = brushed(corners, [50, -30], [50, 5], 10);
  assert.equal(after.filter(({ original }) => original !== undefined).length, 4);
  near([nearestOnPath(places(after), [50, 5]).distance], [10], 0.2);
});

test("the new part lies between untouched points, also around the line's first point", () => {
  const after = brushed(line(ring(80)), [200, 200], [275, 200], 24); // where the line begins
  const part = newPart(after)!;
  assert.ok(part.from > 80 && part.to < 10, `from ${part.from} to ${part.to}`);
  assert.deepEqual([part.points[0]!.original, part.points.at(-1)!.original], [part.from, part.to]);
  assert.ok(part.points.slice(1, -1).every(({ original }) => original === undefined));
  assert.equal(newPart(after.map(({ at }) => ({ at }))), null);
});

/** A round contour of 40 mm on the axial slice. */
const drawn = (changes: Partial<Contour> = {}): Contour => {
  const points = ring(80).map(([x, y]): Vec3 => [(x - 200) / 2, (y - 200) / 2, 0]);
  return square(5, { points, control: [{ at: points[0]!, kind: "free", index: 0 }], ...changes });
};

test("a contour that is pushed a little is redrawn there, in one edit", async () => {
  const contour = drawn();
  const { drag, calls, edits, settled } = editing("push", [contour]);
  drag([200, 180], [240, 180], [275, 180]);
  await settled();
  assert.ok(
    calls.some(({ name, args }) => name === "contour.redraw" && args["draft"] === true),
    "the surface follows on the way",
  );
  assert.deepEqual(
    edits().map(({ name }) => name),
    ["contour.redraw"],
  );
  const { id, path, whole } = edits()[0]!.args as { id: number; path: Vec3[]; whole?: boolean };
  assert.equal(id, 5);
  assert.equal(whole, undefined);
  for (const end of [path[0]!, path.at(-1)!])
    assert.ok(
      contour.points.some((p) => distance(p, end) === 0),
      "the ends are points of the contour",
    );
  near([Math.max(...path.map(([x]) => x))], [(275 + 24 - 200) / 2], 0.3);
});

test("a contour that is pushed nearly everywhere is redrawn as a whole", async () => {
  const { drag, edits, settled } = editing("push", [drawn()]);
  drag(...ring(70, 40), [270, 200]);
  await settled();
  const { path, whole } = edits()[0]!.args as { path: Vec3[]; whole?: boolean };
  assert.equal(whole, true);
  for (const p of path) near([Math.hypot(p[0], p[1])], [47], 1.2);
});

test("a contour half a slice beside the view is pushed within its own plane", async () => {
  const beside = drawn({ plane: { ...AXIAL, origin: [0, 0, 0.7] }, points: drawn().points.map(([x, y]): Vec3 => [x, y, 0.7]) });
  const { drag, edits, settled } = editing("push", [beside]);
  drag([200, 180], [275, 180]);
  await settled();
  for (const [, , z] of (edits()[0]!.args as { path: Vec3[] }).path) near([z], [0.7]);
});

test("where nothing is drawn the computed outline is pushed, and becomes a contour", async () => {
  const { server, drag, edits, settled, complaints } = editing("push", []);
  drag([200, 180], [275, 180]);
  assert.match(complaints[0]!, /^Liver has no line on this slice/);
  server.outlines = { plane: { ...AXIAL, origin: [-100, -100, 0], mm_per_pixel: 0.5 }, outlines: [toldOutline(1, 1, [ring(80).flat()])] };
  drag([200, 180], [275, 180]);
  await settled();
  assert.deepEqual(
    edits().map(({ name }) => name),
    ["contour.add"],
  );
  const [{ at, path }] = edits()[0]!.args["control"] as [SketchPoint];
  near([Math.max(...[at, ...path!].map(([x]) => x))], [(275 + 24 - 200) / 2], 0.3);
});

test("a push that reaches no line, or is given up, makes no edit", async () => {
  const { drag, press, edits, settled, calls } = editing("push", [drawn()]);
  drag([200, 200], [210, 200]);
  const gesture = press([200, 180])!;
  gesture.move([275, 180]);
  gesture.cancel!();
  await settled();
  assert.deepEqual(
    edits().map(({ name }) => name),
    ["draft.drop"],
  );
  assert.equal(calls.at(-1)!.name, "draft.drop");
});

test("the wheel with Ctrl makes the brush larger and smaller, within limits, and only with its tool", () => {
  const { editor } = editing("push");
  assert.ok(editor.wheel(1.5));
  assert.equal(editor.pushing.radius, 36);
  editor.wheel(1e6);
  assert.equal(editor.pushing.radius, 200);
  editor.wheel(1e-9);
  assert.equal(editor.pushing.radius, 4);
  editor.choose("edit");
  assert.ok(!editor.wheel(2));
  assert.equal(editor.pushing.radius, 4);
});
