// SPDX-License-Identifier: Apache-2.0
// Studies of an archive on the start page: Debian's Orthanc by DICOMweb.
import assert from "node:assert/strict";
import { spawn, type ChildProcess } from "node:child_process";
import { mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";
import { after, before, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { cleanUp, Server, temporaryFolder, Viewer } from "./support";

const folder = temporaryFolder();
const python = process.env["KONTUR_TEST_PYTHON"];
const series = process.env["KONTUR_DICOM_SERIES"];
let archive: ChildProcess | undefined;
let address = "";
let server: Server;
let browser: Browser;

/** Its address; "" where Orthanc is not installed. */
function serve(): Promise<string> {
  if (!python || !series) return Promise.resolve("");
  const script = join(dirname(series), "..", "archive", "serve.py");
  const child = (archive = spawn(python, [script, join(folder.path, "orthanc")], { stdio: ["pipe", "pipe", "inherit"] }));
  return new Promise((resolve, reject) => {
    createInterface(child.stdout).once("line", resolve);
    child.once("exit", (code) => (code === 77 ? resolve("") : reject(new Error(`the archive ended: ${code}`))));
  });
}

before(async () => {
  mkdirSync(join(folder.path, "orthanc"));
  address = await serve();
  if (address === "") return;
  browser = await launch();
  server = await Server.startAt({ HOME: folder.path, XDG_CACHE_HOME: join(folder.path, "cache") }, folder.path, "--archive", address);
});

after(() => {
  archive?.stdin?.end();
});
cleanUp(folder, () => [browser, server]);

const picture = async (viewer: Viewer, name: string) => {
  const into = process.env["KONTUR_PICTURES"];
  if (into) await viewer.page.screenshot({ path: join(into, `${name}.png`) });
};

test("lists studies, shows the series of one with a picture, and opens it", async (t) => {
  if (address === "") return t.skip("orthanc or orthanc-dicomweb is not installed");
  const viewer = await Viewer.openStart(browser, server.address);
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
});
