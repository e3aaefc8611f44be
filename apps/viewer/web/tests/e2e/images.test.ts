// SPDX-License-Identifier: Apache-2.0
// What can be opened: any grid, a DICOM folder, nothing at all.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { BALL_ML, BALL_RADIUS_MM, circle, cleanUp, run, Server, SHEARED, temporaryFolder, Viewer, writeBallImage } from "./support";

const folder = temporaryFolder();
let browser: Browser;

before(async () => {
  browser = await launch();
});

cleanUp(folder, () => [browser]);

async function visit(words: string[], act: (viewer: Viewer) => Promise<void>): Promise<void> {
  const server = await Server.start(folder.path, ...words);
  try {
    const viewer = await Viewer.open(browser, server.address);
    await viewer.closeHint();
    await act(viewer);
    assert.deepEqual(viewer.complaints, []);
    await viewer.page.close();
  } finally {
    await server.end();
  }
}

describe("kontur open", () => {
  test("shows a sheared, oblique image without bending it: drawn circles make the ball", async () => {
    const image = join(folder.path, "sheared.nii");
    writeBallImage(image, SHEARED);
    await visit([image], async (viewer) => {
      await viewer.page.keyboard.press("f");
      let contours = 0;
      for (const view of ["axial", "coronal", "oblique"]) {
        await viewer.drag(view, circle(await viewer.pixels(view, BALL_RADIUS_MM), 40));
        await viewer.waitForContours(++contours);
      }
      await viewer.surfaceShown();
      const volume = await viewer.volume();
      assert.ok(Math.abs(volume / BALL_ML - 1) < 0.06, `${volume} ml; the ball has ${BALL_ML.toFixed(0)} ml`);
      // The outline lies where the image changes: live-wire clicks beside the border find it on the sheared slice, too.
      await viewer.page.keyboard.press("l");
      const beside = (await viewer.pixels("sagittal", BALL_RADIUS_MM)) + 2;
      for (const place of circle(beside, 6).slice(0, 6)) await viewer.click("sagittal", ...place);
      await viewer.page.keyboard.press("Enter");
      await viewer.waitForContours(4);
      await viewer.surfaceShown();
      assert.ok(Math.abs((await viewer.volume()) / BALL_ML - 1) < 0.06);
    });
  });

  test("opens a folder of DICOM files, tilted as a gantry is", async (t) => {
    const python = process.env["KONTUR_TEST_PYTHON"];
    const script = process.env["KONTUR_DICOM_SERIES"];
    if (!python || !script) return t.skip("no script that writes DICOM files");
    const { status, stderr } = spawnSync(python, [script, "tilt", join(folder.path, "series")], { encoding: "utf8" });
    assert.equal(status, 0, stderr);
    await visit([join(folder.path, "series", "dicom")], async (viewer) => {
      const identity = await viewer.page.locator("[data-test=identity]").innerText();
      for (const words of ["Phantom, One", "ID P1", "CT", "values in HU"]) assert.ok(identity.includes(words), identity);
      const { page } = viewer;
      await page.mouse.move(...(await viewer.at("axial", 4, 4)));
      await page.waitForFunction(() => /HU$/.test(document.querySelector("[data-test=cursor]")!.textContent ?? ""));
      await page.keyboard.press("f");
      await viewer.drag("axial", circle(await viewer.pixels("axial", 2.5), 24));
      await viewer.waitForContours(1);
      await viewer.surfaceShown();
      assert.equal((await viewer.export("mask.nii.gz")).bytes.readUInt16BE(0), 0x1f8b);
      for (const name of ["rtstruct.dcm", "seg.dcm"]) {
        const file = await viewer.export(name);
        assert.equal(file.bytes.subarray(128, 132).toString(), "DICM");
        const kept = join(folder.path, name);
        writeFileSync(kept, file.bytes);
        run("inspect", kept);
      }
      await page.dblclick(".structure-row button.name");
      await page.keyboard.type("Drawn");
      await page.keyboard.press("Enter");
      await viewer.saved();
      const volume = await viewer.volume();
      const seg = join(folder.path, "again.dcm");
      writeFileSync(seg, (await viewer.export("seg.dcm")).bytes);
      await viewer.import(seg);
      await page.check("[data-test=import-as-contours]");
      await page.click("[data-test=import-mask]"); // on the planes that are proposed
      await page.locator(".structure-row").nth(1).waitFor();
      assert.deepEqual(await page.locator(".structure-row button.name").allTextContents(), ["Drawn", "Drawn"]);
      await viewer.surfaceShown();
      const again = await viewer.volume(); // of an object a few voxels large
      assert.ok(Math.abs(again / volume - 1) < 0.5, `${again} ml came back of ${volume}`);
    });
  });

  test("opens the phantom, the example", async () => {
    await visit(["phantom"], async (viewer) => {
      assert.match((await viewer.page.locator(".file-title").textContent())!, /^Phantom/);
      await viewer.page.keyboard.press("f");
      await viewer.drag("axial", circle(await viewer.pixels("axial", 30), 24));
      await viewer.waitForContours(1);
      await viewer.surfaceShown();
    });
  });
});
