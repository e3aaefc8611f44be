// SPDX-License-Identifier: Apache-2.0
// Single points that the surface passes, set on slices and on the surface in 3D.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();

async function opened(): Promise<Viewer> {
  const viewer = await visits.next();
  await viewer.page.keyboard.press("f");
  for (const view of ["axial", "coronal"]) {
    await viewer.drag(view, circle(await viewer.pixels(view, BALL_RADIUS_MM), 48));
    await viewer.waitForContours(view === "axial" ? 1 : 2);
  }
  await viewer.surfaceShown();
  return viewer;
}

const points = (viewer: Viewer) => viewer.page.locator("[data-test=surface-point]");
const place = async (viewer: Viewer, row: number) => (await points(viewer).nth(row).locator("button").first().textContent())!;
const millimetres = (text: string) => [...text.matchAll(/([RLAPIS]) ([\d.]+)/g)].map(([, letter, mm]) => ("RAI".includes(letter!) ? -1 : 1) * Number(mm));
const isDrawn = (viewer: Viewer) => viewer.page.waitForTimeout(900); // a fine frame comes when all rests

async function waitForPoints(viewer: Viewer, count: number): Promise<void> {
  await viewer.page.waitForFunction((wanted) => document.querySelectorAll("[data-test=surface-point]").length === wanted, count);
}

describe("points of the surface", () => {
  test("a click on a slice beyond the outline pulls the surface there; undo, reload and export know the point", async () => {
    const viewer = await opened();
    const { page } = viewer;
    const before = await viewer.volume();
    await page.keyboard.press("q");
    await page.mouse.move(...(await viewer.at("sagittal", 0, 0)));
    assert.match((await page.locator(".hint").textContent())!, /has to pass/);
    const out = (await viewer.pixels("sagittal", BALL_RADIUS_MM + 14)) * Math.SQRT1_2;
    await viewer.click("sagittal", out, -out);
    await waitForPoints(viewer, 1);
    await viewer.surfaceShown();
    const after = await viewer.volume();
    assert.ok(after > before * 1.03, `${before} to ${after} ml`);
    const at = millimetres(await place(viewer, 0));
    assert.ok(Math.abs(Math.hypot(...at) - BALL_RADIUS_MM - 14) < 1.5, `${at}`);
    await viewer.waitForStep("undo", "Point on Structure 1");

    await page.keyboard.press("Control+z");
    await waitForPoints(viewer, 0);
    await viewer.surfaceShown();
    assert.ok(Math.abs((await viewer.volume()) - before) < 0.2);
    await page.keyboard.press("Control+Shift+z");
    await waitForPoints(viewer, 1);
    await viewer.saved();

    const again = await Viewer.open(visits.browser, visits.server.address);
    await waitForPoints(again, 1);
    assert.deepEqual(millimetres(await place(again, 0)), at);
    const { bytes } = await again.export("contours.json");
    const [kept] = (JSON.parse(bytes.toString()) as { surface: number[][] }).surface;
    kept!.forEach((mm, axis) => assert.ok(Math.abs(mm - at[axis]!) < 0.06));
    assert.deepEqual([...viewer.complaints, ...again.complaints], []);
    await again.page.close();
  });

  test("one is dragged on its slice, and removed by Del or its row's cross", async () => {
    const viewer = await opened();
    const { page } = viewer;
    await page.keyboard.press("q");
    const near = (await viewer.pixels("sagittal", BALL_RADIUS_MM)) * Math.SQRT1_2;
    const far = (await viewer.pixels("sagittal", BALL_RADIUS_MM + 10)) * Math.SQRT1_2;
    await viewer.click("sagittal", near, -near);
    await viewer.click("sagittal", -near, -near);
    await waitForPoints(viewer, 2);
    await page.keyboard.press("v");
    await viewer.drag("sagittal", [
      [near, -near],
      [near + 5, -near - 5],
      [far, -far],
    ]);
    await viewer.waitForStep("undo", "Move a point on Structure 1");
    await viewer.surfaceShown();
    assert.ok(Math.abs(Math.hypot(...millimetres(await place(viewer, 0))) - BALL_RADIUS_MM - 10) < 1.5, await place(viewer, 0));
    assert.equal(await points(viewer).first().getAttribute("class"), "contour-row selected");
    await page.keyboard.press("Delete");
    await waitForPoints(viewer, 1);
    await points(viewer).first().hover();
    await points(viewer).first().locator(".icon-button").click();
    await waitForPoints(viewer, 0);
    assert.equal(await viewer.contours(), 2, "the contours are still there");
    assert.deepEqual(viewer.complaints, []);
  });

  test("a click on the surface in 3D keeps it there; a drag turns it, and one more click on the point selects it", async () => {
    const viewer = await opened();
    const { page } = viewer;
    await page.click('.letter-button[title="From the front"]');
    await isDrawn(viewer);
    const click = async (right: number, down: number) => page.mouse.click(...(await viewer.at("surface", right, down)));
    await click(20, -25);
    await isDrawn(viewer);
    assert.equal(await points(viewer).count(), 0, "with Edit it sets nothing");
    await page.keyboard.press("q");
    const move = async (right: number, down: number) => page.mouse.move(...(await viewer.at("surface", right, down)));
    await move(20, -25);
    assert.equal(await page.locator(".surface-canvas").evaluate((canvas) => canvas.style.cursor), "crosshair");
    await click(20, -25);
    await waitForPoints(viewer, 1);
    await viewer.surfaceShown();
    const at = millimetres(await place(viewer, 0));
    assert.ok(Math.abs(Math.hypot(...at) - BALL_RADIUS_MM) < 2, `${at}`);
    assert.ok(at[0]! > 0 && at[1]! < -10 && at[2]! > 0, `${at} is to the left, in front and above`);
    await isDrawn(viewer);
    await click(21, -24);
    await page.mouse.down();
    await move(60, -20);
    await move(21, -24);
    await page.mouse.up();
    await isDrawn(viewer);
    assert.equal(await points(viewer).count(), 1, "neither the point itself nor a turn and back sets another");
    await page.keyboard.press("Delete");
    await waitForPoints(viewer, 0);
    assert.deepEqual(viewer.complaints, []);
  });
});
