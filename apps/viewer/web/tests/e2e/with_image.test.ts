// SPDX-License-Identifier: Apache-2.0
// Five slices of the ball, between which its image shows the border: the page asks it, says so, and can be told not to.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { beforeEach, describe, test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, run, Viewer, voxels } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

const SLICES_MM = [-34, -18, -2, 14, 30];

/** The ball's circles in these slices, as kontur's contours. */
function circles(): string {
  const planes = SLICES_MM.map((z) => {
    const radius = Math.sqrt(BALL_RADIUS_MM ** 2 - z ** 2);
    const points = Array.from({ length: 60 }, (_, i) => [radius * Math.cos((Math.PI * i) / 30), radius * Math.sin((Math.PI * i) / 30), z]);
    return { origin: [0, 0, z], normal: [0, 0, 1], contours: [{ points }] };
  });
  return JSON.stringify({ version: 1, frame: "LPS mm", structure: "Ball", planes });
}

/** All is computed, and this became of the image. */
async function imageIs(verdict: string): Promise<void> {
  const { page } = viewer;
  await page.waitForFunction((wanted) => {
    const { stage, image } = document.querySelector<HTMLElement>(".panel")!.dataset;
    return stage === "finished" && image === wanted;
  }, verdict);
  await viewer.surfaceShown();
}

/** Views in which a dotted line shows what the contours alone make. */
const withLineOfContours = () => viewer.page.locator(".pane.slice[data-without-image]:not([data-without-image=''])").count();

const sentence = () => viewer.page.locator("[data-test=image-sentence]").textContent();

async function exportedMask(): Promise<Buffer> {
  return voxels((await viewer.export("mask.nii.gz")).bytes);
}

function segmented(...words: string[]): Buffer {
  const [contours, image, mask] = ["ball.json", "ball.nii", "own.nii.gz"].map((name) => join(visits.folder.path, name)) as [string, string, string];
  run("segment", contours, "--image", image, "--output", mask, "--quiet", ...words);
  return voxels(readFileSync(mask));
}

beforeEach(async () => {
  viewer = await visits.next();
  const contours = join(visits.folder.path, "ball.json");
  writeFileSync(contours, circles());
  await viewer.import(contours);
  await viewer.waitForContours(SLICES_MM.length);
  await imageIs("used");
});

describe("the image between the contours", () => {
  test("makes the surface that kontur segment makes, says so, and shows what contours alone make beside it", async () => {
    assert.match(
      (await sentence())!,
      /^The image lowers (the error at left-out contours from [0-9.]+ to [0-9.]+ mm|what is wrong in left-out planes from [0-9.]+ to [0-9.]+ % of the object); (used|followed [0-9]+ % of the way) between the contours(, voxel by voxel)?\.$/,
    );
    assert.equal(await withLineOfContours(), 4);
    assert.ok((await exportedMask()).equals(segmented()), "the same voxels");
    assert.deepEqual(viewer.complaints, []);
  });

  test("is left out by a switch, which the keyboard reaches and undo takes back", async () => {
    const { page } = viewer;
    const withImage = await exportedMask();
    const box = page.locator("[data-test=use-image]");
    await box.focus();
    await page.keyboard.press("Space");
    await viewer.waitForStep("undo", "Do not use the image");
    await imageIs("none");
    assert.equal(await box.isChecked(), false);
    assert.equal(await page.locator("[data-test=image-sentence]").count(), 0);
    assert.equal(await withLineOfContours(), 0);
    const alone = await exportedMask();
    assert.ok(alone.equals(segmented("--use-image", "off")) && !alone.equals(withImage));
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("redo", "Do not use the image");
    await imageIs("used");
    assert.ok(await box.isChecked());
    await box.click();
    await viewer.waitForStep("undo", "Do not use the image");
    await imageIs("none");
    await page.reload();
    await viewer.ready();
    assert.equal(await box.isChecked(), false, "it is kept with the project");
    assert.deepEqual(viewer.complaints, []);
  });

  test("is asked anew after each edit, and not at all where too little is drawn", async () => {
    const { page } = viewer;
    let left = SLICES_MM.length;
    for (const row of [2, 1, 1]) {
      await viewer.show(row);
      await page.keyboard.press("Delete");
      await viewer.waitForContours(--left);
    }
    await imageIs("unknown");
    assert.equal(await sentence(), "Too little is drawn to tell whether the image helps between the contours; not used.");
    assert.equal(await withLineOfContours(), 0);
    while (left < SLICES_MM.length) {
      await page.keyboard.press("Control+z");
      await viewer.waitForContours(++left);
    }
    await imageIs("used");
    assert.deepEqual(viewer.complaints, []);
  });
});
