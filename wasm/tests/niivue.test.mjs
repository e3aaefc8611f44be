// SPDX-License-Identifier: Apache-2.0
// niivue's drawing layer, painted by real events, filled by kontur-wasm.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { dragCircle, open, peer, picture, skipWithout, told } from "./served.mjs";

const skip = skipWithout("@niivue/niivue");
const RADIUS = 90; // of a painted ball, in pixels
let page, close;

before(async () => {
  if (skip) return;
  ({ page, close } = await open("niivue.html", { folders: { niivue: peer("@niivue/niivue/dist") }, viewport: { width: 1020, height: 860 } }));
  await told(page, /Drag/);
});
after(() => close?.());

/** As niivue saves it: in the axes of the volume's file, not in those of its drawing layer. */
const saved = () => page.evaluate(async () => Array.from((await nv.saveImage({ filename: "", isSaveDrawing: true })).subarray(352)));
const painted = (labels) => labels.reduce((sum, value) => sum + value, 0);

/** The axial tile: its middle, and pixels to a mm. */
async function axial() {
  const box = await page.locator("#canvas").boundingBox();
  const [left, top, width, height] = await page.evaluate(() =>
    nv.screenSlices.find(({ axCorSag }) => axCorSag === 0).leftTopWidthHeight.map((pixels) => pixels / nv.uiData.dpr),
  );
  return { middle: [box.x + left + width / 2, box.y + top + height / 2], pixelsPerMm: width / (2 * (await page.evaluate(() => grid.size[0]))) };
}

test("circles painted on five slices become a ball, and undo takes it back", { skip }, async () => {
  const { middle, pixelsPerMm } = await axial();
  const half = await page.evaluate(() => Math.floor(grid.size[2] / 2));
  const radiusAt = (slice) => Math.sqrt(Math.max(0, (RADIUS / pixelsPerMm / 2) ** 2 - (slice - half) ** 2)); // in voxels of 2 mm
  const top = Math.floor(0.9 * radiusAt(half));
  const slices = [-top, -Math.round(top / 2), 0, Math.round(top / 2), top].map((from) => half + from);
  for (const slice of slices) {
    await page.locator("#slice").fill(String(slice));
    await dragCircle(page, middle, radiusAt(slice) * 2 * pixelsPerMm);
  }
  const before = await saved();
  await page.click("#fill");
  assert.match(await told(page, /added/), new RegExp(`^${painted(before)} voxels painted`));
  await picture(page, "niivue_filled");
  const after = await saved();
  const [i, j, k] = await page.evaluate(() => grid.size);
  const sliceOf = (labels, n) => labels.slice(n * i * j, (n + 1) * i * j);
  for (let n = 0; n < k; n++) {
    const area = painted(sliceOf(after, n));
    if (slices.includes(n)) assert.deepEqual(sliceOf(after, n), sliceOf(before, n));
    else if (Math.abs(n - half) > top) assert.equal(area, 0);
    else assert.ok(Math.abs(area / (Math.PI * radiusAt(n) ** 2) - 1) < 0.06, `slice ${n}: ${area} voxels, a ball has ${Math.PI * radiusAt(n) ** 2}`);
  }
  const different = await page.evaluate(
    ([before, after]) => kontur.fill({ labels: Uint8Array.from(before), grid }).labels.reduce((sum, label, n) => sum + (label === after[n] ? 0 : 1), 0),
    [before, after],
  );
  console.log(`${different} of ${painted(after)} voxels differ from those that kontur fills in the file's axes`);
  assert.ok(different <= 1e-3 * painted(after), `${different}`);
  await page.click("#undo");
  assert.deepEqual(await saved(), before);
});

test("contours are drawn where the volume is: the voxels of kontur's own mask", { skip }, async () => {
  await page.evaluate(() => nv.createEmptyDrawing());
  await page.click("#contours");
  await told(page, /6 planes/);
  const mask = await page.evaluate(() => Array.from(kontur.segment({ contours, grid }).mask));
  const drawn = await saved();
  assert.ok(painted(mask) > 1000);
  assert.deepEqual(drawn, mask);
  await picture(page, "niivue_contours");
});

test("what cannot be filled is told in one sentence", { skip }, async () => {
  await page.evaluate(() => nv.createEmptyDrawing());
  await page.click("#fill");
  await told(page, /no label|nothing|has no/i);
});
