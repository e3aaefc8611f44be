// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { measured } from "../../src/model/measurements";
import type { Coding } from "../../src/net/protocol";
import { canShow, colorsOfCodes } from "../../src/view/windowing";
import { editing, screen } from "./editing";

const texts = ({ editor }: ReturnType<typeof editing>) => editor.measuring.measurements.all.map(measured);

test("a drag measures the distance in mm, and its ends can be dragged on", () => {
  const all = editing("measure");
  all.drag([100, 200], [150, 200], [180, 200]);
  assert.deepEqual(texts(all), ["40.0 mm"]); // 0.5 mm to the pixel
  all.drag([180, 200], [200, 200], [180, 260]);
  assert.deepEqual(texts(all), ["50.0 mm"]);
  assert.deepEqual(all.edits(), [], "nothing of the project changes");
});

test("three clicks measure the angle at the second; Esc and another tool give up what was begun", () => {
  const all = editing("measure");
  const { editor, press } = all;
  const click = (x: number, y: number) => press([x, y])?.end([x, y]);
  click(100, 200);
  editor.moved("axial", screen, [160, 200]);
  click(200, 200);
  click(200, 120);
  assert.deepEqual(texts(all), ["90.0°"]);
  click(50, 50);
  assert.equal(editor.leaveBegun(), true);
  assert.equal(editor.leaveBegun(), false);
  click(50, 50);
  click(80, 50);
  editor.choose("edit");
  assert.equal(editor.measuring.begun, null);
  assert.deepEqual(texts(all), ["90.0°"]);
});

test("Del takes the last one away, and contours only when the tool has none", () => {
  const all = editing("measure");
  all.project.select({ contour: 5, point: null });
  all.drag([100, 200], [180, 200]);
  all.editor.remove();
  assert.deepEqual([texts(all), all.edits()], [[], []]);
  all.editor.remove();
  assert.deepEqual(
    all.edits().map(({ name }) => name),
    ["contour.remove"],
  );
});

test("shades of coded values are those of the server's formula, to the last step; outside is black", () => {
  const coding: Coding = { first: -1000, step: 0.05 };
  const window = { center: 40, width: 350 };
  const shades = colorsOfCodes(
    coding,
    window,
    Uint32Array.from({ length: 256 }, (_, shade) => shade),
    0,
  );
  let steps = 0;
  for (let code = 1; code < 65536; code += 7) {
    const value = coding.first + coding.step * (code - 1);
    const exact = (value - window.center) * (255 / window.width) + 128;
    const expected = Math.floor(Math.min(Math.max(exact, 0), 255));
    if (Math.abs(exact - Math.round(exact)) > 1e-6) assert.equal(shades[code], expected, `code ${code}`);
    steps = Math.max(steps, shades[code]!);
  }
  assert.deepEqual([shades[0], steps], [0, 255]);
});

test("a window that the codes are too coarse for is left to the server", () => {
  assert.equal(canShow({ first: 0, step: 0.05 }, { center: 0, width: 350 }), true);
  assert.equal(canShow({ first: 0, step: 15 }, { center: 0, width: 350 }), false);
  assert.equal(canShow({ first: 7, step: 0 }, { center: 0, width: 1e-3 }), true); // one value everywhere
});
