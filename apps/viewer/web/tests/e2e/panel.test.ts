// SPDX-License-Identifier: Apache-2.0
// What a hand has just now in the panel stays in it, whatever changes meanwhile: another window of the project changes something, and
// the hand goes on.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { NO_WEBGL } from "./browsers";
import { BallVisits, Viewer } from "./support";

const visits = new BallVisits(NO_WEBGL);
let viewer: Viewer;

beforeEach(async () => {
  viewer = await visits.next();
  await viewer.drawBall("axial");
});

/** In another window of the same project. */
async function meanwhile(act: (other: Viewer) => Promise<void>): Promise<void> {
  const other = await Viewer.open(visits.browser, visits.server.address);
  await act(other);
  await other.saved();
  await other.page.close();
}

const addStructure = () => meanwhile((other) => other.addStructure());
const row = (structure: number) => viewer.page.locator(".structure").nth(structure);

test("a name half typed stays, and so does the place in it, while the rest of its row follows", async () => {
  const { page } = viewer;
  await viewer.doubleClick(row(0).locator("button.name"));
  await page.keyboard.type("Kiy");
  await page.keyboard.press("ArrowLeft");
  await meanwhile((other) => other.page.locator(".structure-row [data-part=eye]").click());
  await row(0).locator(".structure-row [data-part=eye][title=Show]").waitFor();
  await page.keyboard.type("dne");
  await page.keyboard.press("Enter");
  await viewer.waitForStep("undo", "Rename");
  assert.equal(await row(0).locator("button.name").textContent(), "Kidney");
});

test("a button that is held down acts when it is let go", async () => {
  const { page } = viewer;
  await page.locator(".contour-row").hover();
  const box = (await page.locator(".contour-row [data-part=eye]").boundingBox())!;
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await addStructure();
  await row(1).waitFor();
  await page.mouse.up();
  await page.waitForSelector(".contour-row.off");
});

test("the keyboard stays in a choice that was made by it, also when the choice grows", async () => {
  const { page } = viewer;
  await addStructure();
  await row(1).waitFor();
  await page.locator(".contour-row").click();
  const owner = page.locator("[data-test=owner]");
  await owner.focus();
  await owner.press("ArrowDown");
  await row(1).locator(".contour-row").waitFor();
  await addStructure();
  await row(2).waitFor();
  await page.keyboard.press("ArrowDown");
  await row(2).locator(".contour-row").waitFor();
  assert.equal(await owner.evaluate((select) => select === document.activeElement), true);
});

test("a contour is told to be the structure's end, and to count less; undo takes each back, a hole is no end", async () => {
  const { page } = viewer;
  await page.locator(".contour-row").first().click();
  const [end, weight] = [page.locator("[data-test=end]"), page.locator("[data-test=weight]")];
  await end.selectOption({ label: "Flat end" });
  await viewer.waitForStep("undo", "End at a contour");
  await weight.selectOption({ label: "Counts 0.1 ×" });
  await viewer.waitForStep("undo", "Weight of a contour");
  await viewer.saved();
  assert.deepEqual([await end.inputValue(), await weight.inputValue()], ["flat", "0.1"]);
  await page.click("[data-test=undo]");
  await page.waitForFunction(() => document.querySelector<HTMLSelectElement>("[data-test=weight]")!.value === "1");
  await page.click("[data-test=undo]");
  await page.waitForFunction(() => document.querySelector<HTMLSelectElement>("[data-test=end]")!.value === "automatic");
  await page.click(".contour-actions input[type=checkbox]");
  await end.waitFor({ state: "detached" });
});
