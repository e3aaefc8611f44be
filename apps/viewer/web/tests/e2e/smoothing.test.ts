// SPDX-License-Identifier: Apache-2.0
// How closely the surface follows the lines of an unsteady hand.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, circle, run, voxels } from "./support";

const visits = new BallVisits();

test("a step of the slider is one of the history, is kept, and exports what kontur segment makes with it", async () => {
  const viewer = await visits.next();
  const { page } = viewer;
  const slider = page.locator("[data-test=smoothing]");
  assert.ok(!(await slider.isVisible()), "not before something is drawn");
  await page.keyboard.press("f");
  for (const [n, view] of ["axial", "coronal"].entries()) {
    const radius = await viewer.pixels(view, BALL_RADIUS_MM);
    await viewer.drag(
      view,
      circle(1, 90).map(([x, y], i) => [x * radius * (1 + 0.05 * Math.sin(1.3 * i)), y * radius * (1 + 0.05 * Math.sin(1.3 * i))]),
    );
    await viewer.waitForContours(n + 1);
  }
  await viewer.surfaceShown();
  const rmsText = async () => (await page.locator(".figure", { hasText: "Residual" }).locator("strong").textContent())!;
  const rms = async () => Number.parseFloat(await rmsText());
  const usualText = await rmsText();
  const usual = Number.parseFloat(usualText);
  const isUsual = () =>
    page.waitForFunction(
      (mm) => [...document.querySelectorAll(".figure")].some((figure) => figure.textContent!.includes("Residual") && figure.textContent!.includes(mm)),
      usualText,
    );
  const slice = await viewer.slice("axial");

  await slider.focus();
  for (const _ of [3, 4, 5]) await page.keyboard.press("ArrowRight");
  await page.waitForFunction(() => document.querySelector("[data-test=smoothing]")!.getAttribute("aria-valuetext") === "smooth");
  await viewer.waitForStep("undo", "Smoothing of Structure 1");
  await viewer.saved();
  await viewer.surfaceShown();
  assert.equal(await viewer.slice("axial"), slice, "the arrow keys are the slider's");
  assert.ok((await rms()) > 1.2 * usual, `residual ${await rms()} mm, usually ${usual} mm`);

  const [contours, mask] = [join(visits.folder.path, "drawn.json"), join(visits.folder.path, "segmented.nii.gz")];
  writeFileSync(contours, (await viewer.export("contours.json")).bytes);
  run("segment", contours, "--image", join(visits.folder.path, "ball.nii"), "--smoothing", "0.01", "--output", mask, "--quiet");
  assert.ok(voxels((await viewer.export("mask.nii.gz")).bytes).equals(voxels(readFileSync(mask))), "the same voxels");

  await page.reload();
  await viewer.ready();
  assert.equal(await slider.getAttribute("aria-valuetext"), "smooth");
  await slider.focus();
  for (const _ of [4, 3, 2]) await page.keyboard.press("ArrowLeft");
  await isUsual();
  for (const _ of [3, 4, 5]) await page.keyboard.press("Control+z");
  await page.waitForFunction(() => document.querySelector("[data-test=smoothing]")!.getAttribute("aria-valuetext") === "smooth");
  for (const _ of [5, 4, 3]) await page.keyboard.press("Control+z");
  await page.waitForFunction(() => document.querySelector("[data-test=smoothing]")!.getAttribute("aria-valuetext") === "usual");
  await isUsual();
  assert.deepEqual(viewer.complaints, []);
});
