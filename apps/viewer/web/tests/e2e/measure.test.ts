// SPDX-License-Identifier: Apache-2.0
// What is measured, and what leaves the page for all structures at once.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { beforeEach, describe, test } from "node:test";
import { gunzipSync } from "node:zlib";
import { BALL_ML, BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;
const SMALL_MM = 15;

/** The ball, and a smaller one of a structure of its own in its middle. */
beforeEach(async () => {
  viewer = await visits.next();
  await viewer.page.keyboard.press("f");
  let contours = 0;
  for (const radius of [BALL_RADIUS_MM, SMALL_MM]) {
    if (radius === SMALL_MM) await viewer.page.click("[data-test=add-structure]");
    for (const view of ["axial", "coronal"]) {
      await viewer.drag(view, circle(await viewer.pixels(view, radius), 36));
      await viewer.waitForContours(++contours);
    }
  }
  await viewer.surfaceShown();
});

describe("all structures", () => {
  test("are measured: volume, surface, diameter, values; the table is saved as CSV", async () => {
    const { page } = viewer;
    await page.click("[data-test=statistics-open]");
    const row = async (head: string) => (await page.locator("[data-test=statistics] tr", { has: page.locator(`th:text-is("${head}")`) }).locator("td").allInnerTexts()).map(Number);
    await page.locator("[data-test=statistics]").waitFor();
    const [large, small] = await row("Volume, ml");
    const ball = (mm: number) => BALL_ML * (mm / BALL_RADIUS_MM) ** 3;
    assert.ok(Math.abs(large! / ball(40) - 1) < 0.05 && Math.abs(small! / ball(SMALL_MM) - 1) < 0.1, `${large} and ${small} ml`);
    const [diameter] = await row("Largest diameter, mm");
    assert.ok(Math.abs(diameter! - 80) < 4, `${diameter} mm`);
    const [area] = await row("Surface, cm²");
    assert.ok(Math.abs(area! / (4 * Math.PI * 16) - 1) < 0.05, `${area} cm²`);
    const [, mean] = await row("Mean"); // inside of the ball: 100 and a noise of 0 to 20
    assert.ok(Math.abs(mean! - 110) < 1, `mean ${mean}`);
    const [, deviation] = await row("Deviation");
    assert.ok(Math.abs(deviation! - Math.sqrt((21 ** 2 - 1) / 12)) < 0.5, `deviation ${deviation}`);
    const download = page.waitForEvent("download");
    await page.click("[data-test=statistics-csv]");
    const csv = readFileSync(await (await download).path(), "utf8").split("\r\n");
    assert.equal(csv.length, 4);
    assert.match(csv[0]!, /^Structure,Contours,"Volume, ml",/);
    assert.match(csv[2]!, /^Structure 2,2,/);
  });

  test("go into one label map, where the smaller one keeps its voxels, and that is said", async () => {
    const { bytes } = await viewer.export("labels.nii.gz");
    await viewer.page.locator(".notice", { hasText: "belong to Structure 2, the smaller one" }).waitFor();
    const file = gunzipSync(bytes);
    const voxels = file.subarray(Math.round(file.readFloatLE(108)));
    const ml = [1, 2].map((label) => (voxels.filter((value) => value === label).length * 2 * 2 * 4) / 1000);
    const inner = BALL_ML * (SMALL_MM / BALL_RADIUS_MM) ** 3;
    assert.ok(Math.abs(ml[1]! / inner - 1) < 0.15 && Math.abs((ml[0]! + ml[1]!) / BALL_ML - 1) < 0.06, `${ml}`);
  });

  test("go into one archive of surfaces, named as they are", async () => {
    await viewer.rename(0, "Liver/left");
    await viewer.saved();
    const { name, bytes } = await viewer.export("meshes.stl.zip");
    assert.match(name, /_meshes\.stl\.zip$/);
    const names = [...bytes.toString("latin1").matchAll(/PK\x01\x02[^]{42}([\w.-]+?\.stl)/g)].map(([, file]) => file);
    assert.deepEqual(names, ["Liver_left.stl", "Structure_2.stl"]);
  });

  test("of an image that is no DICOM are not offered as DICOM", async () => {
    await viewer.page.click("[data-test=export]");
    await viewer.page.locator('[data-test="export-labels.nii.gz"]').waitFor();
    assert.equal(await viewer.page.locator('[data-test="export-rtstruct.dcm"]').count(), 0);
  });
});
