// SPDX-License-Identifier: Apache-2.0
// Single points: set on slices and on the surface in 3D, dragged there, and inside or outside of it, as files have them.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { describe, test } from "node:test";
import { PATIENCE_MS } from "./browsers";
import { BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();

const opened = (): Promise<Viewer> =>
  visits.nextDrawn(async (empty) => {
    await empty.page.keyboard.press("f");
    for (const view of ["axial", "coronal"]) {
      await empty.drag(view, circle(await empty.pixels(view, BALL_RADIUS_MM), 48));
      await empty.waitForContours(view === "axial" ? 1 : 2);
    }
  });

const points = (viewer: Viewer) => viewer.page.locator("[data-test=single-point]");
const place = async (viewer: Viewer, row: number) => (await points(viewer).nth(row).locator("button").first().textContent())!;
const millimetres = (text: string) => [...text.matchAll(/([RLAPIS]) ([\d.]+)/g)].map(([, letter, mm]) => ("RAI".includes(letter!) ? -1 : 1) * Number(mm));
const isDrawn = (viewer: Viewer) => viewer.page.waitForTimeout(900); // a fine frame comes when all rests

async function waitForPoints(viewer: Viewer, count: number): Promise<void> {
  await viewer.page.waitForFunction((wanted) => document.querySelectorAll("[data-test=single-point]").length === wanted, count);
}

/** Imports the drawing that is there once more, changed. */
async function importChanged(viewer: Viewer, change: (drawing: Drawn) => void): Promise<void> {
  const drawing = JSON.parse((await viewer.export("contours.json")).bytes.toString()) as Drawn;
  change(drawing);
  const path = join(visits.folder.path, "changed.json");
  writeFileSync(path, JSON.stringify({ ...drawing, structure: "Imported" }));
  await viewer.import(path);
  await viewer.page.waitForSelector(".structure-row.active button.name[aria-label=Imported]");
}

interface Drawn {
  interior?: number[][];
  exterior?: number[][];
}

describe("points inside and outside", () => {
  test("of a file come in, bend the surface, are turned into others, and go out again", async () => {
    const viewer = await opened();
    const { page } = viewer;
    const before = await viewer.volume();
    const beyond = (BALL_RADIUS_MM + 14) / Math.sqrt(3);
    await importChanged(viewer, (drawing) => Object.assign(drawing, { interior: [[beyond, beyond, beyond]], exterior: [[-70, -70, -60]] }));
    await waitForPoints(viewer, 2);
    await viewer.surfaceShown();
    const bulged = await viewer.volume();
    assert.ok(bulged > before * 1.03, `${before} to ${bulged} ml`);
    const kinds = page.locator("[data-test=point-kind]");
    assert.deepEqual(await kinds.evaluateAll((all) => all.map((one) => (one as HTMLSelectElement).value)), ["interior", "exterior"]);

    await kinds.first().selectOption({ label: "outside" });
    await viewer.waitForStep("undo", "Point outside of Imported");
    await viewer.surfaceShown();
    assert.ok(Math.abs((await viewer.volume()) - before) < 0.03 * before, "outside it is anyway");
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("redo", "Point outside of Imported");

    await points(viewer).first().locator("button").first().click();
    await viewer.slicesShown();
    await page.keyboard.press("v");
    const there = await viewer.pixels("sagittal", beyond); // behind and above of the middle
    await viewer.drag("sagittal", [
      [there, -there],
      [there - 4, 4 - there],
      [there - 20, 20 - there],
    ]);
    await viewer.waitForStep("undo", "Move a point inside of Imported");
    const moved = millimetres(await place(viewer, 0));
    assert.ok(moved[1]! < beyond - 2 && moved[2]! < beyond - 2, `${moved}`);
    const kept = JSON.parse((await viewer.export("contours.json")).bytes.toString()) as Drawn;
    assert.equal(kept.interior?.length, 1);
    assert.deepEqual(kept.exterior, [[-70, -70, -60]]);
    assert.deepEqual(viewer.complaints, []);
  });
});

/** Moves the pointer about a place of the 3D view until it has this shape: what lies there is told by the last frame, which may come late. */
async function pointerBecomes(viewer: Viewer, cursor: string, right: number, down: number): Promise<void> {
  const { page } = viewer;
  for (let n = 0; ; ++n) {
    await page.mouse.move(...(await viewer.at("surface", right + (n % 2), down)));
    const shape = await page
      .locator(".surface-canvas")
      .evaluate((canvas) => new Promise((resolve) => requestAnimationFrame(() => resolve(canvas.style.cursor))));
    if (shape === cursor) return;
    assert.ok(n < PATIENCE_MS / 100, `the pointer is ${String(shape)}`);
    await page.waitForTimeout(100);
  }
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
    await pointerBecomes(viewer, "crosshair", 20, -25);
    await click(20, -25);
    await waitForPoints(viewer, 1);
    await viewer.surfaceShown();
    const at = millimetres(await place(viewer, 0));
    assert.ok(Math.abs(Math.hypot(...at) - BALL_RADIUS_MM) < 2, `${at}`);
    assert.ok(at[0]! > 0 && at[1]! < -10 && at[2]! > 0, `${at} is to the left, in front and above`);
    await isDrawn(viewer);
    await click(21, -24);
    await move(60, -20);
    await page.mouse.down();
    await move(21, -24);
    await move(60, -20);
    await page.mouse.up();
    await isDrawn(viewer);
    assert.equal(await points(viewer).count(), 1, "neither the point itself nor a turn and back sets another");
    await page.keyboard.press("Delete");
    await waitForPoints(viewer, 0);
    assert.deepEqual(viewer.complaints, []);
  });

  test("in 3D a point is dragged along the surface, which does not turn; Esc lets go", async () => {
    const viewer = await opened();
    const { page } = viewer;
    await page.click('.letter-button[title="From the front"]');
    await isDrawn(viewer);
    const move = async (right: number, down: number) => page.mouse.move(...(await viewer.at("surface", right, down)));
    await page.keyboard.press("q");
    await page.mouse.click(...(await viewer.at("surface", 20, -25)));
    await waitForPoints(viewer, 1);
    await viewer.surfaceShown();
    await isDrawn(viewer);
    const first = millimetres(await place(viewer, 0));
    await page.keyboard.press("v"); // by Edit as by Point
    await pointerBecomes(viewer, "grab", 20, -25);
    const letGo = [-30, 22] as const;
    await page.mouse.down();
    await move(-10, 5);
    await move(...letGo);
    await page.keyboard.press("Escape");
    await page.mouse.up();
    await isDrawn(viewer);
    assert.deepEqual(millimetres(await place(viewer, 0)), first, "Esc leaves it where it was");

    await move(20, -25);
    await page.mouse.down();
    await move(-10, 5);
    await move(...letGo);
    await page.mouse.up();
    await viewer.waitForStep("undo", "Move a point on Structure 1");
    const moved = millimetres(await place(viewer, 0));
    assert.ok(Math.abs(Math.hypot(...moved) - BALL_RADIUS_MM) < 2, `${moved} is on the surface`);
    assert.ok(moved[0]! < first[0]! - 5 && moved[1]! < -10 && moved[2]! < first[2]! - 5, `${moved} is to the right of ${first}, in front and below`);
    await viewer.surfaceShown();
    await isDrawn(viewer);
    await pointerBecomes(viewer, "grab", ...letGo); // where it was let go: the view has not turned
    await move(20, -25);
    await page.mouse.down();
    await move(-30, -25);
    await page.mouse.up();
    await isDrawn(viewer);
    assert.deepEqual(millimetres(await place(viewer, 0)), moved, "beside the point a drag turns the view");
    assert.deepEqual(viewer.complaints, []);
  });
});
