// SPDX-License-Identifier: Apache-2.0
// Cornerstone3D's contours, drawn by real events, by kontur as its polySeg add-on.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { dragCircle, open, peer, picture, skipWithout, told } from "./served.mjs";

const skip = skipWithout("@cornerstonejs/tools");
const RADIUS_MM = 36; // of a drawn ball
const HEIGHTS = [-14, -7, 0, 7, 14]; // of its drawn slices, in voxels of 2 mm
let page, close, folder;

/** The page's script with Cornerstone3D. A writer of XML, which wants Node's modules, is left out. */
function bundle(folder) {
  const noXml = join(folder, "no_xml.js");
  writeFileSync(noXml, "export const create = undefined;");
  const script = fileURLToPath(new URL("../example/cornerstone.js", import.meta.url));
  const words = ["--bundle", "--format=esm", "--external:kontur-wasm", "--external:kontur-wasm/*", `--alias:xmlbuilder2=${noXml}`, `--outdir=${folder}`];
  execFileSync(process.env.KONTUR_ESBUILD, [script, ...words, "--log-level=error"], { env: { ...process.env, NODE_PATH: peer("") } });
}

before(async () => {
  if (skip) return;
  folder = mkdtempSync(join(tmpdir(), "kontur-"));
  bundle(folder);
  ({ page, close } = await open("cornerstone.html", { folders: { bundled: folder }, viewport: { width: 1040, height: 720 } }));
  await told(page, /Drag/);
});
after(async () => {
  await close?.();
  if (folder) rmSync(folder, { recursive: true });
});

/** Where the middle of the volume is on the slice that is shown, and pixels to a mm. */
async function axial() {
  const box = await page.locator("#axial").boundingBox();
  const [middle, aside] = await page.evaluate(() => {
    const at = (along) => axial.worldToCanvas([0, 1, 2].map((axis) => grid.indexToMm[axis][3] + grid.size[axis] - 1 + (axis === 0 ? along : 0)));
    return [at(0), at(10)];
  });
  return { middle: [box.x + middle[0], box.y + middle[1]], pixelsPerMm: Math.abs(aside[0] - middle[0]) / 10 };
}

/** Its circles on slices of these heights. */
async function drawBall(heights) {
  const half = await page.evaluate(() => Math.floor(grid.size[2] / 2));
  for (const height of heights) {
    await page.locator("#slice").fill(String(half + height));
    const { middle, pixelsPerMm } = await axial();
    await dragCircle(page, middle, Math.sqrt(RADIUS_MM ** 2 - (2 * height) ** 2) * pixelsPerMm);
  }
}

const drawn = () =>
  page.evaluate(() => [...data().Contour.annotationUIDsMap.get(1)].map((uid) => tools.annotation.state.getAnnotation(uid).data.contour.polyline));

test("contours drawn on five slices become a label map: kontur's own mask", { skip }, async () => {
  await drawBall(HEIGHTS);
  const lines = await drawn();
  assert.equal(lines.length, HEIGHTS.length);
  await page.click("#labelmap");
  const voxels = Number(/\d+/.exec(await told(page, /voxels/))[0]);
  const { different, inside } = await page.evaluate((lines) => {
    const planes = lines.map((points) => ({ origin: points[0], normal: [0, 0, 1], contours: [{ closed: true, points }] }));
    const { mask } = kontur.segment({ contours: { frame: "LPS mm", planes }, grid });
    const labels = core.cache.getVolume(data().Labelmap.volumeId).voxelManager.getCompleteScalarDataArray();
    return { different: mask.filter((value, n) => value !== labels[n]).length, inside: mask.reduce((sum, value) => sum + value, 0) };
  }, lines);
  assert.equal(different, 0);
  assert.equal(voxels, inside);
  const ball = ((4 / 3) * Math.PI * RADIUS_MM ** 3) / 8;
  assert.ok(Math.abs(voxels / ball - 1) < 0.03, `${voxels} voxels; a ball has ${ball}`);
});

test("and a surface, which outlines on all slices", { skip }, async () => {
  await page.click("#surface");
  await told(page, /points on the surface/);
  const all = () =>
    page.evaluate(() =>
      tools.annotation.state.getAllAnnotations().map(({ data, metadata }) => ({ points: data.contour.polyline, closed: data.contour.closed, metadata })),
    );
  const before = (await all()).length;
  await page.click("#outlines");
  await told(page, /outlines/);
  const outlines = (await all()).slice(before);
  const middle = await page.evaluate(() => grid.indexToMm.map((row, axis) => row[3] + grid.size[axis] - 1));
  assert.ok(outlines.length >= 20, `${outlines.length}`);
  for (const { points, closed, metadata } of outlines) {
    assert.ok(closed && metadata.FrameOfReferenceUID === "2.25.1");
    for (const point of points) {
      const radius = Math.hypot(...point.map((value, axis) => value - middle[axis]));
      const beyond = Math.abs(point[2] - middle[2]) > 2 * HEIGHTS.at(-1); // where the end is a guess
      assert.ok(Math.abs(radius - RADIUS_MM) < (beyond ? 3 : 1), `${point} is ${radius} mm from the middle of a ball of ${RADIUS_MM} mm`);
    }
  }
  await page.locator("#slice").fill(String(await page.evaluate(() => Math.floor(grid.size[2] / 2) + 4)));
  await picture(page, "cornerstone");
});

test("a surface follows the next contour", { skip }, async () => {
  await page.reload();
  await told(page, /Drag/);
  await drawBall([-7, 7]);
  await page.click("#surface");
  await told(page, /points on the surface/);
  await drawBall([0]);
  const expected = await page.evaluate(
    (lines) => {
      const planes = lines.map((points) => ({ origin: points[0], normal: [0, 0, 1], contours: [{ points }] }));
      return kontur.segment({ contours: { frame: "LPS mm", planes } }).mesh.points.length;
    },
    await drawn(),
  );
  const shown = () => page.evaluate(() => core.cache.getGeometry(data().Surface.geometryIds.get(1)).data.points.length);
  for (let tries = 0; tries < 100 && (await shown()) !== expected; tries++) await page.waitForTimeout(200);
  assert.equal(await shown(), expected);
});
