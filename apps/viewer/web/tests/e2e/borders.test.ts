// SPDX-License-Identifier: Apache-2.0
// Two halves of the ball, one structure each, drawn side by side by hand: what is moved in one moves the other.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { gunzipSync } from "node:zlib";
import { BallVisits, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;
/** Of the latest outlines of each structure in the axial view, in pixels of its slice. */
let outlines: Map<number, number[][]>;
let pairs: { first: number; second: number; relation: string }[];

const RADIUS_MM = 36;
const HALF_GAP_MM = 0.5;
const APART_MM = 16;

type Place = [number, number];

/** The left (-1) or right (1) half of a circle around the view's middle, in mm, its straight side a little off the middle. */
function half(side: -1 | 1, radius: number): Place[] {
  const arc = Array.from({ length: 31 }, (_, i): Place => {
    const angle = -Math.PI / 2 + (Math.PI * i) / 30;
    return [side * (HALF_GAP_MM + radius * Math.cos(angle)), radius * Math.sin(angle)];
  });
  const straight = Array.from({ length: 25 }, (_, i): Place => [side * HALF_GAP_MM, radius * (1 - (2 * i) / 24)]);
  return [...arc, ...straight];
}

async function draw(side: -1 | 1, radius: number): Promise<void> {
  const scale = await viewer.pixels("axial", 1);
  const before = await viewer.contours();
  await viewer.drag(
    "axial",
    half(side, radius).map(([x, y]): Place => [x * scale, y * scale]),
  );
  await viewer.waitForContours(before + 1);
  await viewer.saved();
}

/** Slices up (negative) or down, by the keys. */
async function scroll(slices: number): Promise<void> {
  const target = (await viewer.slice("axial")) + slices;
  for (let i = 0; i < Math.abs(slices); ++i) await viewer.page.keyboard.press(slices > 0 ? "ArrowDown" : "ArrowUp");
  await viewer.page.waitForFunction((wanted) => document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["slice"] === String(wanted), target);
  await viewer.slicesShown();
}

/** Where a structure's outline crosses the row that is `down` pixels below the view's middle, in pixels right of the middle. */
async function crossingsOf(structure: number, down: number): Promise<number[]> {
  const box = (await viewer.pane("axial").boundingBox())!;
  const row = box.height / 2 + down;
  const found: number[] = [];
  for (const line of outlines.get(structure) ?? [])
    for (let i = 0; i < line.length; i += 2) {
      const [x, y] = [line[i]!, line[i + 1]!];
      const [nextX, nextY] = [line[(i + 2) % line.length]!, line[(i + 3) % line.length]!];
      if (y < row !== nextY < row) found.push(x + ((row - y) / (nextY - y)) * (nextX - x) - box.width / 2);
    }
  return found.sort((a, b) => a - b);
}

const finished = () => viewer.page.waitForFunction(() => document.querySelector<HTMLElement>(".panel")!.dataset["stage"] === "finished");

async function until(isTrue: () => Promise<boolean>, what: string): Promise<void> {
  for (let i = 0; i < 300; ++i) {
    if (await isTrue()) return;
    await viewer.page.waitForTimeout(100);
  }
  if (process.env["SHOT"]) await viewer.page.screenshot({ path: process.env["SHOT"] });
  assert.fail(`${what} did not come: ${(await border(0)).join(" and ")}`);
}

/** One border: where the left one ends the right one begins. */
async function border(down: number): Promise<[number, number]> {
  const [left, right] = [await crossingsOf(1, down), await crossingsOf(second, down)];
  return [left.at(-1) ?? NaN, right[0] ?? NaN];
}
let second = 0;

beforeEach(async () => {
  viewer = await visits.next();
  outlines = new Map();
  pairs = [];
  const { page } = viewer;
  page.on("websocket", (socket) =>
    socket.on("framereceived", ({ payload }) => {
      const event = JSON.parse(payload.toString()) as { event?: string; structure: number; views: { view: string; lines: number[][] }[]; pairs: typeof pairs };
      if (event.event === "outlines") for (const { view, lines } of event.views) if (view === "axial") outlines.set(event.structure, lines);
      if (event.event === "borders") pairs = event.pairs;
    }),
  );
  await page.reload();
  await viewer.ready();
  await page.keyboard.press("1"); // the axial slice alone: large
  await viewer.slicesShown();
  await page.keyboard.press("f");
  await scroll(-APART_MM / 4);
  for (const place of [-1, 0, 1]) {
    await draw(-1, place === 0 ? RADIUS_MM : 30);
    if (place < 1) await scroll(APART_MM / 4);
  }
  await viewer.addStructure();
  await page.locator(".structure-row.active", { hasText: "Structure 2" }).waitFor();
  for (const place of [1, 0, -1]) {
    await draw(1, place === 0 ? RADIUS_MM : 30);
    if (place > -1) await scroll(-APART_MM / 4);
  }
  await scroll(APART_MM / 4);
  await viewer.saved();
  second = Math.max(
    ...(await page.locator(".structures > .structure").evaluateAll((rows) => rows.map((row) => Number((row as HTMLElement).dataset["structure"])))),
  );
  await finished();
  await until(async () => {
    const [left, right] = await border(0);
    return Math.abs(left - right) < 0.05;
  }, "one border");
});

const voxels = (bytes: Buffer): { slice: (k: number) => number[][] } => {
  const file = gunzipSync(bytes);
  const [width, height] = [file.readInt16LE(42), file.readInt16LE(44)];
  const values = file.subarray(Math.round(file.readFloatLE(108)));
  return { slice: (k) => Array.from({ length: height }, (_, j) => [...values.subarray(width * (j + height * k), width * (j + 1 + height * k))]) };
};

/** Rows in which both labels occur, without those beside the rim. */
function checkBorder(rows: number[][]): void {
  const both = rows.filter((row) => row.includes(1) && row.includes(2));
  assert.ok(both.length > 25, `${both.length} rows with both`);
  for (const row of both.slice(3, -3)) {
    const last = row.length - 1 - [...row].reverse().findIndex((value) => value > 0);
    const labelled = row.slice(
      row.findIndex((value) => value > 0),
      last + 1,
    );
    assert.ok(!labelled.includes(0), `a gap: ${labelled.join("")}`);
    assert.equal(labelled.filter((value, i) => i > 0 && value !== labelled[i - 1]).length, 1, `one border: ${labelled.join("")}`);
  }
}

describe("structures that share borders", () => {
  test("have one border, and a drag of one's line moves the other's, in the same step of the history; exports have no gap", async () => {
    const { page } = viewer;
    assert.deepEqual(
      pairs.map(({ relation }) => relation),
      ["exclusive"],
    );
    await page.locator("[data-test=border-sentence]", { hasText: "Structure 1 and Structure 2 exclude each other: chosen, as they" }).waitFor();
    const scale = await viewer.pixels("axial", 1);
    const by = 7 * scale;
    await page.keyboard.press("v");
    await page.mouse.move(...(await viewer.at("axial", -HALF_GAP_MM * scale, 0)));
    await page.mouse.down();
    for (const part of [0.3, 0.6, 1]) await page.mouse.move(...(await viewer.at("axial", -HALF_GAP_MM * scale + part * by, 0)));
    await until(async () => (await border(0)).every((x) => Math.abs(x - by) < 2.5 * scale), "under the hand both borders");
    await page.mouse.up();
    await viewer.waitForStep("undo", "Bend a contour");
    await viewer.saved();
    await finished();
    await until(async () => {
      const [left, right] = await border(0);
      return Math.abs(left - by) < 1.5 * scale && Math.abs(left - right) < 0.05;
    }, "one border at the new place");
    const k = 40 - (await viewer.slice("axial")); // from the feet
    const moved = voxels((await viewer.export("labels.nii.gz")).bytes);
    checkBorder(moved.slice(k));
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("redo", "Bend a contour");
    await until(async () => (await border(0)).every((x) => Math.abs(x) < 1.5 * scale), "both borders where they were");
  });

  test("stop sharing by the switch, and a rule lets them overlap; both are kept and can be taken back", async () => {
    const { page } = viewer;
    await page.locator("[data-test=share-borders]").click();
    await viewer.waitForStep("undo", "Share no borders");
    await until(async () => {
      const [left, right] = await border(0);
      return Math.abs(left - right) > 0.05;
    }, "two borders");
    await page.keyboard.press("Control+z");
    await until(async () => {
      const [left, right] = await border(0);
      return Math.abs(left - right) < 0.05;
    }, "one border again");
    await page.click("[data-test=border-rules]");
    const rule = page.locator(`[data-test="rule-1-${second}"]`);
    await rule.selectOption({ label: "Structure 1 and Structure 2 may overlap" });
    await viewer.waitForStep("undo", "The rule for Structure 1 and Structure 2");
    await until(() => Promise.resolve(pairs[0]?.relation === "overlap"), "the rule");
    await page.keyboard.press("Escape");
    await page.reload();
    await viewer.ready();
    await page.click("[data-test=border-rules]");
    assert.equal(await page.locator(`[data-test="rule-1-${second}"] option:checked`).innerText(), "Structure 1 and Structure 2 may overlap");
    assert.deepEqual(viewer.complaints, []);
  });
});
