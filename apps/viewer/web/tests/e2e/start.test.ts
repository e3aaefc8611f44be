// SPDX-License-Identifier: Apache-2.0
// The start page: how a day begins without a command line.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { circle, cleanUp, Server, temporaryFolder, Viewer, writeBallImage } from "./support";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const folder = temporaryFolder();
const home = join(folder.path, "home");
let server: Server;
let browser: Browser;

before(async () => {
  for (const name of ["scans/old", ".hidden", "study"]) mkdirSync(join(home, name), { recursive: true });
  writeBallImage(join(home, "scans", "ball.nii"));
  copyFileSync(join(home, "scans", "ball.nii"), join(home, "scans", "second.nii"));
  copyFileSync(join(home, "scans", "ball.nii"), join(home, ".hidden", "secret.nii"));
  writeFileSync(join(home, "scans", "broken.nii"), "this is no image");
  writeFileSync(join(home, "scans", "notes.txt"), "no image either");
  symlinkSync("/etc", join(home, "scans", "out"));
  browser = await launch();
});

cleanUp(folder, () => [browser, server]);

/** The start page of a new server. */
async function visit(...words: string[]): Promise<Viewer> {
  await (server as Server | undefined)?.end();
  server = await Server.startAt({ HOME: home }, folder.path, ...words);
  return Viewer.openStart(browser, server.address);
}

const names = (viewer: Viewer, what: string) => viewer.page.locator(`[data-test=${what}]`).allTextContents();
const entry = (viewer: Viewer, name: string) => viewer.page.locator(`[data-test=entries] button[title$="/${name}"]`);

async function goHome(viewer: Viewer): Promise<void> {
  await viewer.page.click("[data-test=place]:has-text('Home')");
  await viewer.page.waitForSelector(`[data-test=entries][data-folder="${home}"]`);
}

async function enter(viewer: Viewer, name: string): Promise<void> {
  await entry(viewer, name).click();
  await viewer.page.waitForSelector(`[data-test=entries][data-folder$="/${name}"]`);
}

async function picture(viewer: Viewer, name: string): Promise<void> {
  const into = process.env["KONTUR_PICTURES"];
  if (into) await viewer.page.screenshot({ path: join(into, `${name}.png`) });
}

async function axeFindings(viewer: Viewer): Promise<string[]> {
  await viewer.page.evaluate(AXE);
  return viewer.page.evaluate(async () => {
    const { axe } = window as unknown as { axe: { run: (options: object) => Promise<{ violations: { id: string; nodes: { html: string }[] }[] }> } };
    const { violations } = await axe.run({ runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] });
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(" ")}`);
  });
}

/** The ball's image three times, as frames. */
function writeFrames(path: string): void {
  const one = readFileSync(join(home, "scans", "ball.nii"));
  const head = Buffer.from(one.subarray(0, 352));
  head.writeInt16LE(4, 40);
  head.writeInt16LE(3, 48);
  writeFileSync(path, Buffer.concat([head, ...Array.from({ length: 3 }, () => one.subarray(352))]));
}

describe("the start page", () => {
  test("lists folders and what can be opened, and no more", async () => {
    const viewer = await visit();
    await goHome(viewer);
    assert.deepEqual(await names(viewer, "folder"), ["scans", "study"], "no hidden folder");
    await enter(viewer, "scans");
    assert.deepEqual(await names(viewer, "folder"), ["old"], "no link that leads out");
    assert.deepEqual(
      (await names(viewer, "file")).map((text) => /^[a-z]+\.nii/.exec(text)?.[0]),
      ["ball.nii", "broken.nii", "second.nii"],
    );
    await viewer.type(viewer.page.locator("[data-test=filter]"), "sec");
    assert.equal((await names(viewer, "file")).length, 1);
    await viewer.page.click("[data-test=folder-up]");
    await viewer.page.waitForSelector(`[data-test=entries][data-folder="${home}"]`);
    assert.deepEqual(await axeFindings(viewer), []);
    assert.deepEqual(viewer.complaints, []);
    await viewer.page.close();
  });

  test("says in one sentence why something cannot be opened, and lets the user go on", async () => {
    const viewer = await visit();
    const problem = viewer.page.locator("[data-test=start-problem]");
    await goHome(viewer);
    await enter(viewer, "scans");
    await entry(viewer, "broken.nii").click();
    await problem.waitFor();
    assert.match((await problem.textContent())!, /broken\.nii.*\.$/);
    for (const path of ["/etc/passwd", join(home, ".hidden", "secret.nii"), join(home, "scans", "out", "passwd")]) {
      await viewer.type(viewer.page.locator("[data-test=path]"), path);
      await viewer.page.keyboard.press("Enter");
      await viewer.page.waitForFunction((wanted) => document.querySelector("[data-test=start-problem]")!.textContent!.includes(wanted), path);
      assert.match((await problem.textContent())!, /lies outside of the folders that this page may open\. To open it here, start kontur with it: kontur open /);
    }
    assert.equal(await viewer.page.inputValue("[data-test=path]"), join(home, "scans", "out", "passwd"), "what was typed stays");
    await viewer.page.close();
  });

  test("a folder that comes late leaves what someone is typing", async () => {
    const viewer = await visit();
    const { page } = viewer;
    await goHome(viewer);
    let arrive = () => {};
    const late = new Promise<void>((resolve) => (arrive = resolve));
    await page.route("**/api/folder?*", async (route) => {
      await late;
      await route.continue();
    });
    await page.click("[data-test=place]:has-text('Home')");
    const reply = page.waitForResponse("**/api/folder?*");
    await viewer.type(page.locator("[data-test=path]"), "~/scans/ba");
    arrive();
    await reply;
    await page.keyboard.type("ll.nii");
    await page.keyboard.press("Enter");
    await viewer.ready();
    await page.close();
  });

  test("opens an image, and back there finds it among the recent ones, with what was drawn", async () => {
    const viewer = await visit();
    await goHome(viewer);
    await enter(viewer, "scans");
    await entry(viewer, "ball.nii").click();
    await viewer.ready();
    assert.equal(await viewer.page.locator("[data-test=start]").isVisible(), false);
    await viewer.closeHint();
    await viewer.page.keyboard.press("f");
    await viewer.drag("axial", circle(await viewer.pixels("axial", 40), 30));
    await viewer.waitForContours(1);
    await viewer.saved();

    await viewer.page.click("[data-test=another]");
    await viewer.page.waitForSelector("[data-test=start][open]");
    await viewer.page.waitForSelector(`[data-test=entries][data-folder="${join(home, "scans")}"]`);
    await entry(viewer, "second.nii").click();
    await viewer.ready();
    await viewer.waitForContours(0);
    await viewer.page.click("[data-test=another]");
    await viewer.page.waitForSelector("[data-test=start][open]");
    const recent = await names(viewer, "recent");
    assert.deepEqual(
      recent.map((text) => /^[a-z]+\.nii/.exec(text)?.[0]),
      ["second.nii", "ball.nii"],
      "the latest first",
    );
    await viewer.page.locator("[data-test=recent]").last().focus();
    await viewer.page.keyboard.press("Enter");
    await viewer.ready();
    await viewer.waitForContours(1);
    await viewer.page.keyboard.press("Control+z");
    await viewer.waitForContours(0);
    assert.deepEqual(viewer.complaints, []);
    await viewer.page.close();
  });

  test("shows the same in two pages", async () => {
    const viewer = await visit(join(home, "scans", "ball.nii"), "--project", join(folder.path, "two.kontur"));
    await viewer.ready();
    const other = await Viewer.open(browser, server.address);
    await viewer.closeHint();
    await viewer.page.click("[data-test=another]");
    for (const { page } of [viewer, other]) await page.waitForSelector("[data-test=start][open]");
    await other.page.click("[data-test=example]");
    for (const one of [viewer, other]) await one.ready();
    assert.equal(await viewer.page.title(), "Phantom: upper abdomen · kontur");
    for (const { page } of [viewer, other]) await page.close();
  });

  test("lists the series of a DICOM folder with pictures, and opens the one that is chosen", async (t) => {
    const python = process.env["KONTUR_TEST_PYTHON"];
    const script = process.env["KONTUR_DICOM_SERIES"];
    if (!python || !script) return t.skip("no script that writes DICOM files");
    for (const [name, into] of [
      ["other_series", "a + b"], // names are written otherwise in addresses
      ["echoes", "b"],
    ] as const) {
      const made: { status: number | null; stderr: string } = spawnSync(python, [script, name, join(home, "study", into)], { encoding: "utf8" });
      assert.equal(made.status, 0, made.stderr);
    }
    const viewer = await visit();
    await goHome(viewer);
    await enter(viewer, "study");
    const volumes = viewer.page.locator("[data-test=volume]");
    await volumes.first().waitFor();
    await viewer.page.waitForFunction(() =>
      [...document.querySelectorAll<HTMLElement>(".volume canvas")].every((canvas) => canvas.dataset["painted"] === "true"),
    );
    const texts = await volumes.allTextContents();
    assert.equal(texts.length, 4, texts.join("; ")); // two series, and two echoes of one
    for (const text of texts) assert.match(text, /CT.*\d+ slices of 14 × 12/);
    assert.match((await viewer.page.locator("[data-test=volumes] h3").first().textContent())!, /^Phantom, One · ID P1/);
    const last = (await volumes.last().locator("strong").textContent())!;
    await volumes.last().click();
    await viewer.ready();
    assert.ok((await viewer.page.locator("[data-test=identity]").textContent())!.includes(last), last);
    // Its project opens the same series again.
    await viewer.page.click("[data-test=another]");
    await viewer.page.locator("[data-test=recent]").first().click();
    await viewer.ready();
    assert.ok((await viewer.page.locator("[data-test=identity]").textContent())!.includes(last), last);
    assert.deepEqual(viewer.complaints, []);
    await viewer.page.close();
  });

  test("opens what lies in a folder whose name has spaces", async () => {
    mkdirSync(join(home, "study", "my scans + old"), { recursive: true });
    copyFileSync(join(home, "scans", "ball.nii"), join(home, "study", "my scans + old", "a ball.nii"));
    const viewer = await visit();
    await goHome(viewer);
    await enter(viewer, "study");
    await enter(viewer, "my scans + old");
    await entry(viewer, "a ball.nii").click();
    await viewer.ready();
    assert.match((await viewer.page.locator(".file-title").textContent())!, /^a ball/);
    await viewer.page.close();
  });

  test("is where a folder of several series leads, named on the command line", async (t) => {
    if (!process.env["KONTUR_DICOM_SERIES"]) return t.skip("no script that writes DICOM files");
    const viewer = await visit(join(home, "study"));
    await viewer.page.locator("[data-test=volume]").first().waitFor();
    await viewer.page.close();
  });

  test("asks which of two transforms that differ counts, and the project remembers", async () => {
    const file = readFileSync(join(home, "scans", "ball.nii"));
    file.writeInt16LE(1, 252); // the qform counts, too: no rotation, 7 mm from where the sform is
    [2, 2, 4].forEach((spacing, axis) => file.writeFloatLE(spacing, 80 + 4 * axis));
    [0, 1, 2].forEach((axis) => file.writeFloatLE(file.readFloatLE(292 + 16 * axis) + 7, 268 + 4 * axis));
    writeFileSync(join(home, "study", "torn.nii"), file);
    const viewer = await visit();
    await goHome(viewer);
    await enter(viewer, "study");
    await entry(viewer, "torn.nii").click();
    await viewer.page.locator("[data-test=start-problem]", { hasText: "in two ways where it lies" }).waitFor();
    await viewer.page.click("[data-test=by-qform]");
    await viewer.ready();
    await viewer.page.click("[data-test=another]");
    await viewer.page.locator("[data-test=recent]", { hasText: "torn.nii" }).click();
    await viewer.ready();
    assert.match(await viewer.page.title(), /^torn\.nii/);
    assert.deepEqual(viewer.complaints, []);
    await viewer.page.close();
  });

  test("offers to resample a series whose slices lie unevenly, and the project remembers", async (t) => {
    const python = process.env["KONTUR_TEST_PYTHON"];
    const script = process.env["KONTUR_DICOM_SERIES"];
    if (!python || !script) return t.skip("no script that writes DICOM files");
    const made: { status: number | null; stderr: string } = spawnSync(python, [script, "missing", join(home, "gaps")], { encoding: "utf8" });
    assert.equal(made.status, 0, made.stderr);
    const viewer = await visit();
    await goHome(viewer);
    await enter(viewer, "gaps");
    await viewer.page.locator("[data-test=volume]").click();
    const problem = viewer.page.locator("[data-test=start-problem]", { hasText: "slices are missing between z = 105 and 112.5" });
    await problem.waitFor();
    assert.doesNotMatch((await problem.textContent())!, /--/);
    await viewer.page.keyboard.press("Enter"); // on the button, which has the keyboard
    await viewer.ready();
    assert.match((await viewer.pane("axial").locator(".slice-number").textContent())!, /\/ 9$/);
    await viewer.page.click("[data-test=another]");
    await viewer.page.locator("[data-test=recent]").first().click();
    await viewer.ready();
    assert.deepEqual(viewer.complaints, []);
    await viewer.page.close();
  });

  test("asks which frame of a file with several is to be opened", async () => {
    writeFrames(join(home, "study", "beating.nii"));
    const viewer = await visit();
    await goHome(viewer);
    await enter(viewer, "study");
    await entry(viewer, "beating.nii").click();
    await viewer.page.locator("[data-test=start-problem]", { hasText: "has 3 frames. Which one is to be opened?" }).waitFor();
    await viewer.type(viewer.page.locator("[data-test=frame]"), "7");
    await viewer.page.keyboard.press("Enter");
    await viewer.page.locator("[data-test=start-problem]", { hasText: "There is no frame 7; frames are numbered from 1 to 3" }).waitFor();
    await viewer.type(viewer.page.locator("[data-test=frame]"), "3");
    await viewer.page.waitForSelector("[data-test=frame-picture][data-frame='2'][data-painted=true]");
    await viewer.page.click("[data-test=frame-open]");
    await viewer.ready();
    assert.deepEqual(viewer.complaints, []);
  });

  test("opens the images of a folder as frames over time, and says where they are none", async () => {
    const phases = join(home, "scans", "old", "phases");
    mkdirSync(phases);
    [2, 10, 1].forEach((n) => copyFileSync(join(home, "scans", "ball.nii"), join(phases, `phase ${n}.nii`)));
    const viewer = await visit();
    const { page } = viewer;
    await viewer.type(page.locator("[data-test=path]"), phases);
    await page.keyboard.press("Enter");
    await page.locator("[data-test=frames]", { hasText: "These 3 images as frames over time" }).waitFor();
    await picture(viewer, "folder_of_frames_offered");
    await page.click("[data-test=frames]");
    await page.locator("[data-test=start-problem]", { hasText: "has 3 frames. Which one is to be opened?" }).waitFor();
    await viewer.type(page.locator("[data-test=frame]"), "2");
    await page.waitForSelector("[data-test=frame-picture][data-frame='1'][data-painted=true]");
    await page.keyboard.press("Enter");
    await viewer.ready();
    assert.equal(await page.locator("[data-test=time-frame]").textContent(), "2 / 3");
    await page.keyboard.press(".");
    assert.equal(await page.locator("[data-test=time-frame]").textContent(), "3 / 3");
    await viewer.slicesShown();
    await picture(viewer, "folder_of_frames");
    await page.click("[data-test=another]");
    copyFileSync(join(home, "study", "beating.nii"), join(phases, "phase 3.nii"));
    await viewer.type(page.locator("[data-test=path]"), phases);
    await page.keyboard.press("Enter");
    await page.locator("[data-test=frames]", { hasText: "These 4 images" }).click();
    await page.locator("[data-test=start-problem]", { hasText: "phase 3.nii has 3 frames itself" }).waitFor();
    assert.deepEqual(viewer.complaints, []);
    await page.close();
  });
});
