// SPDX-License-Identifier: Apache-2.0
// What a user waits for, measured in the page: prints medians. Run by bench/viewer.
import { closeSync, openSync, readFileSync, writeSync } from "node:fs";
import { join } from "node:path";
import type { Browser, Page } from "playwright-core";
import { launch } from "../e2e/browsers";
import { run, Server, temporaryFolder, Viewer } from "../e2e/support";
import { writeManyContours } from "./many_contours";

const EDITS = 8;
const SCROLLS = 30;
const OPENINGS = 5;
const SCREEN = { width: 1600, height: 900 };
const LARGE_SCREEN = { width: 3840, height: 2160 };

/** 512 x 512 x 300 voxels: balls on a slope, so that every slice differs. */
function writeBigImage(path: string): void {
  const size = [512, 512, 300] as const;
  const header = Buffer.alloc(352);
  header.writeInt32LE(348, 0);
  [3, ...size, 1, 1, 1, 1].forEach((value, i) => header.writeInt16LE(value, 40 + 2 * i));
  header.writeInt16LE(4, 70);
  header.writeInt16LE(16, 72);
  [1, 0.8, 0.8, 1].forEach((value, i) => header.writeFloatLE(value, 76 + 4 * i));
  header.writeFloatLE(352, 108);
  header.writeInt16LE(1, 254);
  [0.8, 0.8, 1].forEach((value, axis) => header.writeFloatLE(value, 280 + 20 * axis));
  header.write("n+1\0", 344);
  const file = openSync(path, "w");
  writeSync(file, header);
  for (let k = 0; k < size[2]; ++k) {
    const slice = Int16Array.from({ length: size[0] * size[1] }, (_, n) => {
      const i = n % size[0];
      const j = Math.floor(n / size[0]);
      return (((i >> 6) + (j >> 6) + (k >> 6)) % 2) * 120 + (i % 64) - k / 4;
    });
    writeSync(file, new Uint8Array(slice.buffer));
  }
  closeSync(file);
}

const median = (values: number[]): number => values.sort((a, b) => a - b)[Math.floor(values.length / 2)]!;
const line = (label: string, values: number[], unit = "ms"): void =>
  console.log(
    `${label.padEnd(62)} ${median(values).toFixed(0).padStart(6)} ${unit}   (${Math.min(...values).toFixed(0)} to ${Math.max(...values).toFixed(0)})`,
  );

interface Waits {
  outlines: number;
  surface: number;
  /** What the contours make, everywhere. */
  fitted: number;
  /** And the image has been asked. */
  finished: number;
}

/** What `watchEdit` sees. */
interface Seen {
  start: number;
  shown: Record<string, number>;
  fitted: number;
  finished: number;
  /** Settle when something new is shown everywhere, and when the image has been asked. */
  everywhere: Promise<void>;
  done: Promise<void>;
}
type Watched = Window & { edit: Seen };

/** Notes in the page when each pane shows a newer surface than the one it showed at `from`, the next event of that type. */
async function watchEdit(page: Page, from: "pointermove" | "pointerup"): Promise<void> {
  await page.evaluate((type) => {
    const is = { everywhere: () => {}, done: () => {} };
    const state: Seen = {
      start: 0,
      shown: {},
      fitted: 0,
      finished: 0,
      everywhere: new Promise((resolve) => (is.everywhere = resolve)),
      done: new Promise((resolve) => (is.done = resolve)),
    };
    const panes = [...document.querySelectorAll<HTMLElement>(".pane")];
    const before = new Map(panes.map((pane) => [pane, pane.dataset["revisions"]]));
    const panel = document.querySelector<HTMLElement>(".panel")!;
    const observer = new MutationObserver(() => {
      if (state.start === 0) return;
      for (const pane of panes) if (pane.dataset["revisions"] !== before.get(pane)) state.shown[pane.dataset["view"]!] ??= performance.now() - state.start;
      if (Object.keys(state.shown).length === panes.length) is.everywhere();
      const last = `:${panel.dataset["revision"]}`;
      const { stage } = panel.dataset;
      const isEverywhere = Object.keys(state.shown).length === panes.length && panes.every((pane) => pane.dataset["revisions"]?.endsWith(last));
      if (!isEverywhere || (stage !== "asking" && stage !== "finished")) return;
      state.fitted ||= performance.now() - state.start;
      if (stage !== "finished") return;
      state.finished ||= performance.now() - state.start;
      is.done();
    });
    for (const element of [...panes, panel]) observer.observe(element, { attributes: true });
    window.addEventListener(type, (event) => (state.start = event.timeStamp), { capture: true, once: true });
    Object.assign(window, { edit: state });
  }, from);
}

/** Asks nothing meanwhile: a page that is asked in every frame draws every frame. */
async function editWaits(page: Page, untilFinished: boolean): Promise<Waits> {
  const { shown, fitted, finished } = await page.evaluate(async (isAll) => {
    const { edit } = window as unknown as Watched;
    await (isAll ? edit.done : edit.everywhere);
    return { shown: edit.shown, fitted: edit.fitted, finished: edit.finished };
  }, untilFinished);
  const { surface, ...slices } = shown;
  return { outlines: Math.max(...Object.values(slices)), surface: surface!, fitted, finished };
}

/** Seconds of all processors that the server has used. */
function processorSeconds(server: Server): number {
  const fields = readFileSync(`/proc/${server.pid}/stat`, "utf8").split(") ")[1]!.split(" ");
  return (Number(fields[11]) + Number(fields[12])) / 100;
}

async function measureEdits(viewer: Viewer, server: Server): Promise<void> {
  const { page } = viewer;
  await page.locator(".contour-row").last().click();
  await viewer.surfaceShown();
  const view = await page.evaluate(() => document.querySelector<HTMLElement>(".pane.focused")!.dataset["view"]!);
  await page.keyboard.press("m");
  const moves: Waits[] = [];
  const releases: Waits[] = [];
  // The contour lies around its outline's middle, where no line is: it is taken where the outline crosses the crosshair's row.
  const grip = await findLine(viewer, view);
  const before = processorSeconds(server);
  for (let i = 0; i < EDITS; ++i) {
    const further = 0.25 * i; // pixels: what was drawn before is known
    await page.mouse.move(...grip);
    await page.mouse.down();
    await watchEdit(page, "pointermove");
    await page.mouse.move(grip[0] + 4 + further, grip[1]);
    moves.push(await editWaits(page, false));
    await watchEdit(page, "pointerup");
    await page.mouse.move(grip[0] + 6 + further, grip[1]); // a hand moves until it lets go
    await page.mouse.up();
    releases.push(await editWaits(page, true));
    await page.keyboard.press("Control+z");
    await viewer.saved();
    await viewer.surfaceShown();
  }
  line(
    "pointer moves a contour -> outlines in all four views",
    moves.map((wait) => wait.outlines),
  );
  line(
    "pointer moves a contour -> surface in 3D",
    moves.map((wait) => wait.surface),
  );
  line(
    "pointer up -> first new outlines in all four views",
    releases.map((wait) => wait.outlines),
  );
  line(
    "pointer up -> first new surface in 3D",
    releases.map((wait) => wait.surface),
  );
  line(
    "pointer up -> what the contours make, everywhere",
    releases.map((wait) => wait.fitted),
  );
  line(
    "pointer up -> the image asked, too",
    releases.map((wait) => wait.finished),
  );
  const spent = (processorSeconds(server) - before) / EDITS;
  console.log(`processor time of the server: ${spent.toFixed(2)} s for each edit and its undoing`);
}

/** Looks for the contour under the pointer along a row of the view. */
async function findLine(viewer: Viewer, view: string): Promise<[number, number]> {
  const box = (await viewer.pane(view).boundingBox())!;
  for (const row of [0.5, 0.42, 0.58, 0.34, 0.66])
    for (let x = 30; x < box.width - 30; x += 3) {
      const at: [number, number] = [box.x + x, box.y + row * box.height];
      await viewer.page.mouse.move(...at);
      const cursor = await viewer.page.evaluate(
        (name) =>
          new Promise<string>((resolve) =>
            requestAnimationFrame(() =>
              requestAnimationFrame(() => resolve(document.querySelector<HTMLElement>(`[data-view=${name}] .overlay`)!.style.cursor)),
            ),
          ),
        view,
      );
      if (cursor === "move") return at;
    }
  throw new Error(`no contour is seen in the ${view} view`);
}

async function measureScrolls(viewer: Viewer, label: string): Promise<void> {
  const { page } = viewer;
  for (const view of ["axial", "sagittal", "coronal", "oblique"]) {
    if (!(await viewer.pane(view).isVisible())) continue;
    await page.mouse.move(...(await viewer.at(view, 5, 5)));
    const waits: number[] = [];
    for (let i = 0; i < SCROLLS; ++i) {
      await page.evaluate((name) => {
        const pane = document.querySelector<HTMLElement>(`[data-view=${name}]`)!;
        const scrolled = { ms: 0 };
        pane.addEventListener(
          "wheel",
          (event) => {
            const observer = new MutationObserver(() => {
              observer.disconnect();
              requestAnimationFrame(() => (scrolled.ms = performance.now() - event.timeStamp));
            });
            observer.observe(pane, { attributes: true, attributeFilter: ["data-slices"] });
          },
          { capture: true, once: true },
        );
        Object.assign(window, { scrolled });
      }, view);
      await page.mouse.wheel(0, i % 20 < 10 ? 120 : -120);
      const ms = await page.waitForFunction(() => (window as unknown as { scrolled: { ms: number } }).scrolled.ms);
      waits.push((await ms.jsonValue()) as number);
    }
    const box = (await viewer.pane(view).boundingBox())!;
    line(`scroll ${view}, ${label}, ${box.width.toFixed(0)} x ${box.height.toFixed(0)} pixels`, waits);
  }
}

async function memory(viewer: Viewer, server: Server): Promise<void> {
  const heap = await viewer.page.evaluate(() => (performance as unknown as { memory: { usedJSHeapSize: number } }).memory.usedJSHeapSize);
  const peak = /VmHWM:\s+(\d+)/.exec(readFileSync(`/proc/${server.pid}/status`, "utf8"))![1];
  console.log(`memory: server ${(Number(peak) / 1024).toFixed(0)} MiB at its peak, page ${(heap / 2 ** 20).toFixed(0)} MiB of JavaScript`);
}

/** From the address to the first slice on the screen. */
async function measureFirstSlice(browser: Browser, server: Server, label: string): Promise<void> {
  const waits: number[] = [];
  for (let i = 0; i < OPENINGS; ++i) {
    const page = await browser.newPage({ viewport: SCREEN });
    await page.addInitScript(() => {
      new MutationObserver((_, observer) => {
        if (!document.querySelector("[data-slices]")) return;
        observer.disconnect();
        requestAnimationFrame(() => Object.assign(window, { firstSlice: performance.now() }));
      }).observe(document, { subtree: true, childList: true, attributes: true, attributeFilter: ["data-slices"] });
    });
    await page.goto(server.address);
    const ms = await page.waitForFunction(() => (window as unknown as { firstSlice?: number }).firstSlice);
    waits.push((await ms.jsonValue())!);
    await page.close();
  }
  line(`the page's address -> its first slice, ${label}`, waits);
}

async function measureDrawn(browser: Browser, folder: string, contours: string): Promise<void> {
  const server = await Server.start(folder, join(folder, "abdomen_ct.nii.gz"), contours);
  await measureFirstSlice(browser, server, "with contours");
  const viewer = await Viewer.open(browser, server.address);
  await viewer.page.setViewportSize(SCREEN);
  await measureEdits(viewer, server);
  await memory(viewer, server);
  await server.end();
  await viewer.page.close();
}

async function measureBigImage(browser: Browser, folder: string): Promise<void> {
  const image = join(folder, "big.nii");
  writeBigImage(image);
  const server = await Server.start(folder, image);
  await measureFirstSlice(browser, server, "512 x 512 x 300");
  const viewer = await Viewer.open(browser, server.address);
  const { page } = viewer;
  await page.setViewportSize(SCREEN);
  await viewer.closeHint();
  await measureScrolls(viewer, "overview");
  await page.keyboard.press("1");
  await viewer.slicesShown();
  await measureScrolls(viewer, "alone");
  await page.setViewportSize(LARGE_SCREEN);
  await viewer.slicesShown();
  await measureScrolls(viewer, "alone");
  await memory(viewer, server);
  await server.end();
}

const folder = temporaryFolder();
const browser = await launch();
try {
  run("phantom", folder.path, "--scan", "abdomen", "--quiet");
  console.log("Liver of the phantom, 14 contours drawn by hand, 1600 x 900, WebGL in software:");
  await measureDrawn(browser, folder.path, join(folder.path, "liver_orthogonal14_hand.json"));
  console.log("\nThe same liver, 30 contours:");
  await measureDrawn(browser, folder.path, writeManyContours(folder.path, "abdomen_truth_liver.nii.gz", "liver_orthogonal14.json", 10));
  console.log("\nImage of 512 x 512 x 300 voxels, 1600 x 900:");
  await measureBigImage(browser, folder.path);
} finally {
  await browser.close();
  folder.remove();
}
