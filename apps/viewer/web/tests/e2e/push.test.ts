// SPDX-License-Identifier: Apache-2.0
// The round brush under a real pointer, and how lines look.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

/** The ball, drawn on the axial slice through its middle. */
beforeEach(async () => {
  viewer = await visits.next();
  await viewer.drawBall("axial");
  await viewer.surfaceShown();
});

type Drawing = { planes: { contours: { points: [number, number, number][] }[] }[] };

const contours = async () =>
  (JSON.parse((await viewer.export("contours.json")).bytes.toString()) as Drawing).planes.flatMap((plane) => plane.contours.map(({ points }) => points));
const right = (points: [number, number, number][]) => Math.max(...points.map(([x]) => x));
const left = (points: [number, number, number][]) => Math.min(...points.map(([x]) => x));

describe("the brush", () => {
  test("pushes the line out from inside as far as its rim goes, in one step", async () => {
    const { page } = viewer;
    const [before] = await contours();
    await page.keyboard.press("p");
    const edge = await viewer.pixels("axial", BALL_RADIUS_MM);
    await viewer.drag("axial", [
      [edge - 45, 0],
      [edge - 30, 0],
      [edge - 15, 0],
      [edge - 5, 0],
    ]);
    await viewer.waitForStep("undo", "Push a contour");
    await viewer.saved();
    const mm = BALL_RADIUS_MM / edge;
    const [after] = await contours();
    assert.ok(
      Math.abs(right(after!) - (right(before!) + (24 - 5) * mm)) < 1.5 * mm + 0.2,
      `${right(after!)} after ${right(before!)}; the brush reaches ${(24 - 5) * mm} mm beyond`,
    );
    assert.equal(left(after!), left(before!));
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("undo", "Draw a contour");
    await viewer.saved();
    assert.deepEqual(await contours(), [before]);
  });

  test("is as large as Ctrl and the wheel make it, and the slice does not zoom", async () => {
    const { page } = viewer;
    const mm = BALL_RADIUS_MM / (await viewer.pixels("axial", BALL_RADIUS_MM));
    const [before] = await contours();
    await page.keyboard.press("p");
    await page.mouse.move(...(await viewer.at("axial", 0, 0)));
    await page.keyboard.down("Control");
    for (let i = 0; i < 4; ++i) await page.mouse.wheel(0, 100);
    await page.keyboard.up("Control");
    assert.equal(BALL_RADIUS_MM / (await viewer.pixels("axial", BALL_RADIUS_MM)), mm, "not zoomed");
    const radius = 24 * Math.exp(-1);
    const edge = BALL_RADIUS_MM / mm;
    await viewer.drag("axial", [
      [edge + 40, 0],
      [edge + 20, 0],
      [edge, 0],
      [edge - 6, 0],
    ]);
    await viewer.waitForStep("undo", "Push a contour");
    await viewer.saved();
    const [after] = await contours();
    const dent = Math.max(...after!.filter(([, y]) => Math.abs(y + 1) < 1.5).map(([x]) => x)); // the view's middle lies at y = -1
    assert.ok(
      Math.abs(dent - (right(before!) - (6 + radius) * mm)) < 1.5 * mm + 0.3,
      `dented to ${dent} mm from ${right(before!)}, by ${(6 + radius) * mm} expected`,
    );
  });

  test("pushes the computed outline where nothing is drawn: then it is a contour", async () => {
    const { page } = viewer;
    await page.keyboard.press("p");
    await page.mouse.move(...(await viewer.at("axial", 0, 0)));
    for (let i = 0; i < 3; ++i) await page.mouse.wheel(0, 100);
    await viewer.slicesShown();
    await viewer.surfaceShown();
    const edge = await viewer.pixels("axial", BALL_RADIUS_MM);
    await viewer.drag("axial", [
      [edge - 45, 0],
      [edge - 30, 0],
      [edge - 15, 0],
      [edge, 0],
    ]);
    await viewer.waitForContours(2);
    await viewer.saved();
    await viewer.surfaceShown();
    const [, pushed] = await contours();
    assert.ok(right(pushed!) > BALL_RADIUS_MM * (1 + 18 / edge), `${right(pushed!)} mm`);
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(1);
  });
});

describe("the look of lines", () => {
  /** Opacity and colour in the middle of the outline, of 255. */
  const inside = () =>
    viewer.page.locator("[data-view=axial] .overlay").evaluate(async (canvas: HTMLCanvasElement) => {
      await new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve)));
      return canvas.getContext("2d")!.getImageData(canvas.width / 2 + 21, canvas.height / 2 + 37, 1, 1).data[3]!;
    });

  test("is set by keys in a sheet of its own, which leaves the slices alone, and is kept", async () => {
    const { page } = viewer;
    const slice = await viewer.slice("axial");
    const usual = await inside();
    assert.ok(Math.abs(usual - 0.13 * 255) < 3, `${usual}`);
    await page.click("[data-test=appearance]");
    await page.locator("[data-test=appearance-fill]").focus();
    for (let i = 0; i < 20; ++i) await page.keyboard.press("ArrowRight");
    const strong = await inside();
    assert.ok(Math.abs(strong - 0.33 * 255) < 3, `${strong}`);
    await page.locator("[data-test=appearance-width]").focus();
    await page.keyboard.press("End");
    assert.equal(await page.locator("[data-test=appearance-width]").inputValue(), "3");
    assert.equal(await viewer.slice("axial"), slice);
    await page.keyboard.press("Escape");
    await page.locator("[data-test=appearance-sheet]").waitFor({ state: "hidden" });
    await viewer.saved();
    await page.reload();
    await viewer.ready();
    await viewer.surfaceShown();
    assert.equal(await inside(), strong);
    assert.equal(await page.locator("[data-test=appearance-width]").inputValue(), "3");
  });
});
