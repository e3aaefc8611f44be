// SPDX-License-Identifier: Apache-2.0
// The examples in Chromium: KONTUR_WASM is the built package, KONTUR_PLAYWRIGHT playwright-core's module, KONTUR_CHROMIUM the
// browser; KONTUR_PICTURES, if set, gets screenshots. KONTUR_PEERS is a folder with the packages of package.json beside this.
import assert from "node:assert/strict";
import { existsSync, readFileSync } from "node:fs";
import { createServer } from "node:http";
import { extname, join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const { KONTUR_WASM, KONTUR_PLAYWRIGHT, KONTUR_CHROMIUM, KONTUR_PICTURES, KONTUR_PEERS } = process.env;
const EXAMPLE = fileURLToPath(new URL("../example", import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".wasm": "application/wasm" };

/** Why pages cannot be tested here; false where they can. */
export const skip = KONTUR_PLAYWRIGHT && KONTUR_CHROMIUM ? false : "KONTUR_PLAYWRIGHT and KONTUR_CHROMIUM are not set";

/** The same for pages with a package of others. */
export function skipWithout(name) {
  return skip || (KONTUR_PEERS && existsSync(peer(name)) ? false : `${name} is not in KONTUR_PEERS`);
}

export const peer = (path) => join(KONTUR_PEERS ?? "", "node_modules", path);

/** A page of the example folder; `folders` says where others are: { niivue: PATH }. */
export async function open(name, { folders = {}, viewport = { width: 1040, height: 680 } } = {}) {
  const { chromium } = await import(pathToFileURL(KONTUR_PLAYWRIGHT));
  const places = { "kontur-wasm": KONTUR_WASM, ...folders };
  const server = createServer(({ url }, reply) => {
    const [, folder, path] = /^\/([a-z-]+)\/([\w.-]+)$/.exec(url) ?? [];
    const file = places[folder] ? join(places[folder], path) : join(EXAMPLE, url.slice(1));
    reply.writeHead(existsSync(file) ? 200 : 404, { "Content-Type": TYPES[extname(file)] ?? "text/plain" });
    reply.end(existsSync(file) ? readFileSync(file) : "");
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const browser = await chromium.launch({ executablePath: KONTUR_CHROMIUM, args: ["--no-sandbox", "--enable-unsafe-swiftshader"] });
  const page = await browser.newPage({ viewport });
  page.on("pageerror", (error) => assert.fail(error));
  await page.goto(`http://127.0.0.1:${server.address().port}/${name}`);
  const close = async () => {
    await browser.close();
    server.close();
  };
  return { page, close };
}

/** What the page says, once it says such a thing. */
export async function told(page, pattern) {
  await page.locator("#told", { hasText: pattern }).waitFor({ timeout: 60000 });
  return page.locator("#told").textContent();
}

export async function dragCircle(page, [x, y], radius) {
  const STEPS = 40;
  await page.mouse.move(x + radius, y);
  await page.mouse.down();
  for (let n = 1; n < STEPS; n++) await page.mouse.move(x + radius * Math.cos((2 * Math.PI * n) / STEPS), y + radius * Math.sin((2 * Math.PI * n) / STEPS));
  await page.mouse.up();
}

export async function picture(page, name) {
  if (KONTUR_PICTURES) await page.screenshot({ path: join(KONTUR_PICTURES, `${name}.png`) });
}
