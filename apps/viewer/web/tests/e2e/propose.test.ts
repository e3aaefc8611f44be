// SPDX-License-Identifier: Apache-2.0
// What is fitted is proposed on the next slice, and accepted or dropped by a key.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

const DRAWN_MM = 2; // where the axial contour lies: slices are 4 mm apart

/** The ball, drawn on the axial and the coronal slice through its middle, the axial contour selected in the list. */
beforeEach(async () => {
  viewer = await visits.next();
  await viewer.page.keyboard.press("f");
  for (const [i, view] of (["coronal", "axial"] as const).entries()) {
    await viewer.drag(view, circle(await viewer.pixels(view, BALL_RADIUS_MM), 36));
    await viewer.waitForContours(i + 1);
  }
  await viewer.page.keyboard.press("v");
  await viewer.show(1);
  await viewer.surfaceShown();
});

interface Drawing {
  planes: { contours: { points: [number, number, number][] }[] }[];
}

/** The distances from the ball's axis of the contour's points on the axial slice at this height. */
async function radiiAt(z_mm: number): Promise<number[]> {
  const { planes } = JSON.parse((await viewer.export("contours.json")).bytes.toString()) as Drawing;
  const all = planes.flatMap((plane) => plane.contours.map(({ points }) => points));
  const line = all.find((points) => points.every((p) => Math.abs(p[2] - z_mm) < 0.01)) ?? assert.fail(`no contour at ${z_mm} mm`);
  return line.map(([x, y]) => Math.hypot(x, y));
}

const proposed = () => viewer.page.locator(".hint", { hasText: "A proposal" });
const slice = () => viewer.slice("axial");

describe("the outline of the next slice", () => {
  test("is moved to where the image looks as it does beside the contour: from one contour of a ball that narrows", async () => {
    const { page } = viewer;
    for (const left of [1, 0]) {
      await page.keyboard.press("Control+z");
      await viewer.waitForContours(left);
    }
    await page.mouse.move(...(await viewer.at("axial", 0, 0)));
    const before = await slice();
    for (let i = 1; i <= 7; ++i) {
      await page.mouse.wheel(0, 100);
      await page.waitForSelector(`[data-view=axial][data-slice="${before + i}"]`);
    }
    await viewer.slicesShown();
    const z = DRAWN_MM - 28;
    await page.keyboard.press("f");
    await viewer.drag("axial", circle(await viewer.pixels("axial", Math.sqrt(BALL_RADIUS_MM ** 2 - z ** 2)), 36));
    await viewer.waitForContours(1);
    await viewer.surfaceShown();
    await page.keyboard.press("c");
    await proposed().waitFor();
    await page.keyboard.press("Enter");
    await viewer.waitForContours(2);
    await viewer.saved();
    const radii = await radiiAt(z - 4);
    const mean = radii.reduce((sum, r) => sum + r, 0) / radii.length;
    const expected = Math.sqrt(BALL_RADIUS_MM ** 2 - (z - 4) ** 2); // 4 mm less than on the slice before
    assert.ok(Math.abs(mean - expected) < 1, `${mean} mm on average, ${expected} expected`);
  });

  test("is proposed by C, is a contour by Enter, and one undo takes that back", async () => {
    const { page } = viewer;
    const before = await slice();
    for (let i = 1; i <= 3; ++i) {
      await page.keyboard.press("c");
      await proposed().waitFor();
      assert.equal(await slice(), before + i);
    }
    assert.equal(await viewer.contours(), 2, "nothing is accepted unasked");
    await page.keyboard.press("Enter");
    await viewer.waitForContours(3);
    await viewer.saved();
    await viewer.waitForStep("undo", "Accept the proposal");
    const z = DRAWN_MM - 12;
    const expected = Math.sqrt(BALL_RADIUS_MM ** 2 - z ** 2);
    const radii = await radiiAt(z);
    assert.ok(
      radii.length > 20 && radii.every((r) => Math.abs(r - expected) < 2.5),
      `${Math.min(...radii)} to ${Math.max(...radii)}, around ${expected} expected`,
    );
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(2);
    await viewer.waitForStep("redo", "Accept the proposal");
  });

  test("has another beside it, by W: the neighbour's contour as it is", async () => {
    const { page } = viewer;
    await page.keyboard.press("c");
    await proposed().waitFor();
    await page.keyboard.press("w");
    await page.keyboard.press("w");
    await page.click("[data-test=other-proposal]");
    await page.keyboard.press("Enter");
    await viewer.waitForContours(3);
    await viewer.saved();
    const copied = await radiiAt(DRAWN_MM - 4);
    assert.deepEqual(copied.map(Math.round), (await radiiAt(DRAWN_MM)).map(Math.round), "not the ball's, which narrows");
    await page.keyboard.press("w");
    await page.locator(".notice", { hasText: "Nothing is proposed" }).waitFor();
  });

  test("goes by Esc, and by scrolling on; Enter does nothing then", async () => {
    const { page } = viewer;
    await page.keyboard.press("Shift+C");
    await proposed().waitFor();
    await page.keyboard.press("Escape");
    await proposed().waitFor({ state: "detached" });
    await page.keyboard.press("c");
    await proposed().waitFor();
    await page.mouse.move(...(await viewer.at("axial", 0, 60)));
    await page.mouse.wheel(0, 100);
    await proposed().waitFor({ state: "detached" });
    await page.keyboard.press("Enter");
    await viewer.slicesShown();
    assert.equal(await viewer.contours(), 2);
  });

  test("is proposed by the button, too, and Enter with the keyboard on the button accepts; a drawn slice is only passed", async () => {
    const { page } = viewer;
    await page.click("[data-test=propose-next]");
    await proposed().waitFor();
    await page.keyboard.press("Enter");
    await viewer.waitForContours(3);
    await page.waitForSelector(".contour-row.selected");
    await page.click("[data-test=propose-previous]");
    await page.locator(".notice", { hasText: "has a contour of Structure 1 already" }).waitFor();
    assert.equal(await viewer.contours(), 3);
  });
});
