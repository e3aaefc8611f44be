// SPDX-License-Identifier: Apache-2.0
// Finding one's way among drawn slices, by ticks, keys and the list; and back to the bare image.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { BALL_RADIUS_MM, circle, Server, temporaryFolder, Viewer, writeBallImage } from "./support";

const folder = temporaryFolder();
const image = join(folder.path, "ball.nii");
let server: Server;
let browser: Browser;
let viewer: Viewer;

/** Slices from the first that is drawn, in the order of drawing. */
const DRAWN = [0, 3, 7];
let first = 0;

before(async () => {
  writeBallImage(image);
  browser = await launch();
  server = await Server.start(folder.path, image, "--project", join(folder.path, "ball.kontur"));
  viewer = await Viewer.open(browser, server.address);
  await viewer.closeHint();
  const { page } = viewer;
  first = await viewer.slice("axial");
  await page.keyboard.press("f");
  const radius = await viewer.pixels("axial", BALL_RADIUS_MM);
  for (const [i, slice] of DRAWN.entries()) {
    await page.mouse.move(...(await viewer.at("axial", 0, radius + 9)));
    for (let at = DRAWN[i - 1] ?? 0; at < slice; ++at) await page.mouse.wheel(0, 100);
    await viewer.slicesShown();
    await viewer.drag("axial", circle(radius * (1 - slice / 30), 36));
    await viewer.waitForContours(i + 1);
  }
  await viewer.saved();
  await viewer.surfaceShown();
  await page.keyboard.press("v");
});

after(async () => {
  await browser.close();
  await server.end();
  folder.remove();
});

const waitForSlice = (view: string, slice: number) =>
  viewer.page.waitForFunction(
    ([name, wanted]) => document.querySelector<HTMLElement>(`[data-view=${name}]`)!.dataset["slice"] === wanted,
    [view, String(slice)],
  );
const ticks = (view: string) => viewer.page.locator(`[data-view=${view}] .slice-ticks span`);
const notice = (words: string) => viewer.page.locator(".notice", { hasText: words });

describe("drawn slices", () => {
  test("have ticks beside the slider, where its thumb stands when they are shown", async () => {
    const { page } = viewer;
    assert.equal(await ticks("axial").count(), DRAWN.length);
    assert.equal(await ticks("coronal").count(), 0);
    const places = await Promise.all(DRAWN.map(async (_, i) => (await ticks("axial").nth(i).boundingBox())!));
    const slider = (await page.locator("[data-view=axial] .slice-slider").boundingBox())!;
    const count = Number((await page.locator("[data-view=axial] .slice-number").textContent())!.split(" / ")[1]);
    const travel = slider.height - 13; // of the thumb's middle
    DRAWN.forEach((slice, i) => {
      const expected = slider.y + 6.5 + (travel * (first + slice - 1)) / (count - 1);
      const actual = places[i]!.y + places[i]!.height / 2;
      assert.ok(Math.abs(actual - expected) < 1, `slice ${slice}: ${actual}, ${expected} expected`);
    });
    // A click on a tick's place takes the thumb there: both count alike.
    await page.mouse.click(slider.x + slider.width / 2, places[1]!.y + 1);
    await waitForSlice("axial", first + DRAWN[1]!);
  });

  test("are gone through by N and Shift + N in the view that the keyboard is in, and beyond the last it is said", async () => {
    const { page } = viewer;
    await page.locator("[data-view=axial] .overlay").focus();
    await page.keyboard.press("Shift+N");
    await waitForSlice("axial", first);
    await page.keyboard.press("n");
    await waitForSlice("axial", first + DRAWN[1]!);
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("n");
    await waitForSlice("axial", first + DRAWN[2]!);
    assert.equal(await notice("No slice with a contour").count(), 0);
    await page.keyboard.press("n");
    await notice("No slice with a contour lies beyond this one in the axial view").waitFor();
    await page.keyboard.press("Shift+N");
    await waitForSlice("axial", first + DRAWN[1]!);
    const coronal = await viewer.slice("coronal");
    await page.locator("[data-view=coronal] .overlay").focus();
    await page.keyboard.press("n");
    await notice("in the coronal view").waitFor();
    assert.equal(await viewer.slice("coronal"), coronal);
  });

  test("are numbered in the list as in the view", async () => {
    for (const [i, slice] of DRAWN.entries()) {
      const row = viewer.page.locator(".contour-row").nth(i);
      assert.equal(await row.locator(".contour-slice").textContent(), String(first + slice));
      await row.click();
      await waitForSlice("axial", first + slice);
      assert.match((await row.locator(".contour-plane").textContent())!, new RegExp(`^Axial ${first + slice} [IS] [0-9.]+$`));
    }
  });

  test("have no tick while they are hidden", async () => {
    const { page } = viewer;
    await page.locator(".contour-row").nth(1).hover();
    await page.locator(".contour-row").nth(1).locator("[data-part=eye]").click();
    await page.waitForFunction(() => document.querySelectorAll("[data-view=axial] .slice-ticks span").length === 2);
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => document.querySelectorAll("[data-view=axial] .slice-ticks span").length === 3);
  });
});

describe("the bare image", () => {
  /** Anything coloured: lines, outlines, marks. The image is grey; the header and the slider are not looked at. */
  async function colored(): Promise<number> {
    await viewer.page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
    return viewer.page.locator("[data-view=axial] .overlay").evaluate((canvas: HTMLCanvasElement) => {
      const { data } = canvas.getContext("2d")!.getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4)
        if (data[i + 3]! > 20 && Math.max(data[i]!, data[i + 1]!, data[i + 2]!) - Math.min(data[i]!, data[i + 1]!, data[i + 2]!) > 40) ++count;
      return count;
    });
  }

  test("is seen while B is held; letters stay, and the pointer changes nothing that is not seen", async () => {
    const { page } = viewer;
    await viewer.show(0);
    await viewer.surfaceShown();
    assert.ok((await colored()) > 300);
    await page.keyboard.down("b");
    assert.equal(await colored(), 0);
    await page.keyboard.down("b"); // as a key that is held repeats
    assert.equal(await colored(), 0);
    const slice = await viewer.slice("axial");
    const radius = await viewer.pixels("axial", BALL_RADIUS_MM);
    await viewer.drag("axial", [
      [0, radius],
      [0, radius + 8],
      [0, radius + 20],
    ]);
    await page.mouse.wheel(0, 100);
    await waitForSlice("axial", slice + 1);
    await page.mouse.wheel(0, -100);
    await waitForSlice("axial", slice);
    await page.keyboard.up("b");
    assert.ok((await colored()) > 300);
    assert.match((await page.locator("[data-test=undo]").getAttribute("title"))!, /^Undo: Draw a contour/);
  });

  test("is left when the window loses the keyboard, and no keyup comes", async () => {
    const { page } = viewer;
    await page.evaluate(() => {
      const elsewhere = document.createElement("iframe");
      Object.assign(elsewhere.style, { position: "fixed", left: "0", bottom: "0", width: "60px", height: "20px", zIndex: "9" });
      document.body.append(elsewhere);
    });
    await page.keyboard.down("b");
    assert.equal(await colored(), 0);
    await page.locator("iframe").click(); // as a click into another window: keys go there now
    await page.keyboard.up("b");
    assert.ok((await colored()) > 300);
    await page.locator("iframe").evaluate((elsewhere) => elsewhere.remove());
  });
});
