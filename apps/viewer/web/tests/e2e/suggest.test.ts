// SPDX-License-Identifier: Apache-2.0
// Where to draw next, and how sure the surface is: by keys and by the pointer.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

/** The ball, drawn on the three slices through its middle. */
beforeEach(async () => {
  viewer = await visits.next();
  await viewer.page.keyboard.press("f");
  for (const [i, view] of (["axial", "coronal", "sagittal"] as const).entries()) {
    await viewer.drag(view, circle(await viewer.pixels(view, BALL_RADIUS_MM), 36));
    await viewer.waitForContours(i + 1);
  }
  await viewer.page.keyboard.press("v");
  await viewer.surfaceShown();
});

const proposed = () => viewer.page.locator(".hint", { hasText: "A proposal" });

/** What the views look at: the numbers of their slices. */
const slices = () => viewer.page.evaluate(() => [...document.querySelectorAll<HTMLElement>(".pane.slice")].map((pane) => pane.dataset["slice"]).join(" "));

/** The slices of the views, and whether they are turned. */
const looks = () =>
  viewer.page.evaluate(() =>
    [...document.querySelectorAll<HTMLElement>(".pane.slice")].map(({ dataset }) => `${dataset["slice"]}${dataset["turned"]}`).join(" "),
  );

async function looksOtherThan(before: string): Promise<string> {
  await viewer.page.waitForFunction(
    (known) => [...document.querySelectorAll<HTMLElement>(".pane.slice")].map(({ dataset }) => `${dataset["slice"]}${dataset["turned"]}`).join(" ") !== known,
    before,
  );
  return looks();
}

/** From a surface without empty planes to one without them again. */
async function emptyPlanesAreListed(): Promise<void> {
  const { page } = viewer;
  const rows = page.locator("[data-test=empty-plane]");
  assert.equal(await rows.count(), 0);
  await page.keyboard.press("g");
  await proposed().waitFor();
  await page.keyboard.press("e");
  await rows.waitFor();
  await viewer.surfaceShown();
  const there = await looks();
  await page.keyboard.press("Home");
  const home = await looksOtherThan(there);
  await rows.locator(".contour-plane").focus();
  await page.keyboard.press("Enter");
  await looksOtherThan(home);
  await rows.hover();
  await rows.locator("[data-part=forget-0]").click();
  await viewer.waitForStep("undo", "Forget empty planes of");
  await rows.waitFor({ state: "detached" });
  await viewer.surfaceShown();
  await page.keyboard.press("Control+z");
  await rows.waitFor();
  await page.keyboard.press("Control+z");
  await viewer.waitForStep("redo", "Nothing of");
  await rows.waitFor({ state: "detached" });
  await viewer.surfaceShown();
}

describe("where to draw next", () => {
  test("is gone to by G with a proposal; G again goes on, Esc drops it, Enter makes it a contour that helps", async () => {
    const { page } = viewer;
    const start = await slices();
    await page.keyboard.press("g");
    await proposed().waitFor();
    await viewer.slicesShown();
    const first = await slices();
    assert.notEqual(first, start, "the views go there");
    await page.keyboard.press("g");
    await page.waitForFunction(
      (before) => [...document.querySelectorAll<HTMLElement>(".pane.slice")].map((pane) => pane.dataset["slice"]).join(" ") !== before,
      first,
    );
    await proposed().waitFor();
    await page.keyboard.press("Escape");
    await proposed().waitFor({ state: "detached" });
    assert.equal(await viewer.contours(), 3);

    // What is said to be empty is a step of the history that undo takes back.
    await page.keyboard.press("g");
    await proposed().waitFor();
    await page.click("[data-test=nothing-here]");
    await viewer.waitForStep("undo", "Nothing of");
    await proposed().waitFor({ state: "detached" });
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("redo", "Nothing of");
    await viewer.surfaceShown();
    await emptyPlanesAreListed();

    await page.click(".quality >> text=Where to draw next");
    await proposed().waitFor();
    await page.keyboard.press("Enter");
    await viewer.waitForContours(4);
    await viewer.waitForStep("undo", "Accept the proposal");
    await viewer.saved();
    await viewer.surfaceShown();
    assert.match((await page.locator(".certainty").textContent())!, /Dice/);
    assert.deepEqual(viewer.complaints, []);
  });
});

describe("how sure the surface is", () => {
  test("is told, and coloured from dark near the lines to light where nothing was drawn, until one clicks again", async () => {
    const { page } = viewer;
    assert.match((await page.locator(".certainty").textContent())!, /expected Dice 0?\.\d+/);
    const band = page.locator("[data-test=band]");
    const scale = page.locator("[data-test=band-scale]");
    // The structure's own colour, and the dark end of the band's.
    const isAmber = (r: number, g: number, b: number) => r > 90 && r > 1.25 * g && g > 1.3 * b;
    const isBlue = (r: number, g: number, b: number) => b > 1.6 * r && b > 50 && g > r;
    const count = async () => ({ amber: await viewer.countPixels("surface", isAmber), blue: await viewer.countPixels("surface", isBlue) });
    const before = await count();
    assert.equal(await scale.isVisible(), false);
    await band.click();
    await page.waitForSelector("[data-test=band][aria-pressed=true]");
    await scale.waitFor();
    assert.match((await scale.textContent())!, /± (\d|0\.\d+)+ mm/);
    await viewer.surfaceShown();
    const during = await count();
    const counts = `${JSON.stringify(before)} before, ${JSON.stringify(during)} with the band`;
    assert.ok(before.amber > 2000 && during.amber < before.amber / 4 && during.blue > before.blue + 1000, counts);
    await band.focus();
    await page.keyboard.press("Enter");
    await page.waitForSelector("[data-test=band][aria-pressed=false]");
    assert.equal(await scale.isVisible(), false);
    assert.deepEqual(viewer.complaints, []);
  });
});
