// SPDX-License-Identifier: Apache-2.0
// Open lines: drawn by hand and by clicks, opened and closed, turned to the other side, led on, proposed, kept.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { beforeEach, test } from "node:test";
import { BALL_ML, BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

interface Drawn {
  planes: { contours: { closed: boolean; inside?: string; points: unknown[][] }[] }[];
}

const visits = new BallVisits();
let viewer: Viewer;

beforeEach(async () => {
  viewer = await visits.next();
});

const open = () => viewer.page.locator(".contour-row [data-test=open]");
const waitForOpen = (count: number) =>
  viewer.page.waitForFunction((wanted) => document.querySelectorAll(".contour-row [data-test=open]").length === wanted, count);
const notice = (words: string) => viewer.page.locator(".notice", { hasText: words });
const drawn = async () =>
  (JSON.parse((await viewer.export("contours.json")).bytes.toString()) as Drawn).planes.flatMap(({ contours }) => contours).filter(({ closed }) => !closed);

/** Half of the ball's border on a view, its upper one, from the right to the left. */
async function upperHalf(view: string, radius_mm = BALL_RADIUS_MM): Promise<[number, number][]> {
  const radius = await viewer.pixels(view, radius_mm);
  return circle(radius, 48)
    .slice(0, 25)
    .map(([x, y]) => [x, -y]);
}

/** One stroke along the upper half, which Shift + U leaves open; then closed contours are drawn again. */
async function drawHalf(view: string, contours: number): Promise<void> {
  await viewer.page.keyboard.press("Shift+U");
  await viewer.page.keyboard.press("f");
  await viewer.drag(view, await upperHalf(view));
  await viewer.page.keyboard.press("Shift+U");
  await viewer.waitForContours(contours);
  await viewer.saved();
}

test("a stroke by hand stays open where the toolbar says so, and the surface passes it", async () => {
  const { page } = viewer;
  await viewer.drawBall("axial", 1);
  const toggle = page.locator("[data-test=open-lines]");
  await toggle.click();
  assert.equal(await toggle.getAttribute("aria-pressed"), "true");
  await page.keyboard.press("f");
  await page.locator(".hint", { hasText: "releasing ends the open line" }).waitFor();
  await viewer.drag("coronal", await upperHalf("coronal"));
  await viewer.waitForContours(2);
  await waitForOpen(1);
  await viewer.surfaceShown();
  const volume = await viewer.volume();
  assert.ok(Math.abs(volume / BALL_ML - 1) < 0.15, `${volume} ml of ${BALL_ML}`);
  await viewer.drag("sagittal", circle(await viewer.pixels("sagittal", BALL_RADIUS_MM), 36));
  await viewer.waitForContours(3);
  assert.equal(await open().count(), 1, "a stroke that comes back to where it began is a contour all the same");
  await page.keyboard.press("Control+z");
  await viewer.waitForContours(2);
  await page.keyboard.press("Control+z");
  await viewer.waitForContours(1);
  await page.keyboard.press("Control+Shift+Z");
  await waitForOpen(1);
  const [line] = await drawn();
  assert.ok(line!.points.length > 10 && line!.inside === undefined);
  assert.deepEqual(viewer.complaints, []);
});

test("U ends what is clicked as an open line, a double click does where lines stay open", async () => {
  const { page } = viewer;
  await viewer.drawBall("axial", 1);
  await page.keyboard.press("s");
  const places = (await upperHalf("coronal")).filter((_, i) => i % 6 === 0);
  for (const place of places) await viewer.click("coronal", ...place);
  await page.keyboard.press("u");
  await viewer.waitForContours(2);
  await waitForOpen(1);
  await page.keyboard.press("Shift+U");
  const half = (await upperHalf("sagittal")).filter((_, i) => i % 6 === 0);
  for (const place of half.slice(0, -1)) await viewer.click("sagittal", ...place);
  await page.mouse.dblclick(...(await viewer.at("sagittal", ...half.at(-1)!)));
  await viewer.waitForContours(3);
  await waitForOpen(2);
  assert.equal((await drawn()).length, 2);
  await viewer.saved();
  await viewer.click("sagittal", 0, 0);
  await page.keyboard.press("u");
  await notice("An open line needs at least two points").waitFor();
  assert.deepEqual(viewer.complaints, []);
});

test("a contour is opened and an open line closed by a key or a button, and it can be no hole", async () => {
  const { page } = viewer;
  await viewer.drawBall("axial", 1);
  await page.keyboard.press("u");
  await waitForOpen(1);
  await viewer.waitForStep("undo", "Open a contour");
  await page.keyboard.press("h");
  await notice("An open line encloses nothing").waitFor();
  await page.click("[data-test=close-line]");
  await waitForOpen(0);
  await viewer.waitForStep("undo", "Close a line");
  await page.click("[data-test=open-contour]");
  await waitForOpen(1);
  await page.keyboard.press("Control+z");
  await waitForOpen(0);
  assert.deepEqual(viewer.complaints, []);
});

test("the side that was found is turned by a button, and found again", async () => {
  const { page } = viewer;
  await viewer.drawBall("axial", 1);
  await drawHalf("coronal", 2);
  await viewer.surfaceShown();
  const before = await viewer.volume();
  await page.click("[data-test=other-side]");
  await viewer.waitForStep("undo", "Tell the side of a line");
  await viewer.surfaceShown();
  const [turned] = await drawn();
  assert.ok(turned!.inside === "left" || turned!.inside === "right");
  await page.click("[data-test=find-side]");
  await page.waitForSelector("[data-test=find-side]", { state: "detached" });
  await viewer.surfaceShown();
  assert.ok(Math.abs((await viewer.volume()) / before - 1) < 0.01);
  assert.equal((await drawn())[0]!.inside, undefined);
  assert.deepEqual(viewer.complaints, []);
});

test("an end is dragged, the gap is not taken for the line, and a stroke leads it on", async () => {
  const { page } = viewer;
  await viewer.drawBall("axial", 1);
  await drawHalf("coronal", 2);
  await viewer.surfaceShown();
  const radius = await viewer.pixels("coronal", BALL_RADIUS_MM);
  await page.keyboard.press("v");
  await viewer.drag("coronal", [
    [radius, 0],
    [radius + 4, 0],
    [radius + 12, 6],
  ]);
  await viewer.waitForStep("undo", "Move a point");
  await page.keyboard.press("Control+z");
  await viewer.waitForStep("redo", "Move a point");
  await viewer.surfaceShown();
  await page.keyboard.press("r");
  const on = circle(radius, 48).slice(0, 8); // below the right end
  await viewer.drag("coronal", on);
  await viewer.waitForStep("undo", "Redraw a part");
  const [line] = await drawn();
  assert.ok(line!.points.length > 10);
  await viewer.saved();
  await page.keyboard.press("p");
  await viewer.drag("coronal", [
    [0, -radius + 40],
    [0, -radius + 20],
    [0, -radius + 14],
  ]);
  await viewer.waitForStep("undo", "Push a contour");
  assert.equal(await open().count(), 1);
  assert.deepEqual(viewer.complaints, []);
});

test("on the next slice only what runs along the line is proposed, and stays open", async () => {
  const { page } = viewer;
  await viewer.drawBall("axial", 1);
  await drawHalf("coronal", 2);
  await viewer.surfaceShown();
  await page.keyboard.press("c");
  await page.locator(".hint", { hasText: "A proposal: Enter" }).waitFor();
  await page.keyboard.press("Enter");
  await viewer.waitForContours(3);
  await waitForOpen(2);
  await viewer.waitForStep("undo", "Accept the proposal");
  assert.deepEqual(viewer.complaints, []);
});

test("open lines of a file come in, and are there after a restart", async () => {
  await viewer.drawBall("axial", 1);
  await drawHalf("coronal", 2);
  const file = join(visits.folder.path, "half.json");
  writeFileSync(file, (await viewer.export("contours.json")).bytes);
  await viewer.import(file);
  await viewer.waitForContours(4);
  await waitForOpen(2);
  await viewer.saved();
  await viewer.page.reload();
  await viewer.ready();
  await waitForOpen(2);
  assert.deepEqual(viewer.complaints, []);
});
