// SPDX-License-Identifier: Apache-2.0
// A planner's day: a study from the archive, a tumour, its margin within the body and away from the cord, a correction, approvals, and back.
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { ArchivePage } from "./archive_page";
import { circle, Viewer } from "./support";

const site = new ArchivePage({ patient: true });

/** What the archive says of the structure set that it has: by tags. */
async function structureSet(): Promise<Record<string, { Value?: unknown[] }>> {
  const headers = { accept: "application/dicom+json" };
  const [study] = (await (await fetch(`${site.address}/studies`, { headers })).json()) as Record<string, { Value?: string[] }>[];
  const uid = study!["0020000D"]!.Value![0]!;
  const all = (await (await fetch(`${site.address}/studies/${uid}/metadata`, { headers })).json()) as Record<string, { Value?: unknown[] }>[];
  return all.find((one) => one["00080060"]?.Value?.[0] === "RTSTRUCT")!;
}

test("a planner's day", async (t) => {
  if (site.address === "") return t.skip("orthanc or orthanc-dicomweb is not installed");
  const began = Date.now();
  const viewer = await Viewer.openStart(site.browser, site.server.address);
  const { page } = viewer;
  const picture = async (name: string) => {
    const into = process.env["KONTUR_PICTURES"];
    if (into) await page.screenshot({ path: join(into, `planner_${name}.png`) });
  };
  const choose = (name: string) => page.locator(".structure-row button.name", { hasText: new RegExp(`^${name}$`) }).click();
  const add = async (name: string) => {
    await page.click("[data-test=add-structure]");
    await page.locator("input.name:focus").waitFor();
    await page.keyboard.type(name);
    await page.keyboard.press("Enter");
  };
  await page.locator("[data-test=study]").click();
  await page.locator("[data-test=archived-volume]").click();
  await viewer.ready();
  await viewer.closeHint();

  await viewer.rename(0, "Tumour");
  await viewer.drawBall("axial", 1, 18);
  await viewer.drawBall("coronal", 2, 18);
  await viewer.surfaceShown();
  const tumour = await viewer.volume();
  assert.ok(Math.abs(tumour / 24.4 - 1) < 0.15, `${tumour} ml`);
  await picture("tumour");

  await add("Cord");
  const cord = await viewer.pixels("axial", 8);
  const aside = await viewer.pixels("axial", 38);
  const outline = circle(cord, 24).map(([x, y]): [number, number] => [x - aside, y]);
  for (const [count, keys] of [
    [3, ["PageUp"]],
    [4, ["PageDown", "PageDown"]],
    [5, ["PageUp"]],
  ] as const) {
    await viewer.drag("axial", outline);
    await viewer.waitForContours(count);
    for (const key of keys) await page.keyboard.press(key);
    await viewer.slicesShown();
  }
  await viewer.saved();
  await viewer.surfaceShown();

  await choose("Tumour");
  await page.click("[data-test=add-rule]");
  await page.click("[data-test=rule-menu] summary");
  await viewer.type(page.locator("[data-test=menu-margin]"), "15");
  await page.selectOption("[data-test=menu-crop]", "body()");
  await viewer.type(page.locator("[data-test=menu-cropGap]"), "3");
  await page.selectOption("[data-test=menu-spare]", "Cord");
  await viewer.type(page.locator("[data-test=menu-spareMargin]"), "3");
  assert.equal(await page.locator("[data-test=rule-field]").inputValue(), "PTV = crop(Tumour + 15 mm, body(), 3 mm) - (Cord + 3 mm)");
  await page.locator("[data-test=rule-volume]", { hasText: "ml" }).waitFor();
  await picture("rule");
  await page.click("[data-test=rule-take]");
  await viewer.waitForStep("undo", "Add PTV");
  await viewer.surfaceShown();
  const planned = await viewer.volume();
  await picture("ptv");

  // The tumour is larger to its left: the PTV follows.
  await choose("Tumour");
  await page.keyboard.press("v");
  const radius = await viewer.pixels("axial", 18);
  await viewer.drag("axial", [
    [radius, 0],
    [radius + 10, 0],
    [radius + 20, 0],
  ]);
  await viewer.saved();
  await viewer.surfaceShown();
  assert.ok((await viewer.volume()) > 1.02 * tumour);
  await choose("PTV");
  await page.waitForFunction((least) => Number.parseFloat(document.querySelector(".figure strong")!.textContent!) > least, 1.01 * planned);
  await picture("corrected");

  for (const name of ["Tumour", "Cord", "PTV"]) {
    await choose(name);
    await page.click("[data-test=approve]");
    if (name === "Tumour") await page.keyboard.type("Doe^Jane");
    await page.keyboard.press("Enter");
    await viewer.waitForStep("undo", `Approve ${name}`);
  }
  await picture("approved");
  await page.click("[data-test=export]");
  await page.click('[data-test="send-rtstruct.dcm"]');
  await page.locator("[data-test=sent]", { hasText: "has stored it in the study of the image." }).waitFor();
  await picture("sent");
  t.diagnostic(`${((Date.now() - began) / 1000).toFixed(1)} s`);
  const sent = await structureSet();
  assert.equal(sent["300E0002"]?.Value?.[0], "APPROVED");
  assert.deepEqual(sent["300E0008"]?.Value, [{ Alphabetic: "Doe^Jane" }]);
  const rois = sent["30060020"]!.Value as Record<string, { Value?: string[] }>[];
  assert.deepEqual(
    rois.map((roi) => roi["30060026"]!.Value![0]),
    ["Tumour", "Cord", "PTV"],
  );
  assert.deepEqual(viewer.complaints, []);
});
