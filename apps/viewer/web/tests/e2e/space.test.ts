// SPDX-License-Identifier: Apache-2.0
// The 3D view: what it is framed on, its cube and its marks.
import assert from "node:assert/strict";
import { describe, test } from "node:test";
import { BALL_RADIUS_MM, BallVisits, circle, type Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

/** Places of the 3D view, from its corner, whose colour is like this one. */
async function placesLike(r: number, g: number, b: number, tolerance: number): Promise<[number, number][]> {
  const { width, colors } = await viewer.decoded(await viewer.pane("surface").screenshot());
  const isLike = (color: number): boolean => [r, g, b].every((value, channel) => Math.abs(((color >> (8 * channel)) & 255) - value) <= tolerance);
  return colors.flatMap((color, i): [number, number][] => (isLike(color) ? [[i % width, Math.floor(i / width)]] : []));
}

const isDrawn = () => viewer.page.waitForTimeout(900); // a fine frame comes when all rests

let opened: Promise<void> | null = null;
const open = () => (opened ??= prepare());

async function prepare(): Promise<void> {
  viewer = await visits.next();
  await viewer.page.keyboard.press("f");
  await viewer.drag("axial", circle(await viewer.pixels("axial", BALL_RADIUS_MM), 48));
  await viewer.waitForContours(1);
  const wide = circle(1, 48).map(([x, y]): [number, number] => [x, y]);
  const [radius, other] = [await viewer.pixels("coronal", BALL_RADIUS_MM), await viewer.pixels("coronal", BALL_RADIUS_MM - 9)];
  await viewer.drag(
    "coronal",
    wide.map(([x, y]) => [x * (x > 0 ? other : radius), y * radius]),
  ); // contradicts the first one on the left side
  await viewer.waitForContours(2);
  await viewer.surfaceShown();
  await isDrawn();
}

describe("the 3D view", () => {
  test("is framed on the surface, which fills most of it", async () => {
    await open();
    const box = (await viewer.pane("surface").boundingBox())!;
    const color = [0xe6, 0x9f, 0x00]; // of the first structure, in some light
    const seen = (await placesLike(color[0]! * 0.75, color[1]! * 0.75, 25, 45)).map(([x]) => x);
    const width = Math.max(...seen) - Math.min(...seen);
    assert.ok(width > 0.6 * Math.min(box.width, box.height), `${width} of ${box.width} x ${box.height} pixels`);
  });

  test("has a scale that is true", async () => {
    await open();
    const bar = viewer.page.locator(".surface-scale");
    const mm = { cm: 10, mm: 1 }[(await bar.textContent())!.split(" ")[1] as "cm" | "mm"] * Number.parseFloat((await bar.textContent())!);
    const mmPerPixel = mm / (await bar.boundingBox())!.width;
    await viewer.page.click('.letter-button[title="From above"]');
    await isDrawn();
    const seen = (await placesLike(0xe6 * 0.75, 0x9f * 0.75, 25, 45)).map(([x]) => x);
    const width = (Math.max(...seen) - Math.min(...seen)) * mmPerPixel;
    assert.ok(Math.abs(width - 2 * BALL_RADIUS_MM) < 10, `the ball is ${width} mm wide`);
  });

  test("turns to the side of the cube that is clicked", async () => {
    await open();
    const { page } = viewer;
    await page.click('.letter-button[title="From the front"]');
    await isDrawn();
    const cube = (await page.locator(".cube-place").boundingBox())!;
    const front = (await page.locator("[data-side=A]").boundingBox())!;
    assert.ok(Math.abs(front.width - cube.width) < 2 && Math.abs(front.height - cube.height) < 2, "the front faces the viewer");
    await page.mouse.move(...(await viewer.at("surface", 0, 40)));
    await page.mouse.down();
    await page.mouse.move(...(await viewer.at("surface", -60, 80)), { steps: 6 });
    await page.mouse.up();
    await isDrawn();
    const side = (await page.locator("[data-side=L]").boundingBox())!;
    assert.ok(side.width > 4 && side.width < cube.width, `turned, the left side is ${side.width} pixels wide`);
    await page.mouse.click(side.x + side.width / 2, side.y + side.height / 2);
    await isDrawn();
    const left = (await page.locator("[data-side=L]").boundingBox())!;
    assert.ok(Math.abs(left.width - cube.width) < 2 && Math.abs(left.height - cube.height) < 2, "the left side faces the viewer");
  });

  test("goes to a conflict by a click on its mark, which hides little of the surface", async () => {
    await open();
    const { page } = viewer;
    await page.keyboard.press("Home");
    await viewer.slicesShown();
    await page.click('.letter-button[title="From the front"]');
    await isDrawn();
    const marks = await placesLike(248, 142, 56, 14);
    assert.ok(marks.length > 10 && marks.length < 400, `${marks.length} pixels`);
    const before = [await viewer.slice("sagittal"), await viewer.slice("axial")];
    const [x, y] = marks[Math.floor(marks.length / 2)]!;
    const box = (await viewer.pane("surface").boundingBox())!;
    await page.mouse.move(box.x + x, box.y + y);
    assert.equal(await page.locator(".surface-canvas").evaluate((canvas) => canvas.style.cursor), "pointer");
    await page.mouse.click(box.x + x, box.y + y);
    await viewer.slicesShown();
    const after = [await viewer.slice("sagittal"), await viewer.slice("axial")];
    assert.ok(Math.abs(after[0]! - before[0]!) > 8, `sagittal slice ${before[0]} to ${after[0]}`);
    assert.deepEqual(viewer.complaints, []);
  });
});
