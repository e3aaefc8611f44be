// SPDX-License-Identifier: Apache-2.0
// What the page costs before it is of use: counted, not timed, so that a busy machine says the same.
import assert from "node:assert/strict";
import { before, test } from "node:test";
import type { Browser, Request, Response } from "playwright-core";
import { launch, onlyChromium } from "./browsers";
import { cleanUp, Server, temporaryFolder, writeBallImage } from "./support";

const PAGE_BYTES = 400_000;
const FIRST_BYTES = 110_000; // of the page's files, until there is a slice: the 3D view comes after it
const ROUND_TRIPS = 4; // the page, its script, the session, the slice

const folder = temporaryFolder();
let browser: Browser;
let server: Server;

before(async () => {
  const image = `${folder.path}/ball.nii`;
  writeBallImage(image);
  browser = await launch();
  server = await Server.start(folder.path, image);
});
cleanUp(folder, () => [browser, server]);

const isOfPage = (url: string) => !new URL(url).pathname.startsWith("/api/");
const bytesOf = (response: Response) => Number(response.headers()["content-length"]);

/** Opens the page and notes what it asks for, until all of it is there. */
async function opened() {
  const page = await browser.newPage();
  const responses: Response[] = [];
  /** How many answers each request has waited for, one after the other, and its own. */
  const depths = new Map<Request, number>();
  let deepest = 0; // of what has been answered so far
  let firstSlice: { depth: number; bytes: number } | null = null;
  page.on("request", (request) => depths.set(request, deepest + 1));
  page.on("response", (response) => {
    responses.push(response);
    deepest = Math.max(deepest, depths.get(response.request())!);
    if (!response.url().endsWith("/api/slice")) return;
    firstSlice ??= {
      depth: depths.get(response.request())!,
      bytes: responses.filter((one) => isOfPage(one.url())).reduce((sum, one) => sum + bytesOf(one), 0),
    };
  });
  page.on("websocket", (socket) => {
    const depth = deepest + 1;
    socket.once("framereceived", () => (deepest = Math.max(deepest, depth)));
  });
  await page.goto(server.address);
  await page.waitForSelector("[data-slices]");
  await page.waitForSelector("[data-webgl]"); // the script of the 3D view has come
  await page.close();
  return { files: responses.filter((one) => isOfPage(one.url())), firstSlice: firstSlice! as { depth: number; bytes: number } };
}

test("the whole page is at most 400 kB, as the browser gets it", async () => {
  const { files } = await opened();
  const bytes = files.map(bytesOf);
  assert.ok(files.length >= 4, files.map((file) => file.url()).join());
  assert.ok(bytes.every((size) => size > 0));
  assert.ok(bytes.reduce((a, b) => a + b) <= PAGE_BYTES, `${bytes.join(" + ")} bytes`);
});

test(
  "the first slice waits for four answers one after the other, and for a quarter of the page",
  onlyChromium("Playwright tells of WebSockets' frames there"),
  async () => {
    const { firstSlice } = await opened();
    assert.ok(firstSlice.depth <= ROUND_TRIPS, `${firstSlice.depth} answers`);
    assert.ok(firstSlice.bytes <= FIRST_BYTES, `${firstSlice.bytes} bytes`);
  },
);
