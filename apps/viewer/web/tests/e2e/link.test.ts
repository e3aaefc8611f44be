// SPDX-License-Identifier: Apache-2.0
// The page at the end of a slow connection, as through a tunnel.
import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { onlyChromium } from "./browsers";
import { BallVisits, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

beforeEach(async () => {
  viewer = await visits.next();
});

const bright = () => viewer.countPixels("axial", (r, g, b) => Math.min(r, g, b) > 150);

test("slices come compressed where the connection is slow, and look as before", onlyChromium("a connection is made slow by Chromium's DevTools"), async () => {
  const { page } = viewer;
  const encodings: (string | undefined)[] = [];
  page.on("response", (reply) => void (reply.url().endsWith("/api/slice") && encodings.push(reply.headers()["content-encoding"])));
  await viewer.zoomOut("axial"); // else the image's own pixels are too few to tell how fast they come
  await page.mouse.move(...(await viewer.at("axial", 0, 60)));
  const scroll = async (delta: number) => {
    await page.mouse.wheel(0, delta);
    await viewer.slicesShown();
    await page.waitForTimeout(100);
  };
  for (const delta of [120, -120]) await scroll(delta);
  const before = await bright();
  assert.ok(before > 300);
  const devTools = await page.context().newCDPSession(page);
  await devTools.send("Network.enable");
  await devTools.send("Network.emulateNetworkConditions", { offline: false, latency: 10, downloadThroughput: 1e6, uploadThroughput: 1e6 });
  for (const delta of [120, -120, 120, -120, 120, -120, 120, -120]) await scroll(delta);
  assert.equal(encodings.at(-1), "gzip");
  assert.equal(await bright(), before);
  assert.deepEqual(viewer.complaints, []);
});
