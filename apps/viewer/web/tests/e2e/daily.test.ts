// SPDX-License-Identifier: Apache-2.0
// What people met who worked with the page for an hour: by real pointer and keys.
import assert from "node:assert/strict";
import { rmSync, writeFileSync, renameSync, mkdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { BALL_ML, BALL_RADIUS_MM, circle, Server, temporaryFolder, Viewer, writeBallImage } from "./support";

const folder = temporaryFolder();
const pictures = process.env["KONTUR_PICTURES"]; // where to keep what the page looked like
let browser: Browser;
const servers: Server[] = [];

before(async () => {
  writeBallImage(join(folder.path, "ball.nii"));
  browser = await launch();
});
after(async () => {
  for (const server of servers) await server.end();
  await browser.close();
  folder.remove();
});

let visits = 0;
/** With a project of its own, and the layout of a first visit: another test may have left one view alone. */
async function visit(...words: string[]): Promise<Viewer> {
  await servers.pop()?.end();
  rmSync(join(folder.path, "kontur", "arrangements.json"), { force: true });
  const project = join(folder.path, `it's visit ${++visits}.kontur`);
  const server = await Server.start(folder.path, ...(words.length > 0 ? words : [join(folder.path, "ball.nii")]), "--project", project);
  servers.push(server);
  return Viewer.open(browser, server.address);
}

async function picture(viewer: Viewer, name: string): Promise<void> {
  if (pictures) await viewer.page.screenshot({ path: join(pictures, `${name}.png`) });
}

test("the hint has the keyboard, and Esc takes it away", async () => {
  const viewer = await visit();
  const { page } = viewer;
  await page.waitForFunction(() => document.activeElement?.matches("[data-test=hint-close]"));
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("[data-test=first-hint]").count(), 0);
  await page.reload();
  await viewer.ready();
  await page.close();
});

test("+ asks for the name at once, and what is typed calls no tool", async () => {
  const viewer = await visit();
  const { page } = viewer;
  await viewer.closeHint();
  const tool = () => page.locator("[data-test^=tool-][aria-pressed=true]").getAttribute("data-test");
  const before = await tool();
  await viewer.addStructure("Spleen");
  assert.equal(await tool(), before);
  await picture(viewer, "named");
  assert.deepEqual(viewer.complaints, []);
  await page.close();
});

test("a stroke that begins on the title of a slice is drawn, and a double click there still enlarges", async () => {
  const viewer = await visit();
  const { page } = viewer;
  await viewer.closeHint();
  await page.keyboard.press("f");
  const title = (await page.locator("[data-view=axial] .pane-title").boundingBox())!;
  const [x, y] = [title.x + title.width / 2, title.y + title.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (const [right, down] of circle(60, 24)) await page.mouse.move(x + 60 + right, y + 2 + 60 + down);
  await page.mouse.move(x, y);
  await page.mouse.up();
  await viewer.waitForContours(1);
  await page.mouse.dblclick(x, y);
  await page.waitForSelector("main.stage[data-layout=single]");
  await viewer.waitForContours(1);
  await page.close();
});

test("undo puts a structure back where it was", async () => {
  const viewer = await visit();
  const { page } = viewer;
  await viewer.closeHint();
  for (const name of ["Spleen", "Kidney"]) await viewer.addStructure(name);
  const names = () => page.locator(".structure-row .name").allTextContents();
  const order = await names();
  assert.equal(order.length, 3);
  await page.locator(".structure-row", { hasText: "Spleen" }).locator("[data-part=remove]").click();
  await page.waitForFunction(() => document.querySelectorAll(".structure-row").length === 2);
  await page.keyboard.press("Control+z");
  await page.waitForFunction(() => document.querySelectorAll(".structure-row").length === 3);
  assert.deepEqual(await names(), order);
  await page.close();
});

test("one structure alone is shown by a button, and its surface can be seen through", async () => {
  const viewer = await visit();
  const { page } = viewer;
  await viewer.closeHint();
  await viewer.drawBall("axial");
  await viewer.addStructure("Spleen");
  await page.click("[data-test=show-only]");
  await viewer.waitForStep("undo", "Show only Spleen");
  await page.waitForSelector(".contour-row.off");
  await page.click("[data-test=show-only]");
  await viewer.waitForStep("undo", "Show all structures");
  await page.locator(".structure-row .name").first().click();
  const slider = page.locator("[data-test=structure-opacity]");
  await slider.focus();
  await slider.press("Home");
  assert.equal(await slider.inputValue(), "0.1");
  await viewer.surfaceShown();
  await picture(viewer, "opacity");
  await viewer.saved();
  await page.waitForTimeout(1000); // longer than the page waits before it saves its own state
  await page.reload();
  await viewer.ready();
  assert.equal(await page.locator("[data-test=structure-opacity]").inputValue(), "0.1");
  await page.close();
});

test("what is drawn stays in sight of the list, and no heading hides another", async () => {
  const viewer = await visit();
  const { page } = viewer;
  await page.setViewportSize({ width: 1440, height: 900 });
  await viewer.closeHint();
  await page.keyboard.press("f");
  const radius = await viewer.pixels("axial", 20);
  for (let i = 0; i < 14; ++i) {
    await page.keyboard.press("ArrowUp");
    await viewer.slicesShown();
    await viewer.drag("axial", circle(radius, 16));
    await viewer.waitForContours(i + 1);
  }
  await viewer.addStructure("Spleen");
  const inSight = (selector: string) =>
    page.waitForFunction((wanted) => {
      const row = document.querySelector(wanted)?.getBoundingClientRect();
      const list = document.querySelector(".structures")!.getBoundingClientRect();
      return row && row.top >= list.top - 1 && row.bottom <= list.bottom + 1 && row.bottom <= window.innerHeight;
    }, selector);
  await inSight(".structure-row.active");
  await page.keyboard.press("f");
  await viewer.drag("coronal", circle(radius, 16));
  await viewer.waitForContours(15);
  await inSight(".structure:last-of-type .contour-row");
  // The first structure's list scrolled to its middle: its row is above its headings.
  await page.locator(".structure").first().locator(".contour-row").nth(8).click();
  const tops = await page.evaluate(() => {
    const of = (selector: string) => document.querySelector(`.structure ${selector}`)!.getBoundingClientRect();
    return [of(".structure-row").bottom, of(".contour-group").top];
  });
  assert.ok(tops[0]! <= tops[1]! + 1, `the row ends at ${tops[0]}, the heading begins at ${tops[1]}`);
  await picture(viewer, "list");
  await page.close();
});

test("the browser's Back goes to the start page, and what was drawn is there when one comes again", async () => {
  const server = await Server.start(folder.path);
  servers.push(server);
  const viewer = await Viewer.openStart(browser, server.address);
  const { page } = viewer;
  await page.click("[data-test=example]");
  await viewer.ready();
  await page.goBack();
  await page.waitForSelector("[data-test=start][open]");
  await page.locator("[data-test=recent]").first().click();
  await viewer.ready();
  await page.goBack();
  await page.waitForSelector("[data-test=start][open]");
  assert.deepEqual(viewer.complaints, []);
  await page.close();
});

test("the home folder is ~, and an image that has moved is located in the page", async () => {
  const home = join(folder.path, "home");
  mkdirSync(join(home, "new"), { recursive: true });
  writeBallImage(join(home, "scan.nii"));
  const server = await Server.startAt({ HOME: home }, folder.path);
  servers.push(server);
  const viewer = await Viewer.openStart(browser, server.address);
  const { page } = viewer;
  await viewer.type(page.locator("[data-test=path]"), "~/scan.nii");
  await page.keyboard.press("Enter");
  await viewer.ready();
  await viewer.closeHint();
  await viewer.drawBall("axial");
  await page.goBack();
  await page.waitForSelector("[data-test=start][open]");
  renameSync(join(home, "scan.nii"), join(home, "new", "scan.nii"));
  await page.locator("[data-test=recent]", { hasText: "scan.nii" }).first().click();
  await page.locator("[data-test=start-problem]", { hasText: "If it has moved, show where it is now" }).waitFor();
  await page.click("[data-test=locate]");
  await picture(viewer, "moved");
  await viewer.type(page.locator("[data-test=path]"), "~/new/scan.nii");
  await page.keyboard.press("Enter");
  await viewer.ready();
  await viewer.waitForContours(1);
  await page.close();
});

test("the page says where the project lies, and the command that rescues work is whole", async () => {
  const viewer = await visit();
  const { page } = viewer;
  await viewer.closeHint();
  const saved = page.locator("[data-test=saved]");
  const path = join(folder.path, `it's visit ${visits}.kontur`);
  assert.equal(await saved.getAttribute("title"), path);
  await page
    .context()
    .grantPermissions(["clipboard-read", "clipboard-write"])
    .catch(() => undefined);
  await page.click("[data-test=copy-path]");
  await page.locator(".hint", { hasText: path }).waitFor();
  await servers.at(-1)!.end("SIGKILL");
  await page.locator(".notice.error", { hasText: `kontur open '${path.replace("'", "'\\''")}'` }).waitFor();
  await picture(viewer, "lost");
  await page.close();
});

test("the volume is that of what lies within the image, and the page says where the image cuts the object", async () => {
  // The image ends at 80 mm: of a ball of 40 mm about its last slices a good part lies beyond.
  const z = 70;
  const ring = (radius: number, at: number) =>
    Array.from({ length: 60 }, (_, i) => [radius * Math.cos((i * Math.PI) / 30), radius * Math.sin((i * Math.PI) / 30), at]);
  const upright = Array.from({ length: 80 }, (_, i) => [BALL_RADIUS_MM * Math.cos((i * Math.PI) / 40), 0, z + BALL_RADIUS_MM * Math.sin((i * Math.PI) / 40)]);
  const file = join(folder.path, "high.json");
  const drawn = (points: number[][], normal: number[]) => ({ origin: points[0], normal, contours: [{ closed: true, hole: false, points }] });
  writeFileSync(
    file,
    JSON.stringify({ version: 1, frame: "LPS mm", structure: "High", planes: [drawn(ring(BALL_RADIUS_MM, z), [0, 0, 1]), drawn(upright, [0, 1, 0])] }),
  );
  const viewer = await visit(join(folder.path, "ball.nii"), file);
  const { page } = viewer;
  await page.waitForSelector(".panel[data-stage=finished]");
  const sentence = page.locator(".warning-text", { hasText: "The image ends inside the structure" });
  await sentence.waitFor();
  const shown = await viewer.volume();
  assert.ok(shown < 0.8 * BALL_ML && shown > 0.5 * BALL_ML, `${shown} of ${BALL_ML} ml`);
  await picture(viewer, "cut");
  await page.click("[data-test=statistics-open]");
  const row = page.locator("[data-test=statistics] tr", { has: page.locator('th:text-is("Volume, ml")') });
  await row.waitFor();
  const table = Number.parseFloat((await row.locator("td").first().textContent())!);
  assert.ok(Math.abs(table - shown) < 0.02 * shown, `the panel says ${shown} ml, the table ${await row.textContent()}`);
  rmSync(file);
  await page.close();
});
