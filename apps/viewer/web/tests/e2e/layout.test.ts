// SPDX-License-Identifier: Apache-2.0
// Dividers between the panes, and a page that fits into any window.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { beforeEach, describe, test } from "node:test";
import { BallVisits, Server, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

beforeEach(async () => {
  viewer = await visits.next();
});

const divider = (name: string) => viewer.page.locator(`[data-test=divider-${name}]`);
const width = async (view: string) => (await viewer.pane(view).boundingBox())!.width;
const height = async (view: string) => (await viewer.pane(view).boundingBox())!.height;

async function drag(name: string, right: number, down: number): Promise<void> {
  const box = (await divider(name).boundingBox())!;
  const { mouse } = viewer.page;
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 3]; // beside the place where two of them cross
  await mouse.move(x, y);
  await mouse.down();
  await mouse.move(x + right / 2, y + down / 2);
  await mouse.move(x + right, y + down);
  await mouse.up();
  await viewer.slicesShown();
}

const isNear = (a: number, b: number, pixels = 4) => assert.ok(Math.abs(a - b) <= pixels, `${a} is not ${b}`);

describe("dividers", () => {
  test("are dragged, and their neighbours share what there is", async () => {
    const [axial, sagittal, surface] = [await width("axial"), await width("sagittal"), await width("surface")];
    await drag("columns", 90, 0);
    isNear(await width("axial"), axial + 90);
    isNear(await width("sagittal"), sagittal - 90);
    isNear(await width("surface"), surface);
    const upper = await height("axial");
    await drag("rows", 0, -80);
    isNear(await height("axial"), upper - 80);
    isNear(await height("oblique"), upper + 80);
    await drag("surface", 100, 0);
    isNear(await width("surface"), surface - 100);
    const stage = (await width("axial")) + (await width("sagittal"));
    isNear(stage, axial + sagittal + 100);
    await drag("panel", -120, 0);
    const panel = (await viewer.page.locator(".panel").boundingBox())!.width;
    assert.ok(panel > 350, `${panel} pixels`);
    assert.deepEqual(viewer.complaints, []);
  });

  test("are moved by arrow keys, which then scroll nothing, and put back by Enter or a double click", async () => {
    const { page } = viewer;
    const slice = await viewer.slice("axial");
    const now = async () => Number(await divider("columns").getAttribute("aria-valuenow"));
    await divider("columns").focus();
    for (let i = 0; i < 5; ++i) await page.keyboard.press("ArrowRight");
    assert.equal(await now(), 60);
    await page.keyboard.press("ArrowUp");
    assert.equal(await now(), 60);
    assert.equal(await viewer.slice("axial"), slice);
    await page.keyboard.press("Enter");
    assert.equal(await now(), 50);
    await drag("columns", 60, 0);
    assert.notEqual(await now(), 50);
    const box = (await divider("columns").boundingBox())!;
    await page.mouse.dblclick(box.x + box.width / 2, box.y + box.height / 3);
    assert.equal(await now(), 50);
  });

  test("part the big pane from the others", async () => {
    await viewer.page.click("[data-test=layout-big-slice]");
    await viewer.slicesShown();
    const before = await width("axial");
    await drag("big", -150, 0);
    isNear(await width("axial"), before - 150);
    assert.ok(!(await divider("columns").isVisible()));
  });

  test("stay where they are for the project, and for the next one of the modality", async () => {
    const { page } = viewer;
    await drag("columns", 90, 0);
    await page.click("[data-test=layout-big-surface]");
    await drag("big", -80, 0);
    const wide = await width("surface");
    const kept = () => {
      try {
        return readFileSync(join(visits.folder.path, "kontur", "arrangements.json"), "utf8");
      } catch {
        return ""; // not yet
      }
    };
    // The layout may be kept once before its divider is dragged: only what stays for a second is the last of it.
    for (let tries = 0, last = ""; tries < 30 && !(last.includes("big-surface") && last === kept()); ++tries) {
      last = kept();
      await page.waitForTimeout(1000);
    }
    assert.match(kept(), /big-surface/);
    await page.reload();
    await viewer.ready();
    isNear(await width("surface"), wide);
    await visits.server.end();
    visits.server = await Server.start(visits.folder.path, join(visits.folder.path, "ball.nii"), "--project", join(visits.folder.path, "another.kontur"));
    const other = await Viewer.open(visits.browser, visits.server.address);
    isNear((await other.pane("surface").boundingBox())!.width, wide);
    await other.page.close();
  });
});

describe("a second window", () => {
  test("shows the 3D view alone, looks where the first one does, and leaves its layout alone", async () => {
    const { page } = viewer;
    await page.locator("[data-view=surface]").hover();
    const popup = page.waitForEvent("popup");
    await page.click("[data-test=second-window]");
    const second = await Viewer.opened(await popup);
    assert.equal(await second.page.locator(".pane:visible").count(), 1);
    assert.ok(await second.pane("surface").isVisible());
    await second.page.keyboard.press("0"); // all views
    await second.slicesShown();
    const slices = () => Promise.all([viewer, second].map((one) => one.slice("axial")));
    const begun = await viewer.slice("axial");
    await page.mouse.move(...(await viewer.at("axial", 0, 60)));
    for (let n = 0; n < 3; ++n) await page.mouse.wheel(0, 120);
    await second.page.waitForTimeout(1000);
    assert.deepEqual(await slices(), [begun + 3, begun + 3]);
    await second.page.bringToFront();
    await second.page.mouse.move(...(await second.at("axial", 0, 60)));
    await second.page.mouse.wheel(0, -120);
    await second.page.waitForTimeout(1000);
    assert.deepEqual(await slices(), [begun + 2, begun + 2]);
    await viewer.type(viewer.page.locator(".number").first(), "77");
    await page.keyboard.press("Enter");
    await second.page.waitForFunction(() => document.querySelector<HTMLInputElement>(".number")!.value === "77");
    await second.page.close();
    await page.reload();
    await viewer.ready();
    assert.equal(await page.locator(".pane:visible").count(), 5);
    assert.equal(await viewer.slice("axial"), begun + 2);
    assert.deepEqual([...viewer.complaints, ...second.complaints], []);
  });
});

describe("the page", () => {
  for (const [pageWidth, pageHeight] of [
    [820, 1180],
    [820, 620],
    [1280, 720],
    [1920, 1080],
    [3840, 2160],
  ] as const)
    test(`has everything in reach at ${pageWidth} x ${pageHeight}`, async () => {
      const { page } = viewer;
      await page.setViewportSize({ width: pageWidth, height: pageHeight });
      await viewer.slicesShown();
      for (const view of ["axial", "sagittal", "coronal", "oblique", "surface"]) {
        const box = (await viewer.pane(view).boundingBox())!;
        assert.ok(box.width > 120 && box.height > 120, `${view}: ${box.width} x ${box.height}`);
      }
      const controls = ["tool-edit", "tool-measure", "undo", "presets", "layout-single", "lines", "link", "appearance", "import", "export", "help"];
      const hidden: string[] = [];
      for (const name of controls) if (!(await page.locator(`[data-test=${name}]`).isVisible())) hidden.push(name);
      assert.equal(hidden.length > 0, pageWidth < 1280, hidden.join(" "));
      if (hidden.length > 0) await page.click("[data-test=more]");
      for (const name of controls) {
        const box = (await page.locator(`[data-test=${name}]`).boundingBox())!;
        const isMenu = hidden.includes(name);
        assert.ok(isMenu || box.y < 60, `${name} is in the bar`);
        assert.ok(
          box.x >= 0 && box.x + box.width <= pageWidth && box.y + box.height <= pageHeight,
          `${name} ends at ${box.x + box.width}, ${box.y + box.height}`,
        );
      }
      if (hidden.length === 0) return;
      await page.click("[data-test=layout-single]");
      await page.locator("[data-test=more-menu]").waitFor({ state: "hidden" });
      assert.equal(await page.locator(".pane:visible").count(), 1);
      await page.click("[data-test=more]");
      await page.click("[data-test=help]");
      await page.locator("[data-test=help-dialog]").waitFor();
    });
});
