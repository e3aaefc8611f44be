// SPDX-License-Identifier: Apache-2.0
// Masks and label maps: what the planes of an import keep, and values that come in and go out.
import assert from "node:assert/strict";
import { join } from "node:path";
import { describe, test } from "node:test";
import { downloaded } from "./browsers";
import { BALL_RADIUS_MM, BallVisits, circle, voxels, writeImage } from "./support";

const visits = new BallVisits();
const file = () => join(visits.folder.path, "spine.nii");

/** Two blocks above each other, of the values 26 and 33. */
function writeLabels(): void {
  writeImage(file(), ([x, y, z]) => (Math.hypot(x, y) > 20 ? 0 : Math.abs(z - 24) < 15 ? 26 : Math.abs(z + 24) < 15 ? 33 : 0));
}

const labelsIn = (bytes: Buffer): number[] => [...new Set(voxels(bytes))].filter((value) => value > 0).sort((a, b) => a - b);

describe("a label map", () => {
  test("keeps its values, which can be changed beside the export", async () => {
    writeLabels();
    const viewer = await visits.next();
    const { page } = viewer;
    await viewer.import(file());
    await page.click("[data-test=import-mask]");
    await page.waitForFunction(() => document.querySelectorAll(".structure").length === 2);
    await viewer.surfaceShown();
    assert.deepEqual(labelsIn((await viewer.export("labels.nii.gz")).bytes), [26, 33]);

    await page.click("[data-test=export]");
    await page.click("[data-test=label-table] summary");
    const fields = page.locator("[data-test=label-value]");
    assert.deepEqual([await fields.nth(0).inputValue(), await fields.nth(1).inputValue()], ["26", "33"]);
    await viewer.type(fields.nth(1), "26");
    await page.keyboard.press("Enter");
    await page.locator(".dialog-status", { hasText: "Label 26 has the label value 26 already" }).waitFor();
    assert.equal(await fields.nth(1).inputValue(), "33", "what was refused is not shown");
    await viewer.type(fields.nth(1), "34");
    await page.keyboard.press("Enter");
    await viewer.waitForStep("undo", "Label value of Label 33");
    const table = await downloaded(page, () => page.click('[data-test="export-labels.csv"]'));
    assert.match(table.bytes.toString(), /^label,name,color\r\n26,Label 26,#[0-9a-f]{6}\r\n34,Label 33,#[0-9a-f]{6}\r\n$/);
    const picture = process.env["KONTUR_PICTURES"];
    if (picture) await page.screenshot({ path: join(picture, "label_values.png") });
    await page.keyboard.press("Escape");
    assert.deepEqual(labelsIn((await viewer.export("labels.nii.gz")).bytes), [26, 34]);
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("undo", "Import a mask");
    assert.deepEqual(labelsIn((await viewer.export("labels.nii.gz")).bytes), [26, 33]);
    assert.deepEqual(
      viewer.complaints.filter((one) => !one.includes("400")),
      [],
    );
  });

  test("is shown with what the planes keep of it before it comes in", async () => {
    writeLabels();
    const viewer = await visits.next();
    const { page } = viewer;
    await viewer.import(file());
    const preview = page.locator("[data-test=tracing-preview]");
    await page.check("[data-test=import-as-contours]");
    await page.click("[data-test=import-preview]");
    await preview.locator("p", { hasText: "Label 26: " }).waitFor();
    await preview.locator("p", { hasText: "Label 33: " }).waitFor();
    assert.match((await preview.locator("p").first().textContent())!, /ml in the file, .* ml from these contours; the two agree to 0\.9\d\d \(Dice\)/);
    const picture = process.env["KONTUR_PICTURES"];
    if (picture) await page.screenshot({ path: join(picture, "tracing_preview.png") });
    await page.locator("[data-test=mask-axes]").selectOption("axial");
    await preview.locator("p").first().waitFor({ state: "detached" });
    await page.keyboard.press("Escape");
    assert.equal(await viewer.contours(), 0);
    assert.deepEqual(viewer.complaints, []);
  });
});

test("strong edges beside a drawn line are named, and a click shows the line", async () => {
  const viewer = await visits.next();
  const { page } = viewer;
  await page.keyboard.press("f");
  const radius = await viewer.pixels("axial", BALL_RADIUS_MM - 8);
  await viewer.drag("axial", circle(radius, 48));
  await viewer.waitForContours(1);
  await viewer.drag("coronal", circle(await viewer.pixels("coronal", BALL_RADIUS_MM), 48));
  await viewer.waitForContours(2);
  await viewer.surfaceShown();
  const sentence = page.locator("[data-test=edges-beside]");
  await sentence.waitFor();
  assert.match((await sentence.textContent())!, /^Strong edges run [78](\.\d)? mm outside of Axial \d+$/);
  await sentence.click();
  await page.waitForSelector(".contour-row.selected");
});
