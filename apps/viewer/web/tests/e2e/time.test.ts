// SPDX-License-Identifier: Apache-2.0
// An image of several frames: each can be looked at and drawn on.
import assert from "node:assert/strict";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { circle, cleanUp, openBeating, temporaryFolder, writeBallImage, type Server, type Viewer } from "./support";

const folder = temporaryFolder();
const RADII_MM = [40, 32, 24, 16];
let browser: Browser;
let server: Server;
let viewer: Viewer;
cleanUp(folder, () => [browser, server]);

before(async () => {
  browser = await launch();
  writeBallImage(join(folder.path, "smaller.nii"), undefined, ...RADII_MM.map((radius) => radius - 10));
  [server, viewer] = await openBeating(folder, browser, RADII_MM, 2);
});

const frame = () => viewer.page.locator("[data-test=time-frame]").textContent();

/** Whether the ball reaches this far from the middle in the frame that is seen, as the status line says. */
async function reaches(mm: number): Promise<boolean> {
  await viewer.slicesShown();
  const right = await viewer.pixels("axial", mm);
  await viewer.page.mouse.move(...(await viewer.at("axial", right + 3, 0)));
  await viewer.page.waitForTimeout(150);
  await viewer.page.mouse.move(...(await viewer.at("axial", right, 0)));
  await viewer.page.waitForTimeout(250);
  const text = (await viewer.page.locator(".cursor").textContent())!;
  return Number(/·\s*(-?\d+)/.exec(text)![1]) > 60;
}

/** The shade of the slice at a place on its way out from the middle, between the two sizes of neighbouring frames. */
async function brightAt(mm: number): Promise<boolean> {
  await viewer.slicesShown();
  const [x, y] = [(await viewer.pixels("axial", mm)) * Math.SQRT1_2, -(await viewer.pixels("axial", mm)) * Math.SQRT1_2];
  return viewer.page.evaluate(
    ([right, down]) => {
      const canvas = document.querySelector<HTMLCanvasElement>("[data-view=axial] canvas")!;
      const ratio = canvas.width / canvas.clientWidth;
      return canvas.getContext("2d")!.getImageData(canvas.width / 2 + right * ratio, canvas.height / 2 + down * ratio, 1, 1).data[0]! > 120;
    },
    [x, y] as const,
  );
}

/** Waits until the status line says of the second image whether it reaches this far. */
async function secondReaches(mm: number, wanted: boolean): Promise<void> {
  await viewer.slicesShown();
  const right = await viewer.pixels("axial", mm);
  await viewer.page.mouse.move(...(await viewer.at("axial", right + 3, 0)));
  await viewer.page.waitForTimeout(150);
  await viewer.page.mouse.move(...(await viewer.at("axial", right, 0)));
  await viewer.page.waitForFunction((reaches) => Number(/second (-?\d+)/.exec(document.querySelector(".cursor")!.textContent!)?.[1]) > 60 === reaches, wanted);
}

describe("an image of several frames", () => {
  test("begins with the one that was opened; keys and slider show the others, in all slices and in the status line", async () => {
    const { page } = viewer;
    assert.equal(await frame(), "2 / 4");
    assert.deepEqual([await brightAt(28), await brightAt(36)], [true, false]);
    await page.keyboard.press(".");
    assert.equal(await frame(), "3 / 4");
    assert.deepEqual([await brightAt(20), await brightAt(28)], [true, false]);
    assert.deepEqual([await reaches(20), await reaches(28)], [true, false]);
    await page.keyboard.press(",");
    await page.keyboard.press(",");
    assert.equal(await frame(), "1 / 4");
    assert.equal(await brightAt(36), true);
    await page.keyboard.press(",");
    assert.equal(await frame(), "4 / 4", "before the first comes the last");
    const slider = page.locator("[data-test=time-slider]");
    await slider.focus();
    await page.keyboard.press("ArrowLeft");
    assert.equal(await frame(), "3 / 4");
    await page.click("[data-test=own-time]");
    assert.equal(await frame(), "2 / 4");
    assert.equal(await page.locator("[data-test=own-time]").isDisabled(), true);
    assert.equal(await brightAt(28), true);
  });

  test("a line that is begun in a frame is ended there", async () => {
    const { page } = viewer;
    await page.keyboard.press(".");
    await page.keyboard.press("l");
    const reach = await viewer.pixels("axial", RADII_MM[2]!);
    for (const [right, down] of circle(reach, 5).slice(0, 3)) await viewer.click("axial", right, down);
    await page.keyboard.press(",");
    await viewer.click("axial", reach, 20);
    const notice = page.locator(".notice", { hasText: "What you are drawing belongs to frame 3; this is frame 2." });
    await notice.waitFor();
    await page.keyboard.press("Enter");
    await viewer.saved();
    assert.equal(await viewer.contours(), 0);
    await notice.locator("button", { hasText: "Go to frame 3" }).first().click();
    assert.equal(await frame(), "3 / 4");
    await page.keyboard.press("Enter");
    await viewer.waitForContours(1);
    assert.equal(await page.locator(".time-mark").getAttribute("data-time"), "2");
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(0);
    await page.keyboard.press(",");
    await page.keyboard.press("v");
  });

  test("has a second image of as many frames beside it that moves in time with it", async () => {
    const { page } = viewer;
    await page.click("[data-test=add-image]");
    await page.locator('.add-image [data-test=entries] button[title$="/smaller.nii"]').click();
    await page.locator("[data-test=add-image-problem]", { hasText: "has 4 frames" }).waitFor();
    await viewer.type(page.locator(".add-image [data-test=frame]"), "2");
    await page.keyboard.press("Enter");
    await page.waitForSelector(".add-image", { state: "detached" });
    await page.keyboard.press("i"); // it alone: a ball that is 10 mm smaller than the first one's
    await page.waitForTimeout(300);
    await secondReaches(18, true);
    await secondReaches(26, false);
    const asked: (number | undefined)[] = [];
    page.on("request", (request) => {
      const slice = request.url().endsWith("/api/slice") ? (request.postDataJSON() as { image?: number; time?: number } | null) : null;
      if (slice?.image === 1) asked.push(slice.time);
    });
    await page.keyboard.press(",");
    await secondReaches(26, true);
    assert.ok(asked.length > 0 && asked.every((time) => time === 0), `its slices are asked for at ${asked.join()}`);
    await page.keyboard.press(".");
    await page.keyboard.press(".");
    await secondReaches(10, true);
    await secondReaches(18, false);
    assert.equal(asked.at(-1), 2);
    await page.keyboard.press(",");
    viewer.complaints.splice(0); // Chromium tells of the refusal that asked for a frame
    await page.click("[data-test=remove-image]");
  });

  test("is played by T, and paused by it", async () => {
    const { page } = viewer;
    await page.keyboard.press("t");
    const seen = new Set<string | null>();
    for (let n = 0; n < 200 && seen.size < 4; ++n) {
      seen.add(await frame());
      await page.waitForTimeout(20);
    }
    assert.equal(seen.size, 4);
    assert.equal(await page.locator("[data-test=play]").getAttribute("aria-label"), "Pause (T)");
    await page.keyboard.press("t");
    const stopped = await frame();
    await page.waitForTimeout(400);
    assert.equal(await frame(), stopped);
    assert.deepEqual(viewer.complaints, []);
  });
});
