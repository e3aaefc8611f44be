// SPDX-License-Identifier: Apache-2.0
// What is fitted is taken by the pointer, and by a key: with real presses, moves and keys.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { nearestOnPath } from "../../src/geometry/loop";
import { BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

const SLICES = 4; // of 4 mm from the one that is drawn, at 2 mm
const HEIGHT_MM = 2 - 4 * SLICES;
const FITTED_MM = Math.sqrt(BALL_RADIUS_MM ** 2 - HEIGHT_MM ** 2);

/** The ball, drawn on the axial and the coronal slice through its middle; the axial view shows another slice. */
beforeEach(async () => {
  viewer = await visits.nextDrawn(async (empty) => {
    await empty.page.keyboard.press("f");
    for (const [i, view] of (["axial", "coronal"] as const).entries()) {
      await empty.drag(view, circle(await empty.pixels(view, BALL_RADIUS_MM), 36));
      await empty.waitForContours(i + 1);
    }
  });
  const { page } = viewer;
  await page.keyboard.press("v");
  await page.mouse.move(...(await viewer.at("axial", 0, 90)));
  for (let i = 0; i < SLICES; ++i) await page.mouse.wheel(0, 100);
  await viewer.slicesShown();
  await viewer.surfaceShown();
});

interface Drawing {
  planes: { origin: number[]; normal: number[]; contours: { points: [number, number, number][] }[] }[];
}

/** The points of the contour that was drawn on the axial slice at this height. */
async function drawnAt(z_mm: number): Promise<[number, number, number][]> {
  const { planes } = JSON.parse((await viewer.export("contours.json")).bytes.toString()) as Drawing;
  const all = planes.flatMap((plane) => plane.contours.map(({ points }) => points));
  return (
    all.find((points) => points.every((p) => Math.abs(p[2] - z_mm) < 0.01)) ?? assert.fail(`no contour at ${z_mm} mm: ${JSON.stringify(all.map(([p]) => p))}`)
  );
}

/** Adopts the outline of the axial slice by the key, with the pointer beside it. */
async function adopted(): Promise<[number, number, number][]> {
  await viewer.page.mouse.move(...(await viewer.at("axial", ...diagonal(40))));
  await viewer.page.keyboard.press("a");
  await viewer.waitForContours(3);
  await viewer.saved();
  return drawnAt(HEIGHT_MM);
}

const diagonal = (pixels: number): [number, number] => [pixels * Math.SQRT1_2, pixels * Math.SQRT1_2];
const cursor = () => viewer.page.locator("[data-view=axial] .overlay").evaluate((canvas) => canvas.style.cursor);
const notice = (words: string) => viewer.page.locator(".notice", { hasText: words });

/** Presses on the outline, away from plane lines, and pulls it outwards by so many mm; the button is still held. */
async function pull(by_mm: number): Promise<void> {
  const { mouse } = viewer.page;
  const from = await viewer.pixels("axial", FITTED_MM);
  const by = await viewer.pixels("axial", by_mm);
  await mouse.move(...(await viewer.at("axial", ...diagonal(from))));
  await viewer.page.waitForFunction(() => document.querySelector<HTMLElement>("[data-view=axial] .overlay")!.style.cursor === "grab");
  await mouse.down();
  for (let i = 1; i <= 8; ++i) await mouse.move(...(await viewer.at("axial", ...diagonal(from + (i * by) / 8))));
}

describe("a computed outline", () => {
  test("is pulled, and is a contour then, bent there and the same elsewhere; one undo takes it back", async () => {
    const { page } = viewer;
    const before = await page.locator("[data-test=undo]").getAttribute("title");
    const fitted = await adopted();
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(2);
    await viewer.surfaceShown();
    await pull(8);
    assert.equal(await viewer.contours(), 2, "nothing is made before the button is released");
    await page.mouse.up();
    await viewer.waitForContours(3);
    await viewer.saved();
    const moved = (await drawnAt(HEIGHT_MM)).map((p) => ({
      p,
      by: nearestOnPath(
        fitted.map(([x, y]) => [x, y]),
        [p[0], p[1]],
      ).distance,
    }));
    const most = moved.reduce((a, b) => (a.by > b.by ? a : b));
    assert.ok(Math.abs(most.by - 8) < 0.8, `pulled by ${most.by} mm`);
    assert.ok(Math.abs(most.p[0] - most.p[1]) < 4 && most.p[0] > 0, `at ${most.p.join()}`);
    const opposite = moved.filter(({ p }) => p[0] < 0 && p[1] < 0).map(({ by }) => by);
    assert.ok(opposite.length > 3 && Math.max(...opposite) < 0.4, `elsewhere by ${Math.max(...opposite)} mm`);
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(2);
    await viewer.saved();
    assert.equal(await page.locator("[data-test=undo]").getAttribute("title"), before);
    await page.keyboard.press("Control+Shift+z");
    await viewer.waitForContours(3);
  });

  test("that is being pulled is let go by Esc, and all is as it was", async () => {
    const volume = await viewer.volume();
    await pull(8);
    await viewer.page.waitForSelector(".panel[data-stage=preview], .panel[data-stage=finished]");
    await viewer.page.keyboard.press("Escape");
    await viewer.page.mouse.up();
    await viewer.surfaceShown();
    await viewer.saved();
    assert.equal(await viewer.contours(), 2);
    assert.ok(Math.abs((await viewer.volume()) - volume) <= 1, "the same, told in whole ml");
  });

  test("is made a contour as it is by A, under the pointer; the next A says that it is drawn already", async () => {
    const { page } = viewer;
    await page.locator("[data-test=use-image]").click(); // which is asked from three planes on, and moves the surface
    await viewer.waitForStep("undo", "Do not use the image");
    await viewer.surfaceShown();
    const volume = await viewer.volume();
    const radii = (await adopted()).map(([x, y]) => Math.hypot(x, y));
    assert.ok(
      radii.every((r) => Math.abs(r - FITTED_MM) < 3),
      `${Math.min(...radii)} to ${Math.max(...radii)}, around ${FITTED_MM} expected`,
    );
    await viewer.surfaceShown();
    assert.ok(Math.abs((await viewer.volume()) / volume - 1) < 0.01, "what is kept as it was changes nothing");
    await page.keyboard.press("a");
    await notice("has no outline on this slice that is not drawn already").waitFor();
    assert.equal(await viewer.contours(), 3);
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(2);
  });

  test("is adopted on the oblique view, too, and with a drawing tool in the hand", async () => {
    const { page } = viewer;
    await page.keyboard.press("l");
    await page.mouse.move(...(await viewer.at("oblique", 5, 5)));
    await page.keyboard.press("a");
    await viewer.waitForContours(3);
    await viewer.saved();
    await page.waitForSelector(".contour-row.selected .contour-plane:has-text('Oblique')");
  });

  test("on a slice where the structure is drawn is left to the contour, and a click on one moves the crosshair", async () => {
    const { page } = viewer;
    const fitted = await viewer.pixels("axial", FITTED_MM);
    const sagittal = await viewer.slice("sagittal");
    await page.mouse.move(...(await viewer.at("axial", ...diagonal(fitted))));
    await page.mouse.click(...(await viewer.at("axial", ...diagonal(fitted))));
    await page.waitForFunction((slice) => document.querySelector<HTMLElement>("[data-view=sagittal]")!.dataset["slice"] !== String(slice), sagittal);
    assert.equal(await viewer.contours(), 2);
    for (let i = 0; i < SLICES; ++i) await page.mouse.wheel(0, -100);
    await viewer.slicesShown();
    await viewer.surfaceShown();
    await page.mouse.move(...(await viewer.at("axial", ...diagonal(await viewer.pixels("axial", BALL_RADIUS_MM)))));
    await page.waitForFunction(() => document.querySelector<HTMLElement>("[data-view=axial] .overlay")!.style.cursor === "pointer");
    assert.equal(await cursor(), "pointer");
  });
});
