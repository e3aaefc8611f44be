// SPDX-License-Identifier: Apache-2.0
// A heart that beats: drawn in two frames, seen in all of them.
import assert from "node:assert/strict";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { circle, cleanUp, openBeating, temporaryFolder, type Server, type Viewer } from "./support";

const folder = temporaryFolder();
const FRAMES = 8;
const radius_mm = (frame: number) => 30 + 8 * Math.cos((2 * Math.PI * (frame - 1)) / FRAMES); // 38 in frame 1, 22 in frame 5
let browser: Browser;
let server: Server;
let viewer: Viewer;
cleanUp(folder, () => [browser, server]);

before(async () => {
  browser = await launch();
  const radii = Array.from({ length: FRAMES }, (_, n) => radius_mm(n + 1));
  [server, viewer] = await openBeating(folder, browser, radii, 1);
});

const frame = () => viewer.page.locator("[data-test=time-frame]").textContent();
const motionFinished = () => viewer.page.waitForSelector("[data-test=time][data-motion=finished]");
const drawn = (view: string) => viewer.pane(view).getAttribute("data-revisions");

/** Circles of the ball of the frame that is seen, in three views. */
async function drawBall(of: number, contours: number): Promise<void> {
  let count = contours;
  for (const view of ["axial", "sagittal", "coronal"]) {
    await viewer.page.keyboard.press("f");
    await viewer.drag(view, circle(await viewer.pixels(view, radius_mm(of)), 36));
    await viewer.waitForContours(++count);
  }
}

/** How far the 3D view and the outline of a slice reach, as the page has them. */
async function volume(): Promise<number> {
  await viewer.page.waitForFunction(() => document.querySelector(".figure strong"));
  return viewer.volume();
}

describe("a heart that beats", () => {
  test("what is drawn in a frame belongs to it, and is faint in others", async () => {
    const { page } = viewer;
    await drawBall(1, 0);
    await viewer.surfaceShown();
    assert.equal(await page.locator("[data-test=time]").getAttribute("data-motion"), "none");
    assert.equal(await page.locator(".time-mark").count(), 1);
    const isLine = (r: number, g: number, b: number) => r > 200 && g > 150 && b < 210 && r - b > 40;
    const strong = await viewer.countPixelsAtRest("axial", isLine);
    await page.locator("[data-test=time-slider]").focus();
    for (let n = 0; n < 4; ++n) await page.keyboard.press("ArrowRight");
    assert.equal(await frame(), "5 / 8");
    await viewer.slicesShown();
    await page.locator(".contour-row", { hasText: "frame 1" }).first().waitFor();
    assert.ok((await viewer.countPixelsAtRest("axial", isLine)) < 0.7 * strong, "the lines of frame 1 are faint");
  });

  test("in a second frame the surface of all frames follows, and the page asks whether it repeats", async () => {
    const { page } = viewer;
    await drawBall(5, 3);
    await page.waitForSelector("[data-test=cycle-question]");
    await page.click("[data-test=cycle-yes]");
    await page.waitForSelector("[data-test=cycle]");
    await motionFinished();
    assert.equal(await page.locator("[data-test=cycle]").textContent(), "Repeats after 8 frames");
    assert.equal(await page.locator("[data-test=cycle-question]").count(), 0);
    assert.equal(await page.locator(".time-mark").count(), 2);
    const ml = (mm: number) => (4 / 3e3) * Math.PI * mm ** 3;
    assert.ok(Math.abs((await volume()) / ml(radius_mm(5)) - 1) < 0.1, `${await volume()} ml in frame 5`);
    const told = (await page.locator("[data-test=ejection]").textContent())!;
    const fraction = Number(/([\d.]+) %/.exec(told)![1]);
    const [low, high] = /\(([\d.]+) to ([\d.]+)\)/.exec(told)!.slice(1).map(Number);
    assert.ok(low! < fraction && fraction < high!, told);
    assert.ok(((await page.locator(".curve-band").boundingBox())?.height ?? 0) > 5, "the interval is a band");
    assert.ok(Math.abs(fraction - 100 * (1 - (22 / 38) ** 3)) < 3, `ejection fraction ${fraction} %`);
    await page.click(".time-mark >> nth=0");
    assert.equal(await frame(), "1 / 8");
    await viewer.slicesShown();
    assert.ok(Math.abs((await volume()) / ml(radius_mm(1)) - 1) < 0.1, `${await volume()} ml in frame 1`);
  });

  test("a click on the curve goes to the frame, and outlines and surface are those of it", async () => {
    const { page } = viewer;
    const before = await drawn("axial");
    const curve = (await page.locator("[data-test=curve] svg").boundingBox())!;
    await page.mouse.click(curve.x + (curve.width * 2) / (FRAMES - 1), curve.y + curve.height / 2);
    assert.equal(await frame(), "3 / 8");
    await viewer.slicesShown();
    await page.waitForFunction((old) => document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["revisions"] !== old, before);
    const revision = (await drawn("axial"))!;
    await page.waitForFunction((shown) => document.querySelector<HTMLElement>("[data-view=surface]")!.dataset["revisions"] === shown, revision);
    const between = await volume();
    await page.click("[data-test=smallest]");
    assert.equal(await frame(), "5 / 8");
    await viewer.slicesShown();
    assert.ok((await volume()) < between);
  });

  test("it is played: image, outlines and surface move", async () => {
    const { page } = viewer;
    const seen = new Set<string>();
    const shown = new Set<string>();
    const began = Date.now();
    await page.keyboard.press("t");
    let steps = 0;
    for (let last = ""; Date.now() - began < 20_000 && (seen.size < FRAMES || shown.size < FRAMES);) {
      const now = (await frame())!;
      if (now !== last) ++steps;
      last = now;
      seen.add(now);
      shown.add((await viewer.pane("surface").getAttribute("data-revisions"))!);
    }
    assert.deepEqual([seen.size, shown.size], [FRAMES, FRAMES]);
    const slices = () => viewer.pane("axial").getAttribute("data-slices");
    const asked = await slices();
    const again = Date.now();
    let round = 0;
    for (let last = (await frame())!; round < 2 * FRAMES && Date.now() - again < 20_000;) {
      const now = (await frame())!;
      if (now !== last) ++round;
      last = now;
    }
    assert.equal(await slices(), asked, "frames that have been seen need no server");
    console.log(`played ${((1000 * steps) / (again - began)).toFixed(1)} frames a second, then ${((1000 * round) / (Date.now() - again)).toFixed(1)}`);
    await page.keyboard.press("t");
  });

  test("the outline is proposed in a frame where nothing is drawn; Enter takes it, undo takes it back", async () => {
    const { page } = viewer;
    await page.click(".time-mark >> nth=0");
    await page.keyboard.press(".");
    assert.equal(await frame(), "2 / 8");
    await viewer.slicesShown();
    await page.keyboard.press("v"); // Freehand would begin a line
    await page.mouse.move(...(await viewer.at("axial", 5, 5)));
    await page.mouse.down();
    await page.mouse.up();
    await page.click("[data-test=propose-here]");
    await page.locator(".hint", { hasText: "A proposal" }).waitFor();
    await page.keyboard.press("Enter");
    await viewer.waitForContours(7);
    await motionFinished();
    assert.equal(await page.locator(".time-mark").count(), 3);
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(6);
    await motionFinished();
    assert.equal(await page.locator(".time-mark").count(), 2);
  });

  test("a line is edited in its frame, and only there", async () => {
    const { page } = viewer;
    await page.click(".time-mark >> nth=1");
    assert.equal(await frame(), "5 / 8");
    await viewer.slicesShown();
    await page.keyboard.press("v");
    const right = await viewer.pixels("axial", radius_mm(5));
    await viewer.drag("axial", [
      [right, 0],
      [right + 6, 0],
      [right + 12, 0],
    ]);
    await viewer.waitForStep("undo", "Bend a contour");
    await motionFinished();
    await page.keyboard.press("Control+z");
    await motionFinished();
    await page.keyboard.press(",");
    await viewer.slicesShown();
    const other = await viewer.pixels("axial", radius_mm(1)); // where the line of frame 1 is, faintly
    await page.mouse.move(...(await viewer.at("axial", other, 0)));
    assert.equal(
      await page
        .locator("[data-view=axial] canvas")
        .last()
        .evaluate((canvas) => getComputedStyle(canvas).cursor === "pointer"),
      false,
    );
  });

  test("files of all frames, of this frame, and the curve are exported", async () => {
    const { page } = viewer;
    const masks = await viewer.export("masks.nii.gz");
    assert.equal(masks.name, "beating_Structure_1.nii.gz");
    assert.equal((await viewer.export("label_frames.nii.gz")).name, "beating_label_frames.nii.gz");
    const table = (await viewer.export("volumes.csv")).bytes.toString().trim().split("\n");
    assert.equal(table.length, FRAMES + 1);
    assert.equal(table[0], "frame,time_s,volume_ml,contours,phase,low_ml,high_ml");
    assert.ok(table.slice(1).every((row) => Number(row.split(",")[5]) < Number(row.split(",")[6])));
    const one = await viewer.export("mask.nii.gz");
    assert.equal(one.name, "beating_Structure_1_frame_4.nii.gz");
    const contours = JSON.parse((await viewer.export("contours.json")).bytes.toString()) as { cycle_frames: number };
    assert.equal(contours.cycle_frames, FRAMES);
    await page.keyboard.press("Escape");
    assert.deepEqual(viewer.complaints, []);
    if (process.env["KONTUR_PICTURES"]) await page.screenshot({ path: join(process.env["KONTUR_PICTURES"], "moving.png") });
  });

  test("G goes to the frame that is least sure, and offers its outline; once more: to another frame", async () => {
    const { page } = viewer;
    await page.keyboard.press("g");
    await page.locator(".hint", { hasText: "A proposal" }).waitFor();
    const first = (await frame())!;
    assert.ok(!["1 / 8", "5 / 8"].includes(first), `${first} is between what was drawn`);
    await page.keyboard.press("g");
    await page.waitForFunction((old) => document.querySelector("[data-test=time-frame]")!.textContent !== old, first);
    await page.keyboard.press("Escape");
    await page.click("[data-test=band]");
    await page.locator("[data-test=band-scale]", { hasText: "90 % band" }).waitFor();
    const between = await page.locator("[data-test=band-scale]").textContent();
    await page.click(".time-mark >> nth=0");
    await page.waitForFunction((old) => document.querySelector("[data-test=band-scale]")!.textContent !== old, between);
    await page.click("[data-test=scale-end]");
    await page.click(".time-mark >> nth=1");
    assert.equal(await frame(), "5 / 8");
  });
});
