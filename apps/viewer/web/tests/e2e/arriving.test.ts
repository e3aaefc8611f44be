// SPDX-License-Identifier: Apache-2.0
// A series that comes over a slow line: its slices are seen as they come.
import assert from "node:assert/strict";
import { join } from "node:path";
import { after, test } from "node:test";
import { ArchivePage } from "./archive_page";
import { SlowLink } from "./slow_link";
import { Viewer } from "./support";

const SLICES = 40; // of the patient
const line = new SlowLink();
const site = new ArchivePage({ patient: true, reached: (address) => line.to(address) });
after(() => {
  line.close();
});

test("slices of a series are seen as they come, and scrolled through, before all are here", async (t) => {
  if (site.address === "") return t.skip("orthanc or orthanc-dicomweb is not installed");
  const viewer = await Viewer.openStart(site.browser, site.server.address);
  const { page } = viewer;
  await page.click("[data-test=study]");
  await page.locator("[data-test=archived-volume] img[data-painted=true]").waitFor();
  line.isSlow = true;
  await page.click("[data-test=archived-volume]");

  const arriving = page.locator("[data-test=arriving]");
  const place = page.locator("[data-test=arriving-place]");
  await arriving.waitFor();
  const slices = async () => Number(await arriving.getAttribute("data-slices"));
  const atLeast = (count: number) =>
    page.waitForFunction((n) => Number(document.querySelector<HTMLElement>("[data-test=arriving]")?.dataset["slices"]) >= n, count);
  await atLeast(3);
  assert.ok((await slices()) < SLICES, "it is seen before all are here");
  assert.match(await page.locator("[data-test=arriving-text]").innerText(), /^\d+ slices are here$/);
  assert.ok(await arriving.locator("canvas").evaluate((canvas: HTMLCanvasElement) => canvas.width === 384 && canvas.height === 384));

  // Whoever scrolls stays where he is, while more come.
  await arriving.hover();
  await page.mouse.wheel(0, -100); // towards the first one: the last one is seen
  await page.mouse.wheel(0, -100);
  await page.waitForFunction(() => {
    const { value, max } = document.querySelector<HTMLInputElement>("[data-test=arriving-place]")!;
    return Number(value) < Number(max);
  });
  const chosen = Number(await place.inputValue());
  const known = await slices();
  await atLeast(known + 5);
  assert.equal(Number(await place.inputValue()), chosen);
  const into = process.env["KONTUR_PICTURES"];
  if (into) await page.screenshot({ path: join(into, "archive_arriving.png") });
  assert.ok((await slices()) < SLICES);

  line.isSlow = false;
  await page.locator("[data-test=identity]", { hasText: "ID" }).waitFor();
  assert.ok(await arriving.isHidden());
  await viewer.ready();
});
