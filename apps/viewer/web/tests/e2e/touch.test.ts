// SPDX-License-Identifier: Apache-2.0
// Fingers on the slices, as Chromium's DevTools send them to the page.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import type { CDPSession } from "playwright-core";
import { BROWSER } from "./browsers";
import { BALL_RADIUS_MM, BallVisits, circle, type Viewer } from "./support";

type Place = [number, number];

const visits = new BallVisits();
let viewer: Viewer;
let input: CDPSession;

async function touch(type: "touchStart" | "touchMove" | "touchEnd", view: string, ...places: Place[]): Promise<void> {
  const at = await Promise.all(places.map(([right, down]) => viewer.at(view, right, down)));
  await input.send("Input.dispatchTouchEvent", { type, touchPoints: at.map(([x, y], id) => ({ x, y, id })) });
}

/** One finger along these places. */
async function drag(view: string, ...way: Place[]): Promise<void> {
  await touch("touchStart", view, way[0]!);
  for (const place of way.slice(1)) await touch("touchMove", view, place);
  await touch("touchEnd", view);
}

const tap = (view: string, place: Place) => drag(view, place);

/** Two fingers from their first places to their last ones, one set down after the other. */
async function two(view: string, first: [Place, Place], last: [Place, Place], steps = 12): Promise<void> {
  const between = (a: Place, b: Place, t: number): Place => [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
  await touch("touchStart", view, first[0]);
  await touch("touchStart", view, ...first);
  for (let i = 1; i <= steps; ++i) await touch("touchMove", view, between(first[0], last[0], i / steps), between(first[1], last[1], i / steps));
  await touch("touchMove", view, last[0]);
  await touch("touchEnd", view);
}

const window = async () =>
  (await viewer.page.locator(".toolbar .number").all()).reduce(
    async (all, field) => [...(await all), Number(await field.inputValue())],
    Promise.resolve<number[]>([]),
  );
const slices = () => Promise.all(["axial", "sagittal", "coronal"].map((view) => viewer.slice(view)));

describe("fingers", { skip: BROWSER === "chromium" ? false : "touches need Chromium's DevTools" }, () => {
  beforeEach(async () => {
    viewer = await visits.next();
    input = await viewer.page.context().newCDPSession(viewer.page);
  });

  test("that part zoom, and neither move a plane nor leave a slice, whatever the tool", async () => {
    const before = await slices();
    const scale = await viewer.pixels("axial", 1);
    await two(
      "axial",
      [
        [-20, 10],
        [30, 10],
      ],
      [
        [-70, 10],
        [80, 10],
      ],
    );
    await viewer.slicesShown();
    const zoom = (await viewer.pixels("axial", 1)) / scale;
    assert.ok(Math.abs(zoom - 3) < 0.05, `${zoom} times as large`);
    assert.deepEqual(await slices(), before);
    await two(
      "axial",
      [
        [-70, 10],
        [80, 10],
      ],
      [
        [-20, 10],
        [30, 10],
      ],
    );
    assert.ok(Math.abs((await viewer.pixels("axial", 1)) / scale - 1) < 0.05);
  });

  test("that go down together scroll on, and up back again", async () => {
    const before = await slices();
    await two(
      "axial",
      [
        [-30, -60],
        [20, -60],
      ],
      [
        [-30, 40],
        [20, 40],
      ],
    );
    const [axial, ...others] = await slices();
    assert.ok(axial! > before[0]! + 3, `slice ${axial}, and before ${before[0]}`);
    assert.deepEqual(others, before.slice(1));
    await two(
      "axial",
      [
        [-30, 40],
        [20, 40],
      ],
      [
        [-30, -60],
        [20, -60],
      ],
    );
    assert.deepEqual(await slices(), before);
  });

  test("leave no contour where a stroke turns into a pinch, and one draws a whole one", async () => {
    const { page } = viewer;
    await page.keyboard.press("f");
    await touch("touchStart", "axial", [-50, 0]);
    await touch("touchMove", "axial", [-44, 4]);
    await touch("touchMove", "axial", [-36, 8]);
    await touch("touchStart", "axial", [-36, 8], [40, 0]);
    for (let i = 1; i <= 10; ++i) await touch("touchMove", "axial", [-36 - 3 * i, 8], [40 + 3 * i, 0]);
    await touch("touchEnd", "axial");
    await viewer.saved();
    assert.equal(await viewer.contours(), 0);
    assert.equal(await page.locator(".notice").count(), 0, "nor is it taken for a slip");
    await page.keyboard.press("Home");
    await drag("axial", ...circle(await viewer.pixels("axial", BALL_RADIUS_MM), 36));
    await viewer.waitForContours(1);
    await viewer.surfaceShown();
    assert.ok((await viewer.volume()) > 200, `${await viewer.volume()} ml`);
  });

  test("tap the points of a spline, and the first one again, though not to the pixel", async () => {
    await viewer.page.keyboard.press("s");
    const places = circle(await viewer.pixels("axial", BALL_RADIUS_MM), 6).slice(0, -1);
    for (const place of places) await tap("axial", place);
    await tap("axial", [places[0]![0] + 14, places[0]![1] + 10]);
    await viewer.waitForContours(1);
  });

  test("drag a computed outline, and a contour is made of it", async () => {
    const { page } = viewer;
    const radius = await viewer.pixels("axial", BALL_RADIUS_MM);
    await page.keyboard.press("f");
    for (const [n, view] of ["axial", "coronal"].entries()) {
      await drag(view, ...circle(await viewer.pixels(view, BALL_RADIUS_MM), 36));
      await viewer.waitForContours(n + 1);
    }
    await viewer.surfaceShown();
    await page.keyboard.press("v");
    await two(
      "axial",
      [
        [-30, -50],
        [20, -50],
      ],
      [
        [-30, -20],
        [20, -20],
      ],
    ); // to a slice without a contour
    await viewer.slicesShown();
    await viewer.surfaceShown();
    assert.equal(await viewer.contours(), 2);
    const mm = 4 * Math.abs((await viewer.slice("axial")) - 20.5);
    const seen = (radius * Math.sqrt(BALL_RADIUS_MM ** 2 - mm ** 2)) / BALL_RADIUS_MM;
    await drag("axial", [seen + 9, 0], [seen + 20, 0], [seen + 30, 0]); // nine pixels beside it
    await viewer.waitForContours(3);
  });

  test("that rest change the window, with a word of how", async () => {
    const before = await window();
    await touch("touchStart", "axial", [0, 30]);
    await viewer.page.locator(".hint", { hasText: "Drag for the window" }).waitFor();
    for (let i = 1; i <= 8; ++i) await touch("touchMove", "axial", [10 * i, 30]);
    await touch("touchEnd", "axial");
    const [center, width] = await window();
    assert.equal(center, before[0]); // straight to the right
    assert.ok(width! > before[1]!, `width ${width}, and before ${before[1]}`);
    await viewer.page.locator(".hint", { hasText: "Drag for the window" }).waitFor({ state: "hidden" });
  });

  test("turn the 3D view, zoom it, and do not scroll the page", async () => {
    const { page } = viewer;
    const picture = async () => (await viewer.pane("surface").screenshot()).toString("base64");
    const first = await picture();
    await drag("surface", [-40, 0], [0, 10], [40, 20]);
    await page.waitForTimeout(600);
    const turned = await picture();
    assert.notEqual(turned, first);
    await two(
      "surface",
      [
        [-20, 0],
        [20, 0],
      ],
      [
        [-60, 0],
        [60, 0],
      ],
    );
    await page.waitForTimeout(600);
    assert.notEqual(await picture(), turned);
    assert.deepEqual(await page.evaluate(() => [scrollX, scrollY, visualViewport!.scale]), [0, 0, 1]);
  });
});
