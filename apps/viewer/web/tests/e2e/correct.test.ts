// SPDX-License-Identifier: Apache-2.0
// A mask that others segmented, corrected by strokes, outlines, points and whole slices, and taken back to the last voxel.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { beforeEach, test } from "node:test";
import { gzipSync } from "node:zlib";
import { BALL_RADIUS_MM, BallVisits, circle, voxels, writeImage, type Viewer } from "./support";

const visits = new BallVisits();
const file = () => join(visits.folder.path, "ball_mask.nii");
let viewer: Viewer;

const isBall = ([x, y, z]: readonly number[]) => Math.hypot(x!, y!, z!) < BALL_RADIUS_MM;

/** The ball with a leak to one side, and without its upper pole. */
function writeMask(): void {
  writeImage(file(), ([x, y, z]) => {
    const isLeak = x > 20 && x < 60 && Math.abs(y) < 8 && Math.abs(z) < 8;
    return isLeak || (isBall([x, y, z]) && z < 24) ? 1 : 0;
  });
}

beforeEach(async () => {
  writeMask();
  viewer = await visits.next();
  await viewer.import(file());
  await viewer.page.click("[data-test=import-mask]");
  await viewer.page.locator("[data-test=is-mask]").waitFor();
  await viewer.surfaceShown();
});

const said = (words: string | RegExp) => viewer.page.locator("[data-test=correction]", { hasText: words });
const picture = async (name: string) => {
  const folder = process.env["KONTUR_PICTURES"];
  if (folder) await viewer.page.screenshot({ path: join(folder, `${name}.png`) });
};

/** A part of the ball's circle on a view, from one angle to another in degrees, counter-clockwise from the right. */
async function arc(view: string, from: number, to: number): Promise<[number, number][]> {
  const radius = await viewer.pixels(view, BALL_RADIUS_MM);
  return Array.from({ length: 25 }, (_, n) => (from + ((to - from) * n) / 24) * (Math.PI / 180)).map((angle) => [
    radius * Math.cos(angle),
    -radius * Math.sin(angle),
  ]);
}

async function wrongVoxels(): Promise<number> {
  const inside = voxels((await viewer.export("mask.nii.gz")).bytes);
  const path = join(visits.folder.path, "truth.nii");
  writeImage(path, (p) => (isBall(p) ? 1 : 0));
  const truth = voxels(gzipSync(readFileSync(path)));
  assert.equal(inside.length * 2, truth.length, "one byte for two");
  return inside.reduce((sum, value, n) => sum + Number(value > 0 !== truth[2 * n]! > 0), 0);
}

test("strokes across its outline put a leak and a missing pole right, and undo gives it back", async () => {
  const { page } = viewer;
  await said("Nothing changed").waitFor();
  const before = (await viewer.export("mask.nii.gz")).bytes;
  const wrong = await wrongVoxels();

  await page.keyboard.press("f");
  const stroke = await arc("axial", 152, 208);
  await page.mouse.move(...(await viewer.at("axial", ...stroke[0]!)));
  await page.mouse.down();
  for (const place of stroke.slice(1)) await page.mouse.move(...(await viewer.at("axial", ...place)));
  await picture("correct_zone");
  await page.mouse.up();
  await viewer.waitForContours(1);
  await said(/ml less/).waitFor();
  const step = viewer.page.locator("[data-test=correction-step]");
  await step.filter({ hasText: /^Changed: \d+ voxels, [\d.]+ ml less\.$/ }).waitFor();
  await viewer.surfaceShown();
  await picture("correct_leak");

  await viewer.drag("coronal", await arc("coronal", 30, 150));
  await viewer.waitForContours(2);
  await step.filter({ hasText: /ml more\.$/ }).waitFor();
  await viewer.surfaceShown();
  await viewer.saved();
  const left = await wrongVoxels();
  assert.ok(left < 0.5 * wrong, `${left} of ${wrong} wrong voxels are left`);
  await page.click("[data-test=who]");
  await page.locator("[data-test=band-scale]", { hasText: "drawn, carried, image" }).waitFor();
  await viewer.surfaceShown();
  await picture("correct_who");

  const row = page.locator("[data-contour]").first();
  await row.hover();
  await row.locator("[data-test=delete-contour]").click();
  await viewer.waitForContours(1);
  while (!(await page.locator('[data-test=undo][title^="Undo: Import a mask"]').count())) {
    await page.keyboard.press("Control+z");
    await viewer.saved();
  }
  await said("Nothing changed").waitFor();
  await viewer.surfaceShown();
  assert.deepEqual(voxels((await viewer.export("mask.nii.gz")).bytes), voxels(before));
  assert.deepEqual(viewer.complaints, []);
});

test("whole outlines, points and slices correct it, too", async () => {
  const { page } = viewer;
  await page.keyboard.press("a");
  await page.locator("[data-test=confirmed-plane]").waitFor();
  await page.keyboard.press("Control+z");
  await page.locator("[data-test=confirmed-plane]").waitFor({ state: "detached" });

  await viewer.drawBall("axial", 1);
  await said(/ml less/).waitFor();
  await page.keyboard.press("e");
  await page.locator(".notice", { hasText: "is drawn in this plane; delete that correction first" }).waitFor();

  await page.keyboard.press("q");
  await viewer.click("coronal", 0, -(await viewer.pixels("coronal", 30)));
  await page.locator("[data-test=point-kind]").waitFor();
  await viewer.surfaceShown();
  assert.equal(await page.locator("[data-test=point-kind]").inputValue(), "interior", "the mask has it outside, and is wrong there");

  await page.keyboard.press("f");
  const far = circle(await viewer.pixels("coronal", 4), 12).slice(0, 6);
  const [right, down] = [await viewer.pixels("coronal", 52), await viewer.pixels("coronal", 40)];
  await viewer.drag(
    "coronal",
    far.map(([x, y]) => [x + right, y + down]),
  );
  await page.locator(".notice", { hasText: "The line is open, and an end of it lies" }).waitFor();
  await viewer.saved();
  assert.equal(await page.locator("[data-contour]").count(), 1);
});

test("a mask beside it follows where borders are shared, and comes back", async () => {
  const { page } = viewer;
  await page.keyboard.press("Control+z"); // the other mask goes
  await page.waitForFunction(() => document.querySelectorAll(".structure").length <= 1);
  writeImage(file(), (p) => (isBall(p) ? (p[0] < 8 ? 2 : 5) : 0));
  await viewer.import(file());
  await page.click("[data-test=import-mask]");
  await page.waitForFunction(() => document.querySelectorAll("[data-test=is-mask]").length === 2);
  await viewer.surfaceShown();
  const before = voxels((await viewer.export("labels.nii.gz")).bytes);
  const count = (bytes: Buffer, label: number) => bytes.reduce((sum, value) => sum + Number(value === label), 0);
  assert.ok(await page.locator("[data-test=share-borders]").isChecked());

  await page.keyboard.press("f");
  const mm = await viewer.pixels("axial", 1);
  const choose = (name: string) => page.locator(".structure-row .name", { hasText: name }).click();
  await choose("Label 2");
  // A stroke from the border between both into the first one, and back to it.
  const stroke = Array.from({ length: 21 }, (_, n): [number, number] => [(12 * Math.sin((n * Math.PI) / 20) - 8) * mm, (n - 10) * 2 * mm]);
  await viewer.drag("axial", stroke);
  await viewer.waitForContours(1);
  await viewer.surfaceShown();
  await viewer.saved();
  const shared = voxels((await viewer.export("labels.nii.gz")).bytes);
  const taken = count(shared, 5) - count(before, 5);
  assert.ok(taken > 100 && taken <= count(before, 2) - count(shared, 2), `${taken} voxels go to the other`);
  await choose("Label 5");
  await page.locator("[data-test=followed]", { hasText: `${taken.toLocaleString("en")} voxels` }).waitFor();
  await viewer.surfaceShown();
  await picture("correct_shared");

  await page.keyboard.press("Control+z");
  await page.locator("[data-test=followed]").waitFor({ state: "detached" });
  assert.deepEqual(voxels((await viewer.export("labels.nii.gz")).bytes), before);
  assert.deepEqual(viewer.complaints, []);
});
