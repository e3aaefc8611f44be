// SPDX-License-Identifier: Apache-2.0
// Studies of an archive on the start page: Debian's Orthanc by DICOMweb.
import assert from "node:assert/strict";
import { readdirSync, statSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { ArchivePage } from "./archive_page";
import { circle, Viewer } from "./support";

const site = new ArchivePage();

const picture = async (viewer: Viewer, name: string) => {
  const into = process.env["KONTUR_PICTURES"];
  if (into) await viewer.page.screenshot({ path: join(into, `${name}.png`) });
};

test("lists studies, shows the series of one with a picture, and opens it", async (t) => {
  if (site.address === "") return t.skip("orthanc or orthanc-dicomweb is not installed");
  const viewer = await Viewer.openStart(site.browser, site.server.address);
  const { page } = viewer;
  const study = page.locator("[data-test=study]");
  await study.waitFor();
  assert.match(await study.innerText(), /Phantom.*CT/s);
  await page.fill("[data-test=archive-name]", "Nobody");
  await page.click("[data-test=archive-search]");
  await page.getByText("The archive has no study that fits.").waitFor();
  await page.fill("[data-test=archive-name]", "Phan");
  await page.keyboard.press("Enter");
  await study.click();
  const card = page.locator("[data-test=archived-volume]");
  await card.locator("img[data-painted=true]").waitFor();
  await picture(viewer, "archive_series");
  await card.click();
  await page.locator("[data-test=identity]", { hasText: "ID P1" }).waitFor();
  await picture(viewer, "archive_opened");

  // What is made goes back, as new objects of the study; what does not arrive can be sent again.
  await viewer.ready();
  await viewer.closeHint();
  await page.keyboard.press("f");
  await viewer.drag("axial", circle(60, 36));
  await viewer.waitForContours(1);
  await viewer.surfaceShown();
  await page.click("[data-test=export]");
  await page.locator("[data-test=sending] h3", { hasText: `Send to ${new URL(site.address).host}` }).waitFor();
  const said = page.locator("[data-test=sent]");
  const modalities = async (): Promise<string[]> => {
    const [found] = (await (await fetch(`${site.address}/studies?includefield=00080061`)).json()) as Record<string, { Value?: string[] }>[];
    return found!["00080061"]?.Value ?? [];
  };
  assert.deepEqual(await modalities(), ["CT"]);
  await page.click('[data-test="send-seg.dcm"]');
  await said.filter({ hasText: "has stored it in the study of the image." }).waitFor();
  await picture(viewer, "archive_sent");
  assert.deepEqual((await modalities()).sort(), ["CT", "SEG"]);
  await site.archive.ended();
  await page.click('[data-test="send-rtstruct.dcm"]');
  await said.filter({ hasText: "DICOM RTSTRUCT was not sent: " }).waitFor();
  await picture(viewer, "archive_not_sent");
  await page.click("[data-test=send-again]");
  await said.filter({ hasText: "DICOM RTSTRUCT was not sent: " }).waitFor();

  // Neither kontur nor the archive is there any more. Both come back, and it is sent as it was.
  const outbox = join(site.folder.path, "kontur", "outbox");
  const [kept, ...others] = readdirSync(outbox);
  assert.match(kept!, /_rtstruct\.dcm$/);
  assert.deepEqual(others, []);
  assert.equal(statSync(outbox).mode & 0o777, 0o700);
  assert.equal(statSync(join(outbox, kept!)).mode & 0o777, 0o600);
  await page.close();
  await site.server.end();
  assert.equal(await site.archive.serve(new URL(site.address).port), site.address);
  await site.start();
  const again = await Viewer.openStart(site.browser, site.server.address);
  await again.page.locator("[data-test=recent]").first().click();
  await again.page.locator(".notice", { hasText: "DICOM RTSTRUCT was made before and did not arrive at" }).waitFor();
  await picture(again, "archive_waiting");
  await again.page.click("[data-test=remedy]");
  await again.page.locator(".notice", { hasText: "DICOM RTSTRUCT: " }).filter({ hasText: "has stored it in the study of the image." }).waitFor();
  assert.deepEqual(readdirSync(outbox), []);
});
