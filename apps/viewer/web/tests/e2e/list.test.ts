// SPDX-License-Identifier: Apache-2.0
// The list with more than a hundred contours of thirty structures.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { describe, test } from "node:test";
import { NO_WEBGL } from "./browsers";
import { BallVisits, Viewer, writeBallImage } from "./support";

const STRUCTURES = 30;
/** Thirty surfaces drawn without a graphics processor would keep the page busy for minutes. */
const visits = new BallVisits(NO_WEBGL);
let viewer: Viewer;

/** Thirty balls in the grid of the ball's image, each a label, or one of them alone. */
function writeLabels(path: string, only?: number): void {
  const source = join(visits.folder.path, "grid.nii");
  writeBallImage(source);
  const file = readFileSync(source);
  for (let k = 0; k < 40; ++k)
    for (let j = 0; j < 80; ++j)
      for (let i = 0; i < 96; ++i) {
        const [column, row] = [Math.floor(i / 16), Math.floor(j / 16)];
        const mm = Math.hypot((i % 16) - 7.5, (j % 16) - 7.5, k - 20) * 2;
        const label = 1 + column + 6 * row;
        file.writeInt16LE(mm < 13 && (only ?? label) === label ? label : 0, 352 + 2 * (i + 96 * (j + 80 * k)));
      }
  writeFileSync(path, file);
}

async function importMask(how: string, only?: number): Promise<void> {
  const path = join(visits.folder.path, "labels.nii");
  writeLabels(path, only);
  const { address, token } = visits.server;
  const origin = new URL(address).origin;
  const reply = await fetch(`${origin}/api/import/mask?name=labels.nii&${how}`, {
    method: "POST",
    body: readFileSync(path),
    headers: { Authorization: `Bearer ${token}`, Origin: origin },
  });
  assert.equal(reply.status, 200, await reply.text());
}

/** The page with thirty imported structures. */
async function prepare(): Promise<void> {
  viewer = await visits.next();
  await importMask("planes=2&axes=axial,coronal");
  await importMask("planes=5&axes=axial,coronal,sagittal", 8);
  await viewer.page.waitForFunction((count) => document.querySelectorAll(".structure").length === count + 1, STRUCTURES);
}

let opened: Promise<void> | null = null;
const open = () => (opened ??= prepare());

const counts = () => viewer.page.locator(".structure-row .count").allTextContents();
const listed = () => viewer.page.locator(".contour-row").count();
const nameOf = (name: string) => viewer.page.locator(".structure-row button.name", { hasText: new RegExp(`^${name}$`) });

describe("a list of thirty structures", () => {
  test("lists the contours of the active one, under headings, in the order of slices", async () => {
    await open();
    assert.ok((await counts()).reduce((sum, text) => sum + Number(text), 0) > 100);
    await nameOf("labels").click();
    await viewer.page.waitForSelector(".structure-row.active button.name[aria-label='labels']");
    const own = Number(await viewer.page.locator(".structure-row.active .count").textContent());
    await viewer.waitForContours(own);
    const groups = await viewer.page.locator(".contour-group").allTextContents();
    assert.deepEqual(
      groups.map((text) => text.replace(/\d+$/, "")),
      ["Axial", "Sagittal", "Coronal"],
    );
    const slices = (await viewer.page.locator(".contour-row:has-text('Coronal') .contour-slice").allTextContents()).map(Number);
    assert.deepEqual(
      slices,
      [...slices].sort((a, b) => a - b),
    );
    assert.ok(slices.length >= 3);
    await viewer.page.click(".group-title >> text=Axial");
    await viewer.page.waitForFunction((before) => document.querySelectorAll(".contour-row").length < before, own);
    await viewer.page.click(".group-title >> text=Axial");
    await viewer.waitForContours(own);
  });

  test("is filtered by what one types", async () => {
    const filter = viewer.page.locator("[data-test=list-filter]");
    await viewer.type(filter, "label 29");
    await viewer.page.waitForFunction(() => document.querySelectorAll(".structure").length === 1);
    await viewer.type(filter, "coronal");
    await viewer.page.waitForFunction(() => [...document.querySelectorAll(".contour-row .contour-view")].every((view) => view.textContent === "Coronal"));
    assert.ok((await listed()) > STRUCTURES);
    await viewer.type(filter, "no such thing");
    await viewer.page.waitForFunction(() => document.querySelectorAll(".structure").length === 0);
    await filter.press("Control+a");
    await filter.press("Delete");
    await viewer.page.waitForFunction((count) => document.querySelectorAll(".structure").length > count, STRUCTURES);
  });

  test("marks several contours by the pointer, which are deleted and come back as one step", async () => {
    const rows = viewer.page.locator(".contour-row");
    const before = await listed();
    await rows.nth(1).click();
    await rows.nth(4).click({ modifiers: ["Shift"] });
    await viewer.page.waitForSelector("[data-test=marked]:has-text('4 contours')");
    await rows.nth(2).click({ modifiers: ["Control"] });
    await viewer.page.waitForSelector("[data-test=marked]:has-text('3 contours')");
    assert.equal(await viewer.page.locator(".contour-row.selected").count(), 3);
    await viewer.page.keyboard.press("Delete");
    await viewer.waitForContours(before - 3);
    await viewer.waitForStep("undo", "Delete 3 contours");
    await viewer.page.keyboard.press("Control+z");
    await viewer.waitForContours(before);
  });

  test("stays where it was scrolled to, away from the selected contour", async () => {
    const { page } = viewer;
    await page.locator(".contour-row").first().click();
    await page.waitForSelector(".contour-row.selected");
    const list = page.locator(".structures");
    const far = page.locator(".structure-row").first();
    const scrolled = () => list.evaluate((element) => element.scrollTop);
    assert.ok((await scrolled()) > 0, "the selected one lies far down");
    await list.evaluate((element) => (element.scrollTop = 0));
    for (const title of ["Show", "Hide"]) {
      await far.locator("[data-part=eye]").click();
      await far.locator(`[data-part=eye][title=${title}]`).waitFor();
      assert.equal(await scrolled(), 0);
    }
  });

  test("marks by the keyboard, and moves what is marked to another structure", async () => {
    const rows = viewer.page.locator(".contour-row");
    const before = await listed();
    await rows.first().locator("[data-part=show]").focus();
    await viewer.page.keyboard.press("Enter");
    await viewer.page.keyboard.press("Shift+ArrowDown");
    await viewer.page.keyboard.press("Shift+ArrowDown");
    await viewer.page.waitForSelector("[data-test=marked]:has-text('3 contours')");
    await viewer.page.selectOption("[data-test=owner]", { label: "Label 8" });
    await viewer.waitForStep("undo", "Change 3 contours");
    await viewer.page.waitForSelector(".structure-row.active button.name[aria-label='Label 8']");
    await viewer.page.click("[data-test=marked-visible]");
    await viewer.page.waitForFunction(() => document.querySelectorAll(".contour-row.off.selected").length === 3);
    await viewer.page.keyboard.press("Control+z");
    await viewer.page.keyboard.press("Control+z");
    await nameOf("labels").click();
    await viewer.waitForContours(before);
    assert.deepEqual(
      viewer.complaints.filter((text) => !/WebGL/.test(text)),
      [],
    );
  });
});
