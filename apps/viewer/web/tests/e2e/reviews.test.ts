// SPDX-License-Identifier: Apache-2.0
// Structures locked, approved and commented; two readers' structures side by side.
import assert from "node:assert/strict";
import { join } from "node:path";
import { beforeEach, test } from "node:test";
import { circle, BALL_RADIUS_MM, BallVisits, type Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

const picture = async (name: string) => {
  const folder = process.env["KONTUR_PICTURES"];
  if (folder) await viewer.page.screenshot({ path: join(folder, `${name}.png`) });
};

const row = (name: string) => viewer.page.locator(".structure", { has: viewer.page.locator("button.name", { hasText: name }) });
const notice = (text: string) => viewer.page.locator(".notice", { hasText: text }).first().waitFor();
const flag = (name: string, which: "locked" | "approved") => row(name).locator(`[data-test=is-${which}]`);

async function approve(name: string): Promise<void> {
  await viewer.page.click("[data-test=approve]");
  await viewer.type(viewer.page.locator("[data-test=reviewer]"), name);
  await viewer.page.keyboard.press("Enter");
}

beforeEach(async () => {
  viewer = await visits.nextDrawn(async (first) => {
    await first.rename(0, "Tumour");
    await first.drawBall("axial", 1, BALL_RADIUS_MM / 2);
    await first.drawBall("coronal", 2, BALL_RADIUS_MM / 2);
    await first.surfaceShown();
  });
});

test("nothing is drawn in a locked structure until it is unlocked", async () => {
  const { page } = viewer;
  await page.click("[data-test=lock]");
  await viewer.waitForStep("undo", "Lock Tumour");
  await flag("Tumour", "locked").waitFor();
  await page.keyboard.press("f");
  await viewer.drag("sagittal", circle(await viewer.pixels("sagittal", 15), 24));
  await notice("Tumour is locked. Unlock it in the list to change it");
  await picture("review_locked");
  await page.keyboard.press("v");
  const radius = await viewer.pixels("axial", BALL_RADIUS_MM / 2);
  await viewer.drag("axial", [
    [radius, 0],
    [radius + 20, 0],
  ]);
  await notice("Tumour is locked");
  await row("Tumour").locator(".structure-row [data-part=remove]").click();
  await notice("Tumour is locked, and stays as it is; unlock it in the list to change it");
  assert.equal(await viewer.contours(), 2);
  await viewer.waitForStep("undo", "Lock Tumour");
  await page.locator("[data-test=lock]", { hasText: "Unlock" }).focus();
  await page.keyboard.press("Enter");
  await viewer.waitForStep("undo", "Unlock Tumour");
  await page.keyboard.press("f");
  await viewer.drag("sagittal", circle(await viewer.pixels("sagittal", 15), 24));
  await viewer.waitForContours(3);
});

test("a change takes an approval back and says so, undo restores it, and it is there when the page is opened again", async () => {
  const { page } = viewer;
  await approve("Jane Doe");
  await viewer.waitForStep("undo", "Approve Tumour");
  await page.locator("[data-test=approval]", { hasText: "Approved by Jane Doe, 20" }).waitFor();
  await page.click("[data-test=comment]");
  await page.locator("[data-test=comment-field]").waitFor();
  await page.keyboard.type("Up to the rim,\nwithout the node");
  await picture("review_comment");
  await page.keyboard.press("Control+Enter");
  await page.locator("[data-test=comment-text]", { hasText: "without the node" }).waitFor();
  await picture("review_approved");
  await page.keyboard.press("f");
  await viewer.drag("sagittal", circle(await viewer.pixels("sagittal", 15), 24));
  await notice("Tumour has changed, so the approval by Jane Doe is taken back; undo restores both");
  await flag("Tumour", "approved").waitFor({ state: "detached" });
  await picture("review_taken_back");
  await viewer.saved();
  await page.keyboard.press("Control+z");
  await flag("Tumour", "approved").waitFor();
  assert.equal(await viewer.contours(), 2);
  await page.reload();
  await viewer.ready();
  assert.equal(await flag("Tumour", "approved").getAttribute("title"), (await page.locator("[data-test=approval]").textContent())!);
  await page.locator("[data-test=comment-text]").waitFor();
  await page.click("[data-test=approve]");
  await viewer.waitForStep("undo", "Take the approval of Tumour back");
  await page.click("[data-test=approve]");
  assert.equal(await page.locator("[data-test=reviewer]").inputValue(), "", "nobody has approved anything in this page");
});

test("all views go from one difference of two readers to the next, the largest first", async () => {
  const { page } = viewer;
  await page.click("[data-test=add-structure]");
  await page.locator("input.name:focus").waitFor();
  await page.keyboard.type("Reader 2");
  await page.keyboard.press("Enter");
  const radius = await viewer.pixels("axial", BALL_RADIUS_MM / 2);
  await page.keyboard.press("f");
  const far = await viewer.pixels("axial", 8);
  await viewer.drag(
    "axial",
    circle(radius, 36).map(([x, y]): [number, number] => [x + far, y]),
  );
  await viewer.waitForStep("undo", "Draw a contour");
  await viewer.drag(
    "coronal",
    circle(radius, 36).map(([x, y]): [number, number] => [x + far, y]),
  );
  await viewer.saved();
  await viewer.surfaceShown();
  const before = await viewer.slice("sagittal");
  await page.keyboard.press("j");
  const here = page.locator("[data-test=difference]", { hasText: / of / });
  await here.waitFor();
  await viewer.slicesShown();
  const first = (await here.textContent())!;
  assert.match(first, /^1 of \d+: \d+(\.\d)? mm, [\d.]+ ml in (Tumour|Reader 2) alone$/);
  assert.ok(Number.parseFloat(first.split(": ")[1]!) > 5, first);
  assert.match((await page.locator("[data-test=differences-figures]").textContent())!, /^Dice 0\.\d+, mean \d/);
  const there = await viewer.slice("sagittal");
  assert.ok(Math.abs(there - before) > 5, "the views have moved");
  await picture("review_difference");
  await page.click("[data-test=difference-next]");
  await page.locator("[data-test=difference]", { hasText: /^2 of / }).waitFor();
  await viewer.slicesShown();
  const second = (await here.textContent())!;
  assert.ok(Number.parseFloat(second.split(": ")[1]!) <= Number.parseFloat(first.split(": ")[1]!));
  await page.keyboard.press("Shift+j");
  await page.locator("[data-test=difference]", { hasText: first }).waitFor();
  await page.click("[data-test=differences-leave]");
  await page.locator("[data-test=differences]").waitFor({ state: "hidden" });
  assert.deepEqual(viewer.complaints, []);
});

test("the statistics lead to the differences of any two structures", async () => {
  const { page } = viewer;
  await page.click("[data-test=add-rule]");
  await viewer.type(page.locator("[data-test=rule-field]"), "PTV = Tumour + 5 mm");
  await page.locator("[data-test=rule-take]:enabled").click();
  await viewer.surfaceShown();
  await page.click("[data-test=statistics-open]");
  await page.locator("[data-test=compare-walk]").waitFor();
  await page.click("[data-test=compare-walk]");
  await page.locator("[data-test=difference]", { hasText: "in PTV alone" }).waitFor();
  await picture("review_ptv");
});
