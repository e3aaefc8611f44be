// SPDX-License-Identifier: Apache-2.0
// Contours that contradict each other are named, and one of them is bent to the other by a click.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

/** A large circle on the axial slice, a smaller one across: they contradict each other at two places. */
beforeEach(async () => {
  viewer = await visits.next();
  await viewer.page.keyboard.press("f");
  for (const [i, [view, mm]] of (
    [
      ["axial", BALL_RADIUS_MM],
      ["coronal", BALL_RADIUS_MM - 7],
    ] as const
  ).entries()) {
    await viewer.drag(view, circle(await viewer.pixels(view, mm), 48));
    await viewer.waitForContours(i + 1);
  }
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
