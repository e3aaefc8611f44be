// SPDX-License-Identifier: Apache-2.0
// The example page in Chromium, by real events. KONTUR_WASM is the built package, KONTUR_PLAYWRIGHT playwright-core's module,
// KONTUR_CHROMIUM the browser; KONTUR_PICTURES, if set, gets a screenshot.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const { KONTUR_WASM, KONTUR_PLAYWRIGHT, KONTUR_CHROMIUM, KONTUR_PICTURES } = process.env;
const skip = KONTUR_PLAYWRIGHT && KONTUR_CHROMIUM ? false : "KONTUR_PLAYWRIGHT and KONTUR_CHROMIUM are not set";
const EXAMPLE = fileURLToPath(new URL("../example", import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };

let server, browser, page;

before(async () => {
  if (skip) return;
  const { chromium } = await import(pathToFileURL(KONTUR_PLAYWRIGHT));
  server = createServer(({ url }, reply) => {
    const [, packaged] = /^\/kontur-wasm\/([a-z.]+)$/.exec(url) ?? [];
    const file = packaged ? join(KONTUR_WASM, packaged) : join(EXAMPLE, url === "/" ? "index.html" : url.slice(1));
    reply.setHeader("Content-Type", TYPES[extname(file)] ?? "text/plain");
    reply.end(readFileSync(file));
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  browser = await chromium.launch({ executablePath: KONTUR_CHROMIUM, args: ["--no-sandbox"] });
  page = await browser.newPage({ viewport: { width: 1040, height: 680 } });
  page.on("pageerror", (error) => assert.fail(error));
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
});
after(async () => {
  await browser?.close();
  server?.close();
});

async function drawCircle(radius) {
  const box = await page.locator("#slice").boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x + radius, y);
  await page.mouse.down();
  for (let n = 1; n < 40; n++) await page.mouse.move(x + radius * Math.cos((2 * Math.PI * n) / 40), y + radius * Math.sin((2 * Math.PI * n) / 40));
  await page.mouse.up();
}

async function told(pattern) {
  await page.locator("#told", { hasText: pattern }).waitFor({ timeout: 60000 });
  return page.locator("#told").textContent();
}

const millilitres = (text) => Number(/([0-9.]+) ml/.exec(text)[1]);

test("circles drawn on three slices become a ball", { skip }, async () => {
  for (const [at, radius] of [
    [0, 100],
    [-24, 80],
    [24, 80],
  ]) {
    await page.locator("#height").fill(String(at));
    await drawCircle(radius);
    await told(/ml/);
  }
  const ml = millilitres(await told(/3 outlines/)); // a ball of 40 mm has 268 ml
  assert.ok(ml > 240 && ml < 300, `${ml}`);
  if (KONTUR_PICTURES) await page.screenshot({ path: join(KONTUR_PICTURES, "drawn.png") });
  await page.click("#undo");
  await told(/2 outlines/);
});

test("the phantom's kidney is shown and can be turned", { skip }, async () => {
  await page.click("#phantom");
  const ml = millilitres(await told(/6 outlines/));
  assert.ok(ml > 100 && ml < 400, `${ml}`);
  const before = await page.locator("#surface").screenshot();
  const box = await page.locator("#surface").boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  await page.mouse.move(box.x + 280, box.y + 230, { steps: 5 });
  await page.mouse.up();
  assert.ok(!before.equals(await page.locator("#surface").screenshot()));
  if (KONTUR_PICTURES) await page.screenshot({ path: join(KONTUR_PICTURES, "kidney.png") });
});
