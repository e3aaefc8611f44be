// SPDX-License-Identifier: Apache-2.0
// The viewer's steps of docs/guide.md, clicked as they are written there. Where the liver's border lies, the phantom's truth tells.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { cleanUp, KONTUR, run, Server, temporaryFolder, Viewer } from "./support";

/** Change the steps below with the guide, and what is done for them. */
const STEPS = [
  "Choose *Live-wire* (`L`) and click along the border of the liver in the axial view; the line follows the edge between your clicks. Close the contour by a click on its first point.",
  "The surface appears in the 3D view, its outline in the others. In the coronal view, draw a second contour through the middle of the first.",
  "Scroll (wheel) to where the outline leaves the liver, and draw one more contour there. Repeat until you are content.",
  "*Export*: the mask, the surface, the contours or a picture.",
] as const;

type Vec3 = [number, number, number];
const plus = (a: Vec3, b: Vec3, factor = 1): Vec3 => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
const dot = (a: Vec3, b: Vec3) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const scaled = (a: Vec3, factor: number): Vec3 => [a[0] * factor, a[1] * factor, a[2] * factor];

const folder = temporaryFolder();
const truth = join(folder.path, "phantom", "abdomen_truth_liver.nii.gz");
let server: Server;
let browser: Browser;
let viewer: Viewer;

before(async () => {
  run("phantom", join(folder.path, "phantom"), "--scan", "abdomen", "--quiet");
  server = await Server.start(folder.path, "phantom");
  browser = await launch();
  viewer = await Viewer.open(browser, server.address);
  await viewer.closeHint();
});

cleanUp(folder, () => [browser, server]);

/** What the status line says of a place of a view: mm in LPS. */
async function placeAt(view: string, right: number, down: number): Promise<Vec3> {
  const cursor = viewer.page.locator("[data-test=cursor]");
  await viewer.page.mouse.move(...(await viewer.at(view, right + 1, down)));
  const before = await cursor.textContent();
  await viewer.page.mouse.move(...(await viewer.at(view, right, down)));
  await viewer.page.waitForFunction((text) => document.querySelector("[data-test=cursor]")!.textContent !== text, before);
  const words = [...(await cursor.textContent())!.matchAll(/([LRPASI]) (\d+\.\d)/g)];
  assert.equal(words.length, 3);
  return words.map(([, letter, mm]) => ("LPS".includes(letter!) ? 1 : -1) * Number(mm)) as Vec3;
}

/** A view's plane in mm: its middle, and what a pixel to the right and downwards are. */
async function planeOf(view: string) {
  const far = 100;
  const origin = await placeAt(view, 0, 0);
  const right = scaled(plus(await placeAt(view, far, 0), origin, -1), 1 / far);
  const down = scaled(plus(await placeAt(view, 0, far), origin, -1), 1 / far);
  return { origin, right, down };
}

/** Where the liver's border lies in a view, in pixels from its middle: `count` places of its longest line. */
async function border(view: string, count: number): Promise<[number, number][]> {
  const { origin, right, down } = await planeOf(view);
  const [planes, lines] = [join(folder.path, "plane.json"), join(folder.path, "lines.json")];
  writeFileSync(planes, JSON.stringify({ frame: "LPS mm", planes: [{ origin, normal: cross(right, down) }] }));
  run("trace", truth, "--planes", planes, "--output", lines, "--quiet");
  const found = JSON.parse(readFileSync(lines, "utf8")) as { planes: { contours: { points: Vec3[] }[] }[] };
  const points = found.planes
    .flatMap((plane) => plane.contours)
    .map((contour) => contour.points)
    .sort((a, b) => b.length - a.length)[0];
  assert.ok(points, `the ${view} view shows no liver`);
  return Array.from({ length: count }, (_, i) => {
    const from = plus(points[Math.floor((i * points.length) / count)]!, origin, -1);
    return [dot(from, right) / dot(right, right), dot(from, down) / dot(down, down)];
  });
}

/** Clicks along the liver's border and on the first point again. */
async function drawLiver(view: string, clicks = 16): Promise<void> {
  const before = await viewer.contours();
  const places = await border(view, clicks);
  for (const place of [...places, places[0]!]) await viewer.click(view, ...place);
  await viewer.waitForContours(before + 1);
  await viewer.surfaceShown();
}

async function agreement(): Promise<number> {
  const path = join(folder.path, "drawn.nii.gz");
  writeFileSync(path, (await viewer.export("mask.nii.gz")).bytes);
  const { stdout } = spawnSync(KONTUR, ["compare", path, truth, "--json"], { encoding: "utf8" });
  return (JSON.parse(stdout) as { dice: number }).dice;
}

describe("the guide's steps in the viewer", () => {
  test("are those that this test does", () => {
    const text = readFileSync(process.env["KONTUR_GUIDE"]!, "utf8");
    const section = text.split("\n## ").find((part) => part.startsWith("In the viewer"))!;
    const steps = [...section.matchAll(/^\d\. ([^]*?)(?=\n\d\. |\n\n)/gm)].map(([, step]) => step!.replace(/\s+/g, " "));
    assert.deepEqual(steps, STEPS);
  });

  test(STEPS[0], async () => {
    await viewer.page.click("text=Live-wire");
    await drawLiver("axial");
    assert.equal(await viewer.page.locator(".contour-row[data-kind=livewire]").count(), 1);
  });

  test(STEPS[1], async () => {
    const isAmber = (r: number, g: number, b: number) => r > 90 && r > 1.25 * g && g > 1.3 * b;
    assert.ok((await viewer.countPixels("surface", isAmber)) > 2000, "the 3D view shows the surface");
    const places = await border("axial", 60);
    const middle = places.reduce(([x, y], [right, down]) => [x + right / places.length, y + down / places.length] as [number, number], [0, 0]);
    await viewer.page.keyboard.down("Shift");
    await viewer.page.mouse.move(...(await viewer.at("axial", ...middle)));
    await viewer.page.keyboard.up("Shift");
    await viewer.slicesShown();
    await drawLiver("coronal");
  });

  test(STEPS[2], async () => {
    const first = await agreement();
    await viewer.page.mouse.move(...(await viewer.at("axial", 0, 0)));
    for (let n = 0; n < 10; ++n) await viewer.page.mouse.wheel(0, 120);
    await viewer.slicesShown();
    await drawLiver("axial");
    const second = await agreement();
    assert.ok(second > first && second > 0.95, `Dice ${first} after two contours, ${second} after three`);
  });

  test(STEPS[3], async () => {
    for (const [name, start] of [
      ["mask.nii.gz", "\x1f\x8b"],
      ["mesh.stl", "kontur"],
      ["contours.json", "{"],
      ["picture.png", "\x89PNG"],
    ] as const) {
      const { bytes } = await viewer.export(name);
      assert.equal(bytes.subarray(0, start.length).toString("latin1"), start, name);
    }
    assert.deepEqual(viewer.complaints, []);
  });
});
