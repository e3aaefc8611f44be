// SPDX-License-Identifier: Apache-2.0
// An image whose slices lie obliquely in the patient, as those of a heart's short axis do.
import assert from "node:assert/strict";
import { join } from "node:path";
import { before, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { BALL_RADIUS_MM, circle, cleanUp, Server, temporaryFolder, Viewer, writeBallImage, type Steps } from "./support";

const folder = temporaryFolder();
let server: Server;
let browser: Browser;
let viewer: Viewer;
cleanUp(folder, () => [browser, server]);

/** Turned by 58 degrees about the left-right axis: nearer to coronal slices than to axial ones. */
const SHORT_AXIS: Steps = [
  [2, 0, 0],
  [0, 2 * Math.cos(1.012), 2 * Math.sin(1.012)],
  [0, -4 * Math.sin(1.012), 4 * Math.cos(1.012)],
];

before(async () => {
  const image = join(folder.path, "heart.nii");
  writeBallImage(image, SHORT_AXIS);
  browser = await launch();
  server = await Server.start(folder.path, image);
  viewer = await Viewer.open(browser, server.address);
  await viewer.closeHint();
});

test("the slices as they were acquired come first, have the keyboard, and are called so", async () => {
  const { page } = viewer;
  const titles = await page.locator(".pane.slice").evaluateAll((panes) =>
    panes
      .map(
        (pane) =>
          ({ title: pane.querySelector(".pane-title")!.textContent, ...pane.getBoundingClientRect().toJSON() }) as { title: string; x: number; y: number },
      )
      .sort((a, b) => a.y - b.y || a.x - b.x)
      .map(({ title }) => title),
  );
  assert.deepEqual(titles, ["Acquisition", "Row", "Column", "Oblique"]);
  const first = page.locator(".pane.focused");
  assert.equal(await first.getAttribute("aria-label"), "Acquisition view");
  assert.equal(await first.locator(".slice-number").textContent(), "20 / 40");
  await page.keyboard.press("ArrowDown");
  assert.notEqual(await first.locator(".slice-number").textContent(), "20 / 40");
  await page.keyboard.press("ArrowUp");
  await page.keyboard.press("1");
  assert.equal(await page.locator(".pane:visible .pane-title").textContent(), "Acquisition");
  await page.keyboard.press("0");
});

test("contours drawn there are called so, too", async () => {
  const view = (await viewer.page.locator(".pane.focused").getAttribute("data-view"))!;
  await viewer.page.keyboard.press("f");
  await viewer.drag(view, circle(await viewer.pixels(view, BALL_RADIUS_MM), 36));
  await viewer.waitForContours(1);
  assert.match((await viewer.page.locator(".contour-row").textContent())!, /^Acquisition 20/);
  assert.deepEqual(viewer.complaints, []);
});
