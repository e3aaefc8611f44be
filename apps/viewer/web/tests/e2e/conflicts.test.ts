// SPDX-License-Identifier: Apache-2.0
// Contours that contradict each other are named, and one of them is bent to the other by a click.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { drawCrossingCircles } from "./crossing_circles";
import { BallVisits, type Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

beforeEach(async () => {
  viewer = await visits.next();
  await drawCrossingCircles(viewer);
  await viewer.surfaceShown();
});

describe("a conflict", () => {
  test("names its contours; the one that is kept stays, the other is bent to it, and undo takes that back", async () => {
    const { page } = viewer;
    const rows = page.locator("[data-test=conflict]");
    await rows.nth(1).waitFor();
    const names = await page
      .locator(".contour-plane")
      .evaluateAll((planes) =>
        planes.map((plane) => [plane.querySelector(".contour-view")!.textContent, plane.querySelector(".contour-slice")!.textContent].join(" ")),
      );
    const text = (await rows.first().innerText()).replaceAll("\n", " ");
    for (const name of names) assert.ok(text.includes(name), `${name} is named in "${text}"`);
    assert.match(text, /[67]\.\d mm/);
    for (const left of [1, 0]) {
      await page
        .getByRole("button", { name: `Keep ${names.find((name) => name.startsWith("Axial"))}` })
        .first()
        .click();
      await viewer.waitForStep("undo", "Bend a contour");
      await viewer.surfaceShown();
      await page.waitForFunction((count) => document.querySelectorAll("[data-test=conflict]").length === count, left);
    }
    assert.equal(await viewer.contours(), 2);
    await page.keyboard.press("Control+z");
    await viewer.surfaceShown();
    await rows.first().waitFor();
  });
});
