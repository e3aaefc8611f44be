// SPDX-License-Identifier: Apache-2.0
// A liver as a network leaves it, with a leak and without a pole: put right by a few strokes, in less than a minute.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, test } from "node:test";
import { gzipSync } from "node:zlib";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { cleanUp, Server, temporaryFolder, Viewer, voxels, writeImage } from "./support";

const MOST_MS = 60_000;
const LOBE_MM = [15, 0, 0] as const; // the middle of the right lobe
const folder = temporaryFolder();
const file = (name: string) => join(folder.path, name);
let browser: Browser;
let server: Server;
let viewer: Viewer;
cleanUp(folder, () => [browser, server]);

const isIn = (p: readonly number[], middle: readonly number[], radii: readonly number[]) =>
  radii.reduce((sum, radius, n) => sum + ((p[n]! - middle[n]!) / radius) ** 2, 0) < 1;
const isLiver = (p: readonly number[]) => isIn(p, LOBE_MM, [45, 38, 48]) || isIn(p, [-35, 12, 12], [45, 22, 22]);
const isPole = ([x, , z]: readonly number[]) => z! > 30 && x! > -25;
const isLeak = ([x, y, z]: readonly number[]) => x! > 30 && x! < 85 && Math.abs(y!) < 11 && Math.abs(z!) < 11;
const isMasked = (p: readonly number[]) => isLeak(p) || (isLiver(p) && !isPole(p));

before(async () => {
  let seed = 1;
  const noise = () => (seed = (seed * 16807) % 2147483647) % 41;
  writeImage(file("ct.nii"), (p) => (isLiver(p) ? 110 : isLeak(p) ? 90 : 20) + noise());
  writeImage(file("liver.nii"), (p) => (isMasked(p) ? 1 : 0));
  writeImage(file("truth.nii"), (p) => (isLiver(p) ? 1 : 0));
  browser = await launch();
  server = await Server.startAt({ HOME: folder.path }, folder.path, file("ct.nii"));
  viewer = await Viewer.open(browser, server.address);
  await viewer.closeHint();
});

/** The liver's outline on a view, from one angle to another around the right lobe's middle, in degrees, counter-clockwise. */
async function outline(view: "axial" | "coronal", from: number, to: number): Promise<[number, number][]> {
  const perMm = await viewer.pixels(view, 1);
  return Array.from({ length: 40 }, (_, n) => ((from + ((to - from) * n) / 39) * Math.PI) / 180).map((angle) => {
    const at = (mm: number): [number, number] => [mm * Math.cos(angle) - LOBE_MM[0], -mm * Math.sin(angle)]; // right and down
    const place = ([right, down]: [number, number]) => (view === "axial" ? [-right, -down, 0] : [-right, 0, -down]);
    let mm = 90;
    while (!isLiver(place(at(mm)))) mm -= 0.25;
    const [right, down] = at(mm);
    return [right * perMm, down * perMm];
  });
}

async function dice(): Promise<number> {
  const mask = voxels((await viewer.export("mask.nii.gz")).bytes);
  const truth = voxels(gzipSync(readFileSync(file("truth.nii")))); // two bytes a voxel
  const counts = mask.reduce(
    ([both, one, other], value, n) => {
      const is = truth[2 * n]! > 0;
      return [both! + Number(value > 0 && is), one! + Number(value > 0), other! + Number(is)];
    },
    [0, 0, 0] as number[],
  );
  return (2 * counts[0]!) / (counts[1]! + counts[2]!);
}

async function picture(name: string): Promise<void> {
  const to = process.env["KONTUR_PICTURES"];
  if (to) await viewer.page.screenshot({ path: join(to, `${name}.png`) });
}

test("a liver with a leak and a missing pole is put right in less than a minute", async () => {
  const { page } = viewer;
  await viewer.import(file("liver.nii"));
  await page.click("[data-test=import-mask]");
  await page.locator("[data-test=is-mask]").waitFor();
  await viewer.surfaceShown();
  const was = await dice();
  await picture("liver_before");
  const began = Date.now();
  await page.keyboard.press("f");
  await viewer.drag("axial", await outline("axial", 150, 210));
  await viewer.waitForContours(1);
  await viewer.drag("coronal", await outline("coronal", 30, 150));
  await viewer.waitForContours(2);
  await viewer.surfaceShown();
  await viewer.saved();
  const took_ms = Date.now() - began;
  await picture("liver_after");
  const is = await dice();
  assert.ok(took_ms < MOST_MS, `${took_ms} ms`);
  assert.ok(was < 0.96 && is > 0.98, `Dice ${was} to ${is}`);
  assert.deepEqual(viewer.complaints, []);
});
