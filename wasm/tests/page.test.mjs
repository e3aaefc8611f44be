// SPDX-License-Identifier: Apache-2.0
// The example page in Chromium, by real events.
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { dragCircle, open, picture, skip, told } from "./served.mjs";

let page, close;

before(async () => {
  if (!skip) ({ page, close } = await open("index.html"));
});
after(() => close?.());

async function middle(selector) {
  const box = await page.locator(selector).boundingBox();
  return [box.x + box.width / 2, box.y + box.height / 2];
}

const millilitres = (text) => Number(/([0-9.]+) ml/.exec(text)[1]);

test("circles drawn on three slices become a ball", { skip }, async () => {
  for (const [at, radius] of [
    [0, 100],
    [-24, 80],
    [24, 80],
  ]) {
    await page.locator("#height").fill(String(at));
    await dragCircle(page, await middle("#slice"), radius);
    await told(page, /ml/);
  }
  const ml = millilitres(await told(page, /3 outlines/)); // a ball of 40 mm has 268 ml
  assert.ok(ml > 240 && ml < 300, `${ml}`);
  await picture(page, "drawn");
  await page.click("#undo");
  await told(page, /2 outlines/);
});

test("the phantom's kidney is shown and can be turned", { skip }, async () => {
  await page.click("#phantom");
  const ml = millilitres(await told(page, /6 outlines/));
  assert.ok(ml > 100 && ml < 400, `${ml}`);
  const before = await page.locator("#surface").screenshot();
  const box = await page.locator("#surface").boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 280, box.y + 230, { steps: 5 });
  await page.mouse.up();
  assert.ok(!before.equals(await page.locator("#surface").screenshot()));
  await picture(page, "kidney");
});

test("the plain page of 60 lines makes a mask", { skip }, async () => {
  const plain = await open("plain.html");
  try {
    const box = await plain.page.locator("#canvas").boundingBox();
    for (const [at, radius] of [
      [20, 16],
      [32, 20],
      [44, 16],
    ]) {
      await plain.page.locator("#slice").fill(String(at));
      await dragCircle(plain.page, [box.x + box.width / 2, box.y + box.height / 2], (radius * box.width) / 64);
    }
    const ml = millilitres(await told(plain.page, /3 outlines/)); // a ball of 20 mm has 33.5 ml
    assert.ok(ml > 30 && ml < 36, `${ml}`);
    await plain.page.locator("#slice").fill("26");
    await picture(plain.page, "plain");
  } finally {
    await plain.close();
  }
});
