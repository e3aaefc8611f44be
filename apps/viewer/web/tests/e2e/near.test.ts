// SPDX-License-Identifier: Apache-2.0
// What others drew on a DICOM image, in files near it.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdirSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { circle, cleanUp, Server, temporaryFolder, Viewer } from "./support";

const folder = temporaryFolder();
const python = process.env["KONTUR_TEST_PYTHON"];
const script = process.env["KONTUR_DICOM_SERIES"];
const skip = python && script ? false : "no script that writes DICOM files";
const series = join(folder.path, "study", "dicom");
const plan = join(folder.path, "study", "plan", "RS.dcm");
let browser: Browser;
let projects = 0;

/** A CT of a few voxels with a structure set beside its folder, as the page itself exports it. */
before(async () => {
  browser = await launch();
  if (skip) return;
  const { status, stderr } = spawnSync(python!, [script!, "axial", join(folder.path, "study")], { encoding: "utf8" });
  assert.equal(status, 0, stderr);
  await visit([series], async (viewer) => {
    await viewer.closeHint();
    await viewer.page.keyboard.press("f");
    // Its surface reaches no other slice, 2.5 mm away, so that one contour is exported.
    await viewer.drag("axial", circle(await viewer.pixels("axial", 2), 24));
    await viewer.waitForContours(1);
    await viewer.rename(0, "Lymph node");
    await viewer.saved();
    mkdirSync(join(folder.path, "study", "plan"));
    writeFileSync(plan, (await viewer.export("rtstruct.dcm")).bytes);
  });
});

cleanUp(folder, () => [browser]);

async function visit(words: string[], act: (viewer: Viewer) => Promise<void>): Promise<void> {
  const server = await Server.start(folder.path, ...words, "--project", join(folder.path, `near${++projects}.kontur`));
  try {
    const viewer = await Viewer.open(browser, server.address);
    await act(viewer);
    assert.deepEqual(viewer.complaints, []);
    await viewer.page.close();
  } finally {
    await server.end();
  }
}

const names = (viewer: Viewer) => viewer.page.locator(".structure-row button.name").allTextContents();

describe("a structure set near the image", { skip }, () => {
  test("is offered with the names of its structures, and comes in in place of the empty one", async () => {
    await visit([series], async (viewer) => {
      const { page } = viewer;
      const offer = page.locator("[data-test=near-drawings]");
      await offer.waitFor();
      const text = await offer.innerText();
      for (const words of ["RS.dcm", "Structure set", "Lymph node"]) assert.ok(text.includes(words), text);
      await page.click("[data-test=near-import]");
      await page.check("[data-test=import-as-contours]");
      await page.click("[data-test=import-mask]");
      await viewer.waitForContours(1);
      assert.deepEqual(await names(viewer), ["Lymph node"]);
      await offer.waitFor({ state: "hidden" });
      assert.equal(await page.locator("[data-test=first-hint]").count(), 0, "whoever imports has begun");
      await viewer.surfaceShown();
      await page.keyboard.press("Control+z");
      await viewer.waitForContours(0);
      await offer.waitFor();
      await page.click("[data-test=near-decline]");
      await offer.waitFor({ state: "hidden" });
      await page.click("[data-test=import]");
      await page.click("[data-test=import-dialog] [data-test=near-import]");
      await page.check("[data-test=import-as-contours]");
      await page.click("[data-test=import-mask]");
      await viewer.waitForContours(1);
    });
  });

  test("is asked for its planes where it is a segmentation, near the image or chosen", async () => {
    const segmentation = join(folder.path, "study", "seg.dcm");
    await visit([plan], async (viewer) => {
      await viewer.waitForContours(1);
      writeFileSync(segmentation, (await viewer.export("seg.dcm")).bytes);
    });
    mkdirSync(join(folder.path, "study", "seg"));
    renameSync(segmentation, join(folder.path, "study", "seg", "Segments.dcm"));
    await visit([series], async (viewer) => {
      const { page } = viewer;
      await viewer.closeHint();
      const trace = async (planes: string) => {
        await page.check("[data-test=import-as-contours]");
        await page.locator("[data-test=mask-dialog]").getByLabel("Planes along each axis").fill(planes);
        await page.click("[data-test=import-mask]");
      };
      await page.locator("[data-test=near-drawing]", { hasText: "Segments.dcm" }).locator("[data-test=near-import]").click();
      await page.check("[data-test=import-as-contours]");
      await page.locator("[data-test=mask-dialog] select").selectOption("axial");
      await trace("0"); // which the dialog refuses by itself
      await page.locator("[data-test=mask-dialog] input:invalid").waitFor();
      await page.locator("[data-test=mask-dialog] input[type=number]").fill("1");
      await page.keyboard.press("Enter");
      await viewer.waitForContours(1);
      await page.click("[data-test=import]");
      const [chooser] = await Promise.all([page.waitForEvent("filechooser"), page.click("[data-test=import-file]")]);
      await chooser.setFiles(join(folder.path, "study", "seg", "Segments.dcm"));
      await trace("1");
      await viewer.waitForContours(4);
    });
    rmSync(join(folder.path, "study", "seg"), { recursive: true });
  });

  test("that is opened itself brings its images", async () => {
    await visit([plan], async (viewer) => {
      await viewer.waitForContours(1);
      assert.deepEqual(await names(viewer), ["Lymph node"]);
      assert.ok((await viewer.page.locator("[data-test=identity]").innerText()).includes("Phantom, One"));
    });
  });
});
