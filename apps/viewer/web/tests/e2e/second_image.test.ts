// SPDX-License-Identifier: Apache-2.0
// A second image over the first: chosen in the page, seen in colours, drawn on, kept with the project.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch, onlyChromium } from "./browsers";
import { circle, cleanUp, Server, SHEARED, temporaryFolder, Viewer, writeBallImage } from "./support";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const folder = temporaryFolder();
const home = join(folder.path, "home");
const project = join(folder.path, "work.kontur");
/** Of the ball in the second image, whose grid is sheared and oblique; in the first one there is nothing at this distance. */
const SMALL_RADIUS_MM = 25;
let server: Server;
let browser: Browser;
let viewer: Viewer;

before(async () => {
  mkdirSync(home);
  writeBallImage(join(home, "first.nii"));
  writeBallImage(join(home, "small.nii"), SHEARED, SMALL_RADIUS_MM);
  writeFrames(join(home, "beating.nii"), join(home, "small.nii"), 2);
  writeElsewhere(join(home, "far.nii"), join(home, "small.nii"));
  writeFileSync(join(home, "broken.nii"), "this is no image");
  browser = await launch();
});

cleanUp(folder, () => [browser, server]);

/** The same voxels several times. */
function writeFrames(path: string, of: string, count: number): void {
  const file = readFileSync(of);
  const voxels = file.subarray(352);
  file.writeInt16LE(4, 40);
  file.writeInt16LE(count, 48);
  writeFileSync(path, Buffer.concat([file.subarray(0, 352), ...Array.from({ length: count }, () => voxels)]));
}

/** A metre to the side. */
function writeElsewhere(path: string, of: string): void {
  const file = readFileSync(of);
  file.writeFloatLE(file.readFloatLE(292) + 1000, 292);
  writeFileSync(path, file);
}

async function visit(...words: string[]): Promise<void> {
  await (viewer as Viewer | undefined)?.page.close();
  await (server as Server | undefined)?.end();
  server = await Server.startAt({ HOME: home }, folder.path, ...words);
  viewer = await Viewer.open(browser, server.address);
}

const card = () => viewer.page.locator("[data-test=second-image]");
const entry = (name: string) => viewer.page.locator(`.add-image [data-test=entries] button[title$="/${name}"]`);
const problem = (text: string) => viewer.page.locator("[data-test=add-image-problem]", { hasText: text });
const field = (name: string) => viewer.page.locator(`[data-test=second-${name}]`);

/** Pixels of the axial view that are as yellow as the hot colours are where there is much, and grey ones that are bright. */
const yellows = () => viewer.countPixels("axial", (r, g, b) => r - b > 60 && g - b > 50);
const greys = () => viewer.countPixels("axial", (r, g, b) => r > 90 && Math.max(r, g, b) - Math.min(r, g, b) < 4);

/** Lines that the pointer lights up cover some. */
const isNear = (count: number, other: number) => Math.abs(count - other) < 0.05 * other;

async function press(key: string): Promise<void> {
  await viewer.page.keyboard.press(key);
  await viewer.page.waitForTimeout(100); // a frame, in which it is painted
  await viewer.slicesShown();
  await viewer.page.waitForTimeout(100);
}

async function axeFindings(): Promise<string[]> {
  await viewer.page.evaluate(AXE);
  return viewer.page.evaluate(async () => {
    const { axe } = window as unknown as { axe: { run: (options: object) => Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> } };
    const { violations } = await axe.run({ runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] });
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" ")}`);
  });
}

describe("a second image", () => {
  test("is chosen in the page, and what does not fit is said in one sentence", async () => {
    await visit(join(home, "first.nii"), "--project", project);
    await viewer.closeHint();
    const { page } = viewer;
    assert.equal(await card().isVisible(), false);
    await page.click("[data-test=add-image]");
    await page.waitForSelector(`.add-image [data-test=entries][data-folder="${home}"]`); // where the image is
    await entry("far.nii").click();
    await problem("far.nii and first.nii do not meet: they lie").waitFor();
    await entry("broken.nii").click();
    await problem("broken.nii").waitFor();
    await entry("beating.nii").click();
    await problem("has 2 frames. Which one is to be shown").waitFor();
    await viewer.type(page.locator(".add-image [data-test=frame]"), "1");
    assert.deepEqual(await axeFindings(), []);
    await page.keyboard.press("Enter");
    await page.waitForSelector(".add-image", { state: "detached" });
    await page.locator(".notice.warning", { hasText: "Neither first.nii nor beating.nii names a frame of reference" }).waitFor();
    assert.match((await card().textContent())!, /beating\.nii.*96 × 80 × 40.*Neither first\.nii/);
    await page.click("[data-test=add-image]");
    await page.locator(".add-image", { hasText: "It takes the place of beating.nii." }).waitFor();
    await entry("small.nii").click();
    await page.waitForSelector(".add-image", { state: "detached" });
    await page.locator("[data-test=second-image] strong", { hasText: "small.nii" }).waitFor();
    await page.evaluate(() => document.querySelectorAll<HTMLElement>(".notice").forEach((notice) => notice.click())); // they lie over the slices
    viewer.complaints.splice(0); // Chromium tells of each refusal
  });

  test("is seen over the first one in its colours, alone, or not at all, by keys and by buttons", async () => {
    await viewer.page.selectOption("[data-test=second-colors]", "hot");
    await viewer.type(field("low"), "30");
    await viewer.type(field("high"), "120");
    await press("Enter");
    const both = { yellow: await yellows(), grey: await greys() };
    assert.ok(both.grey > 3000, `the large ball is seen around the small one: ${both.grey}`);
    await press("o");
    const first = { yellow: await yellows(), grey: await greys() };
    assert.ok(first.yellow < 20 && both.yellow > 1000 && first.grey > both.grey + 3000, JSON.stringify({ both, first }));
    await press("i");
    assert.ok((await greys()) < 1500, `the first image is out of sight: ${await greys()}`);
    assert.equal(await viewer.page.locator("[data-test=show-second]").getAttribute("aria-pressed"), "true");
    await press("i");
    assert.ok(isNear(await greys(), first.grey), "back to what was seen before");
    await viewer.page.click("[data-test=show-both]");
    await press("Escape");
    const again = { yellow: await yellows(), grey: await greys() };
    assert.ok(isNear(again.yellow, both.yellow) && isNear(again.grey, both.grey), JSON.stringify({ both, again }));
  });

  test("scrolls with the first one, on turned planes, too", async () => {
    await viewer.page.mouse.move(...(await viewer.at("oblique", 0, 0)));
    await viewer.page.mouse.wheel(0, 100);
    await viewer.slicesShown();
    await viewer.page.mouse.move(...(await viewer.at("axial", 0, 0)));
    for (let n = 0; n < 8; ++n) await viewer.page.mouse.wheel(0, 100); // 32 mm: beyond the small ball
    await press("Escape");
    const beyond = await greys();
    await press("o");
    assert.ok(beyond > 0.8 * (await greys()), "nothing of the second image lies over the large ball there");
    await press("o");
    await press("Home");
  });

  test("is told under the pointer beside the first one", async () => {
    const cursor = () => viewer.page.locator("[data-test=cursor]").textContent();
    await viewer.page.mouse.move(...(await viewer.at("axial", await viewer.pixels("axial", 33), 2)));
    await viewer.page.waitForFunction(() => /first [\d.]+ {2}· {2}second [12]?\d(\.|$)/.test(document.querySelector("[data-test=cursor]")!.textContent ?? ""));
    const [, first, second] = /first ([\d.]+).*second ([\d.]+)/.exec((await cursor())!)!;
    assert.ok(Number(first) >= 100 && Number(second) <= 30, `only in the large ball: ${await cursor()}`);
  });

  test("has a window of its own: right drag where it is alone, with Shift where both are seen", async () => {
    const windows = async () => Promise.all([viewer.page.locator(".toolbar .number").first().inputValue(), field("low").inputValue()]);
    const before = await windows();
    await viewer.drag(
      "axial",
      [
        [0, 0],
        [10, 20],
      ],
      "right",
    );
    const afterFirst = await windows();
    assert.ok(afterFirst[0] !== before[0] && afterFirst[1] === before[1], JSON.stringify([before, afterFirst]));
    await viewer.page.keyboard.down("Shift");
    await viewer.drag(
      "axial",
      [
        [0, 0],
        [10, 20],
      ],
      "right",
    );
    await viewer.page.keyboard.up("Shift");
    const afterSecond = await windows();
    assert.ok(afterSecond[0] === afterFirst[0] && afterSecond[1] !== afterFirst[1], JSON.stringify([afterFirst, afterSecond]));
    await press("i");
    await viewer.drag(
      "axial",
      [
        [0, 0],
        [-10, 20],
      ],
      "right",
    );
    const alone = await windows();
    assert.ok(alone[0] === afterSecond[0] && alone[1] !== afterSecond[1], JSON.stringify([afterSecond, alone]));
    await viewer.page.selectOption("[data-test=second-presets]", { label: "Full range" });
    assert.equal(await field("high").inputValue(), "120");
    await press("i");
  });

  test("is drawn on where it is seen alone: live-wire follows its edges", async () => {
    await press("i");
    await viewer.page.keyboard.press("l");
    const beside = (await viewer.pixels("axial", SMALL_RADIUS_MM)) + 2;
    for (const place of circle(beside, 6).slice(0, 6)) await viewer.click("axial", ...place);
    await viewer.page.keyboard.press("Enter");
    await viewer.waitForContours(1);
    const { planes } = JSON.parse((await viewer.export("contours.json")).bytes.toString()) as {
      planes: { contours: { points: [number, number, number][] }[] }[];
    };
    const radii = planes[0]!.contours[0]!.points.map((p) => Math.hypot(...p));
    assert.ok(
      radii.every((radius) => Math.abs(radius - SMALL_RADIUS_MM) < 2),
      `from ${Math.min(...radii)} to ${Math.max(...radii)} mm`,
    );
    await viewer.saved();
    assert.deepEqual(viewer.complaints, []);
  });

  test("leaves the list its rows in a low window, all of the panel in reach, and has a card that folds", async () => {
    const { page } = viewer;
    const box = async (part: string) => (await page.locator(part).boundingBox())!;
    for (const [width, height] of [
      [1280, 720],
      [820, 620],
    ] as const) {
      await page.setViewportSize({ width, height });
      const panel = await box(".panel");
      const list = await box(".structures");
      assert.ok(
        list.height > 140 && list.y + list.height <= panel.y + panel.height,
        `${width} x ${height}: the list from ${list.y} to ${list.y + list.height}`,
      );
      await page.mouse.move(panel.x + panel.width / 2, panel.y + 20);
      for (let n = 0; n < 12; ++n) await page.mouse.wheel(0, 100);
      await page.waitForFunction(
        () => document.querySelector(".quality")!.getBoundingClientRect().bottom <= document.querySelector(".panel")!.getBoundingClientRect().bottom + 1,
      ); // its end is in reach
    }
    await page.setViewportSize({ width: 1280, height: 720 });
    assert.ok(await field("opacity").isVisible());
    const open = (await card().boundingBox())!.height;
    await page.click("[data-test=fold-second]");
    assert.equal(await field("opacity").isVisible(), false);
    assert.ok((await card().boundingBox())!.height < open / 2);
    await page.waitForTimeout(600); // saved a moment later
    await viewer.saved();
    await visit(project);
    assert.equal(await field("opacity").isVisible(), false, "it stays folded with the project");
    await viewer.page.click("[data-test=show-first]"); // still there
    await viewer.page.click("[data-test=fold-second]");
    assert.ok(await field("opacity").isVisible());
  });

  test("is there again with the project, as it was looked at, until it is removed", async () => {
    await viewer.page.click("[data-test=show-both]");
    await field("opacity").focus();
    for (let n = 0; n < 10; ++n) await viewer.page.keyboard.press("ArrowRight");
    const opacity = await field("opacity").inputValue();
    assert.equal(opacity, "0.6");
    await viewer.page.waitForTimeout(600); // saved a moment later
    await viewer.saved();
    await visit(project);
    assert.match((await card().textContent())!, /small\.nii/);
    assert.deepEqual([await field("opacity").inputValue(), await field("colors").inputValue(), await field("high").inputValue()], [opacity, "hot", "120"]);
    assert.equal(await viewer.page.locator(".notice").count(), 0, "what its card says is not said again");
    assert.deepEqual(await axeFindings(), []);
    await viewer.page.click("[data-test=remove-image]");
    await card().waitFor({ state: "hidden" });
    await press("i");
    await viewer.page.locator(".notice", { hasText: "There is no second image; the toolbar adds one." }).waitFor();
    await visit(project);
    assert.equal(await card().isVisible(), false);
    assert.deepEqual(viewer.complaints, []);
  });

  test("comes from the command line, too", async () => {
    await visit(join(home, "first.nii"), "--second-image", join(home, "small.nii"), "--project", join(folder.path, "other.kontur"));
    assert.match((await card().textContent())!, /small\.nii/);
    assert.deepEqual(viewer.complaints, []);
  });

  test(
    "may be removed by another window while this one asks for a slice of it",
    onlyChromium("Playwright is not told what Firefox's requests hold"),
    async () => {
      const { page } = viewer;
      const other = await Viewer.open(browser, server.address);
      const [asked, answered] = [gate(), gate()];
      await page.route("**/api/slice", async (route) => {
        if ((route.request().postDataJSON() as { image?: number }).image !== 1) return route.continue();
        asked.open();
        await answered.opened;
        await route.continue().catch(() => undefined); // the page has given it up
      });
      await page.mouse.move(...(await viewer.at("axial", 5, 5)));
      await page.mouse.wheel(0, 120);
      await asked.opened;
      await other.page.click("[data-test=remove-image]");
      await card().waitFor({ state: "hidden" });
      answered.open();
      await viewer.slicesShown();
      assert.equal(await page.locator(".notice.error").count(), 0);
      assert.deepEqual([...viewer.complaints, ...other.complaints], []);
      await other.page.close();
      await page.unroute("**/api/slice");
    },
  );
});

function gate(): { opened: Promise<void>; open: () => void } {
  let open = () => {};
  const opened = new Promise<void>((resolve) => (open = resolve));
  return { opened, open };
}
