// SPDX-License-Identifier: Apache-2.0
// Structures that follow others by rules: typed, seen before they are taken, followed, changed, frozen, undone.
import assert from "node:assert/strict";
import { join } from "node:path";
import { beforeEach, test } from "node:test";
import { circle, BALL_RADIUS_MM, BallVisits, voxels, type Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

const picture = async (name: string) => {
  const folder = process.env["KONTUR_PICTURES"];
  if (folder) await viewer.page.screenshot({ path: join(folder, `${name}.png`) });
};

const field = () => viewer.page.locator("[data-test=rule-field]");
const problem = () => viewer.page.locator("[data-test=rule-problem]");
const row = (name: string) => viewer.page.locator(".structure", { has: viewer.page.locator("button.name", { hasText: name }) });
const ml = async () => Number.parseFloat((await viewer.page.locator("[data-test=rule-volume]").textContent()) ?? "");
const ballMl = (radius: number) => ((4 / 3) * Math.PI * radius ** 3) / 1000;

/** Types a rule into the line, which is open or is opened. */
async function type(line: string): Promise<void> {
  if (!(await field().isVisible())) await viewer.page.click("[data-test=add-rule]");
  await viewer.type(field(), line);
}

async function take(line: string): Promise<void> {
  await type(line);
  await viewer.page.locator("[data-test=rule-take]:enabled").waitFor();
  await viewer.page.click("[data-test=rule-take]");
  await viewer.page.locator("[data-test=rule-line]").waitFor({ state: "hidden" });
}

beforeEach(async () => {
  viewer = await visits.nextDrawn(async (first) => {
    await first.rename(0, "CTV");
    await first.drawBall("axial", 1, BALL_RADIUS_MM / 2);
    await first.drawBall("coronal", 2, BALL_RADIUS_MM / 2);
    await first.surfaceShown();
  });
});

test("a rule is typed with its names completed, seen before it is taken, and follows what is drawn", async () => {
  const { page } = viewer;
  await type("PTV = ct");
  await page.locator("[data-test=rule-offer]", { hasText: "CTV" }).waitFor();
  await page.keyboard.press("Tab");
  assert.equal(await field().inputValue(), "PTV = CTV");
  await page.keyboard.type(" + 5");
  await problem().filter({ hasText: "a length has its unit behind it" }).waitFor();
  await picture("rule_problem");
  await page.keyboard.type(" mm");
  await problem().waitFor({ state: "detached" });
  await page.locator("[data-test=rule-volume]", { hasText: "ml" }).waitFor();
  const before = await ml();
  assert.ok(Math.abs(before / ballMl(BALL_RADIUS_MM / 2 + 5) - 1) < 0.1, `${before} ml`);
  await picture("rule_preview");
  await page.keyboard.press("Enter");
  await viewer.waitForStep("undo", "Add PTV");
  await viewer.surfaceShown();
  await viewer.saved();
  await picture("rule_taken");
  assert.equal(await row("PTV").locator("[data-test=is-rule]").count(), 1);
  assert.ok(Math.abs((await viewer.volume()) / before - 1) < 0.05, "what was told before");

  // The source is drawn on: its PTV moves while the hand does.
  await page.locator("button.name", { hasText: "CTV" }).click();
  await page.keyboard.press("v");
  const radius = await viewer.pixels("axial", BALL_RADIUS_MM / 2);
  const revision = () => page.evaluate(() => document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["revisions"]);
  const still = await revision();
  await page.mouse.move(...(await viewer.at("axial", radius, 0)));
  await page.mouse.down();
  for (let n = 1; n <= 12; ++n) await page.mouse.move(...(await viewer.at("axial", radius + 3 * n, 0)));
  const ptv = await row("PTV").getAttribute("data-structure");
  await page.waitForFunction(
    ([id, old]) => {
      const now = document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["revisions"] ?? "";
      const of = (text: string) => text.split(" ").find((one) => one.startsWith(`${id}:`));
      return of(now) !== undefined && of(now) !== of(old ?? "");
    },
    [ptv, still] as const,
  );
  await picture("rule_drag");
  await page.mouse.up();
  await viewer.saved();
  await viewer.surfaceShown();
  await page.locator("button.name", { hasText: "PTV" }).click();
  await viewer.surfaceShown();
  await picture("rule_followed");
  assert.ok((await viewer.volume()) > 1.03 * before, `${await viewer.volume()} ml`);
  await page.keyboard.press("Control+z");
  await viewer.waitForStep("undo", "Add PTV");
  await viewer.surfaceShown();
  assert.ok(Math.abs((await viewer.volume()) / before - 1) < 0.05);
  assert.deepEqual(viewer.complaints, []);
});

test("errors point at their place, circles name their members, and what is used stays", async () => {
  const { page } = viewer;
  await take("A = CTV + 2 mm");
  await take("B = A + 2 mm");
  await type("X = tumor + 2 mm");
  await problem().filter({ hasText: "There is no structure 'tumor'; there are" }).waitFor();
  assert.equal(await page.locator("[data-test=rule-place] mark").textContent(), "tumor");
  assert.ok(await page.locator("[data-test=rule-take]").isDisabled());
  await type("A = B - 1 mm");
  await problem().filter({ hasText: "A needs B needs A" }).waitFor();
  await picture("rule_circle");
  await page.keyboard.press("Escape");
  await page.locator("[data-test=rule-line]").waitFor({ state: "hidden" });

  await row("CTV").locator(".structure-row [data-part=remove]").click();
  await page.locator(".notice", { hasText: "CTV is used by the rule A = CTV + 2 mm; freeze or delete A first" }).waitFor();
  await page.locator("button.name", { hasText: "B" }).click();
  await page.keyboard.press("f");
  await viewer.drag("axial", circle(await viewer.pixels("axial", 10), 24));
  await page.locator(".notice", { hasText: "B is made by the rule B = A + 2 mm. Freeze it to draw in it" }).waitFor();
  assert.equal(await page.locator(".contour-row").count(), 2, "nothing was drawn");
});

test("menus write the line", async () => {
  const { page } = viewer;
  await page.click("[data-test=add-structure]");
  await page.locator("input.name:focus").waitFor();
  await page.keyboard.type("Cord");
  await page.keyboard.press("Enter");
  await viewer.drawBall("sagittal", 3, 10);
  await viewer.surfaceShown();
  await page.locator("button.name", { hasText: "CTV" }).click();
  await page.click("[data-test=add-rule]");
  await page.click("[data-test=rule-menu] summary");
  await page.locator("[data-test=rule-take]:enabled").waitFor();
  assert.equal(await field().inputValue(), "PTV = CTV + 5 mm");
  await viewer.type(page.locator("[data-test=menu-name]"), "PTV opt");
  await viewer.type(page.locator("[data-test=menu-margin]"), "7");
  await page.selectOption("[data-test=menu-crop]", "body()");
  await viewer.type(page.locator("[data-test=menu-cropGap]"), "3");
  await page.selectOption("[data-test=menu-spare]", "Cord");
  await viewer.type(page.locator("[data-test=menu-spareMargin]"), "2");
  assert.equal(await field().inputValue(), "'PTV opt' = crop(CTV + 7 mm, body(), 3 mm) - (Cord + 2 mm)");
  await page.locator("[data-test=rule-volume]", { hasText: "ml" }).waitFor();
  await picture("rule_menus");
  await page.click("[data-test=rule-take]");
  await viewer.waitForStep("undo", "Add PTV opt");
  assert.equal(await row("PTV opt").locator("[data-test=rule-text]").textContent(), "'PTV opt' = crop(CTV + 7 mm, body(), 3 mm) - (Cord + 2 mm)");
  assert.deepEqual(viewer.complaints, []);
});

test("it is changed by a click on it, renamed with its sources, frozen, and exported", async () => {
  const { page } = viewer;
  await take("PTV = CTV + 5 mm");
  await viewer.surfaceShown();
  await page.locator("[data-test=rule-text]").click();
  assert.equal(await field().inputValue(), "PTV = CTV + 5 mm");
  await take("PTV = CTV + 3 mm");
  await viewer.waitForStep("undo", "Change the rule of PTV");
  await viewer.rename(0, "GTV 1");
  await page.locator("[data-test=rule-text]", { hasText: "PTV = 'GTV 1' + 3 mm" }).waitFor();
  await page.locator(".structure-row button.name", { hasText: "PTV" }).click();
  await viewer.surfaceShown();
  const volume = await viewer.volume();
  const inside = (bytes: Buffer) => voxels(bytes).reduce((sum, value) => sum + Number(value > 0), 0);
  const made = voxels((await viewer.export("mask.nii.gz")).bytes);
  await page.click("[data-test=freeze]");
  await viewer.waitForStep("undo", "Freeze PTV");
  await row("PTV").locator("[data-test=is-mask]").waitFor();
  await viewer.surfaceShown();
  const frozen = (await viewer.export("mask.nii.gz")).bytes;
  assert.deepEqual(voxels(frozen), made, "the same voxels");
  assert.ok(inside(frozen) > 0);
  assert.ok(Math.abs((await viewer.volume()) / volume - 1) < 0.03);
  await picture("rule_frozen");
  await page.keyboard.press("Control+z");
  await row("PTV").locator("[data-test=is-rule]").waitFor();
  assert.deepEqual(viewer.complaints, []);
});
