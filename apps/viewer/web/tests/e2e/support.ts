// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { copyFileSync, existsSync, mkdtempSync, renameSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { createInterface } from "node:readline";
import { after, before } from "node:test";
import { gunzipSync } from "node:zlib";
import type { Browser, Locator, Page } from "playwright-core";
import { BROWSER, downloaded, launch, PATIENCE_MS, type Wish } from "./browsers";

export const KONTUR = process.env["KONTUR_CLI"] ?? "kontur";

/** Of the empty style that Playwright adds to a page for a screenshot, where the page's policy forbids it and Firefox says so. */
const SCREENSHOT_STYLE = "sha256-YjaKGiklmzC6wjXA513HAMmzus8VE61XCOT+SmwNZWA=";

interface Folder {
  path: string;
  remove: () => void;
}

export function temporaryFolder(): Folder {
  const path = mkdtempSync(join(tmpdir(), "kontur-web-"));
  return { path, remove: () => rmSync(path, { recursive: true, force: true }) };
}

export function run(...words: string[]): void {
  const { status, stderr } = spawnSync(KONTUR, words, { encoding: "utf8" });
  assert.equal(status, 0, stderr);
}

export const BALL_RADIUS_MM = 40;
export const BALL_ML = (4 / 3) * Math.PI * (BALL_RADIUS_MM / 10) ** 3;

/** Columns of a NIfTI's matrix (RAS): the steps in mm along i, j and k. */
export type Steps = readonly [readonly number[], readonly number[], readonly number[]];
const STRAIGHT: Steps = [
  [2, 0, 0],
  [0, 2, 0],
  [0, 0, 4],
];
/** Turned by 25 degrees about x, and the slices shifted against each other as a tilted gantry does. */
export const SHEARED: Steps = [
  [2, 0, 0],
  [0, 1.81, 0.85],
  [0.6, -0.7, 3.8],
];

/** A NIfTI image of 96 x 80 x 40 voxels with a ball of 100 in the middle of space, in a little noise; with several radii as many frames. */
export function writeBallImage(path: string, steps: Steps = STRAIGHT, ...radii_mm: number[]): void {
  let seed = 1;
  const noise = () => (seed = (seed * 16807) % 2147483647) % 21;
  const radii = radii_mm.length > 0 ? radii_mm : [BALL_RADIUS_MM];
  writeFrames(
    path,
    steps,
    radii.map((radius) => (place) => (Math.hypot(...place) < radius ? 100 : 0) + noise()),
  );
}

type Value = (place: [number, number, number]) => number;

/** Of the same voxels, with values by places in mm (RAS). */
export function writeImage(path: string, value: Value): void {
  writeFrames(path, STRAIGHT, [value]);
}

function writeFrames(path: string, steps: Steps, frames: readonly Value[]): void {
  const size = [96, 80, 40] as const;
  const file = Buffer.alloc(352 + 2 * size[0] * size[1] * size[2] * frames.length);
  file.writeInt32LE(348, 0);
  [frames.length > 1 ? 4 : 3, ...size, frames.length, 1, 1, 1].forEach((value, i) => file.writeInt16LE(value, 40 + 2 * i));
  file.writeInt16LE(4, 70); // 16-bit integers
  file.writeInt16LE(16, 72);
  [1, ...steps.map((step) => Math.hypot(...step))].forEach((value, i) => file.writeFloatLE(value, 76 + 4 * i));
  file.writeFloatLE(352, 108);
  file.writeUInt8(2, 123); // mm
  file.writeInt16LE(1, 254); // the sform counts
  const first = [0, 1, 2].map((axis) => steps.reduce((sum, step, n) => sum - ((size[n]! - 1) / 2) * step[axis]!, 0));
  [0, 1, 2].forEach((axis) => {
    steps.forEach((step, n) => file.writeFloatLE(step[axis]!, 280 + 16 * axis + 4 * n));
    file.writeFloatLE(first[axis]!, 280 + 16 * axis + 12);
  });
  file.write("n+1\0", 344);
  let at = 352;
  for (const value of frames)
    for (let k = 0; k < size[2]; ++k)
      for (let j = 0; j < size[1]; ++j)
        for (let i = 0; i < size[0]; ++i) {
          const place = first.map((from, axis) => from + i * steps[0][axis]! + j * steps[1][axis]! + k * steps[2][axis]!);
          file.writeInt16LE(value(place as [number, number, number]), at);
          at += 2;
        }
  writeFileSync(path, file);
}

/** The voxels of a NIfTI, behind its header and what that says of how the file was made. */
export function voxels(file: Buffer): Buffer {
  const bytes = gunzipSync(file);
  return bytes.subarray(bytes.readFloatLE(108));
}

/** A running `kontur open`. */
export class Server {
  private constructor(
    private readonly process: ChildProcess,
    readonly address: string,
  ) {}

  static start(folder: string, ...words: string[]): Promise<Server> {
    return Server.startAt({}, folder, ...words);
  }

  static async startAt(variables: Record<string, string>, folder: string, ...words: string[]): Promise<Server> {
    const environment = { ...process.env, XDG_DATA_HOME: folder, ...variables };
    const child = spawn(KONTUR, ["open", ...words, "--no-browser", "--timeout", "300"], { env: environment, stdio: ["ignore", "pipe", "pipe"] });
    let complaint = "";
    child.stderr.on("data", (data: Buffer) => (complaint += data.toString()));
    const address = await new Promise<string>((resolve, reject) => {
      createInterface(child.stdout).once("line", resolve);
      child.once("error", reject);
      child.once("exit", () => reject(new Error(`kontur open ended: ${complaint}`)));
    });
    return new Server(child, address);
  }

  get pid(): number {
    return this.process.pid!;
  }

  get port(): string {
    return new URL(this.address).port;
  }

  get token(): string {
    return new URL(this.address).hash.slice(1);
  }

  end(signal: "SIGINT" | "SIGKILL" = "SIGINT"): Promise<void> {
    if (this.process.exitCode !== null || this.process.signalCode !== null) return Promise.resolve();
    const ended = new Promise<void>((resolve) => this.process.once("exit", () => resolve()));
    this.process.kill(signal);
    this.resume(); // a suspended one would end only then
    return ended;
  }

  /** It does nothing any more, but its connections stay open. */
  suspend(): void {
    this.process.kill("SIGSTOP");
  }

  resume(): void {
    this.process.kill("SIGCONT");
  }
}

/** After the last test of a file: ends what was opened, then removes the folder. */
export function cleanUp(folder: Folder, opened: () => (Browser | Server | undefined)[]): void {
  after(async () => {
    for (const one of opened()) await (one instanceof Server ? one.end() : one?.close());
    folder.remove();
  });
}

/** The image of a ball that beats, `beating.nii` in the folder, opened at a frame (from 1) in a page of its own. */
export async function openBeating(folder: Folder, browser: Browser, radii_mm: number[], frame: number): Promise<[Server, Viewer]> {
  const path = join(folder.path, "beating.nii");
  writeBallImage(path, undefined, ...radii_mm);
  const server = await Server.startAt({ HOME: folder.path }, folder.path, path, "--frame", String(frame));
  const viewer = await Viewer.open(browser, server.address);
  await viewer.closeHint();
  return [server, viewer];
}

/** The image of a ball, opened for each test by a server, with a project and in a page of their own. */
export class BallVisits {
  readonly folder = temporaryFolder();
  server!: Server;
  browser!: Browser;
  private viewer: Viewer | undefined;
  private count = 0;
  private readonly image = join(this.folder.path, "ball.nii");

  constructor(wish?: Wish) {
    before(async () => {
      writeBallImage(this.image);
      this.browser = await launch(wish);
    });
    cleanUp(this.folder, () => [this.browser, this.server]);
  }

  /** Ends the visit before, and forgets how its page was arranged. */
  async next(): Promise<Viewer> {
    const viewer = await this.visit();
    await viewer.closeHint();
    return viewer;
  }

  /** The same with what `draw` draws in an empty project, which it does once for all visits; the surface is shown. */
  async nextDrawn(draw: (viewer: Viewer) => Promise<void>): Promise<Viewer> {
    const drawn = join(this.folder.path, "drawn.kontur");
    if (!existsSync(drawn)) {
      const first = await this.next();
      await draw(first);
      await first.saved();
      await this.end();
      renameSync(this.project, drawn);
    }
    const viewer = await this.visit(drawn);
    await viewer.surfaceShown();
    return viewer;
  }

  private get project(): string {
    return join(this.folder.path, `visit${this.count}.kontur`);
  }

  private async visit(from?: string): Promise<Viewer> {
    await this.end();
    ++this.count;
    if (from !== undefined) copyFileSync(from, this.project);
    rmSync(join(this.folder.path, "kontur", "arrangements.json"), { force: true });
    this.server = await Server.start(this.folder.path, this.image, "--project", this.project);
    this.viewer = await Viewer.open(this.browser, this.server.address);
    return this.viewer;
  }

  private async end(): Promise<void> {
    await this.viewer?.page.close();
    this.viewer = undefined;
    await (this.server as Server | undefined)?.end();
  }
}

/** The page as a user sees it; gathers what it complains of. */
export class Viewer {
  readonly complaints: string[] = [];

  private constructor(readonly page: Page) {
    page.setDefaultTimeout(PATIENCE_MS);
    const hear = (text: string) => void (text.includes(SCREENSHOT_STYLE) || this.complaints.push(text));
    page.on("pageerror", (error) => hear(String(error.stack)));
    page.on("console", (message) => message.type() === "error" && hear(message.text()));
  }

  static async open(browser: Browser, address: string): Promise<Viewer> {
    const viewer = await Viewer.openStart(browser, address);
    await viewer.ready();
    return viewer;
  }

  /** A window that another one has opened. */
  static async opened(page: Page): Promise<Viewer> {
    const viewer = new Viewer(page);
    await page.waitForSelector("body[data-ready]");
    return viewer;
  }

  /** Where no image is open, or not yet. */
  static async openStart(browser: Browser, address: string): Promise<Viewer> {
    const viewer = new Viewer(await browser.newPage({ viewport: { width: 1280, height: 720 }, acceptDownloads: true }));
    await viewer.page.goto(address);
    return viewer;
  }

  async ready(): Promise<void> {
    await this.page.waitForSelector("body[data-ready]");
    await this.slicesShown();
  }

  /** Every view has asked for its slice and shown it. */
  async slicesShown(): Promise<void> {
    await this.page.waitForFunction(() =>
      [...document.querySelectorAll<HTMLElement>(".pane.slice:not([hidden])")].every((pane) => pane.dataset["slices"] && pane.dataset["pending"] === "false"),
    );
  }

  async closeHint(): Promise<void> {
    await this.page.click("[data-test=hint-close]");
  }

  pane(view: string) {
    return this.page.locator(`[data-view=${view}]`);
  }

  async slice(view: string): Promise<number> {
    return Number(await this.pane(view).getAttribute("data-slice"));
  }

  /** A place `right` and `down` of the view's middle, in pixels of the screen. */
  async at(view: string, right: number, down: number): Promise<[number, number]> {
    const box = (await this.pane(view).boundingBox())!;
    return [box.x + box.width / 2 + right, box.y + box.height / 2 + down];
  }

  /** How many pixels a length has on the screen. */
  async pixels(view: string, mm: number): Promise<number> {
    return mm * Number(await this.pane(view).getAttribute("data-pixels-per-mm"));
  }

  async drag(view: string, places: [number, number][], button: "left" | "right" = "left"): Promise<void> {
    const { mouse } = this.page;
    await mouse.move(...(await this.at(view, ...places[0]!)));
    await mouse.down({ button });
    for (const place of places.slice(1)) await mouse.move(...(await this.at(view, ...place)));
    await mouse.up({ button });
  }

  /** All slices, as far as it goes: the screen is coarser than the image then. */
  async zoomOut(view: string): Promise<void> {
    await this.page.keyboard.press("k"); // together
    await this.page.mouse.move(...(await this.at(view, 0, 0)));
    await this.page.keyboard.down("Control");
    for (let i = 0; i < 12; ++i) await this.page.mouse.wheel(0, 300);
    await this.page.keyboard.up("Control");
    await this.slicesShown();
  }

  /** The contour of this number of the list goes into its plane and is selected. */
  async show(row: number): Promise<void> {
    await this.page.locator(".contour-row").nth(row).click();
    await this.slicesShown();
  }

  /** The volume in ml that the panel shows. */
  async volume(): Promise<number> {
    return Number.parseFloat((await this.page.locator(".figure strong").first().textContent())!);
  }

  /** Waits until the button's title says that this is what undo, or redo, would do. */
  async waitForStep(which: "undo" | "redo", label: string): Promise<void> {
    await this.page.waitForSelector(`[data-test=${which}][title^="${which === "undo" ? "Undo" : "Redo"}: ${label}"]`);
  }

  /** Draws by hand around the ball, or a circle of another radius, whose pixels it returns; `contours` are there then, all saved. */
  async drawBall(view: string, contours = 1, radius_mm = BALL_RADIUS_MM): Promise<number> {
    const radius = await this.pixels(view, radius_mm);
    await this.page.keyboard.press("f");
    await this.drag(view, circle(radius, 36));
    await this.waitForContours(contours);
    await this.saved();
    return radius;
  }

  async click(view: string, right: number, down: number): Promise<void> {
    await this.page.mouse.move(...(await this.at(view, right, down)));
    await this.page.mouse.click(...(await this.at(view, right, down)));
  }

  contours(): Promise<number> {
    return this.page.locator(".contour-row").count();
  }

  async waitForContours(count: number): Promise<void> {
    await this.page.waitForFunction((wanted) => document.querySelectorAll(".contour-row").length === wanted, count);
  }

  /** The surface is finished, and every slice and the 3D view show it. */
  async surfaceShown(): Promise<void> {
    const isShown = () => {
      const panel = document.querySelector<HTMLElement>(".panel")!.dataset;
      if (panel["stage"] !== "finished") return false;
      const wanted = `${panel["structure"]}:${panel["revision"]}`; // of the structure that is drawn in
      const panes = [...document.querySelectorAll<HTMLElement>(".pane")].filter((pane) => pane.dataset["webgl"] !== "no");
      return panes.every((pane) => pane.dataset["revisions"]?.split(" ").includes(wanted));
    };
    const state = () => [".panel", ".pane"].flatMap((kind) => [...document.querySelectorAll<HTMLElement>(kind)].map(({ dataset }) => ({ ...dataset })));
    await this.page.waitForFunction(isShown).catch(async (error: Error) => {
      throw new Error(`the surface is not shown everywhere: ${JSON.stringify(await this.page.evaluate(state))}`, { cause: error });
    });
  }

  async saved(): Promise<void> {
    await this.page.waitForSelector("[data-test=saved][data-state=saved]");
  }

  /** Clicks into a field, and types over what is there. */
  async type(field: Locator, text: string): Promise<void> {
    await field.click();
    await this.page.keyboard.press("Control+a");
    await this.page.keyboard.type(text);
  }

  /** On a name. Playwright's clicks do not count up in Firefox. */
  async doubleClick(place: Locator): Promise<void> {
    if (BROWSER !== "firefox") return place.dblclick();
    await place.click();
    await place.dispatchEvent("click", { detail: 2 });
  }

  /** Renames a structure, from 0, by a double click on its name. */
  async rename(structure: number, name: string): Promise<void> {
    await this.doubleClick(this.page.locator(".structure-row button.name").nth(structure));
    await this.page.keyboard.type(name);
    await this.page.keyboard.press("Enter");
  }

  /** Adds a structure, which is drawn in from then on; without a name it keeps the one that the page gives it. */
  async addStructure(name?: string): Promise<void> {
    const { page } = this;
    const before = await page.locator(".structure").count();
    await page.click("[data-test=add-structure]");
    await page.waitForFunction((count) => document.querySelectorAll(".structure").length > count, before);
    await page.waitForFunction(() => document.activeElement?.matches(".structure-row.active input.name"));
    if (name !== undefined) await page.keyboard.type(name);
    await page.keyboard.press(name === undefined ? "Escape" : "Enter");
    await page.locator(".structure-row.active button.name", name === undefined ? {} : { hasText: name }).waitFor();
  }

  /** Imports by the dialog, and the file chooser that a click on its field opens. */
  async import(path: string): Promise<void> {
    await this.page.click("[data-test=import]");
    const chooser = this.page.waitForEvent("filechooser");
    await this.page.click("[data-test=import-file]");
    await (await chooser).setFiles(path);
  }

  /** The click would open the browser's colour picker, a window of its own that no test reaches, and that takes keys and presses: it is kept shut, and what is chosen there is set. */
  async pickColor(field: Locator, color: string): Promise<void> {
    await this.page.evaluate(() =>
      window.addEventListener(
        "click",
        (event) => {
          document.body.dataset["clicked"] = event.defaultPrevented ? "cancelled" : "through";
          event.preventDefault();
        },
        { once: true },
      ),
    );
    await field.click();
    assert.equal(await this.page.evaluate(() => document.body.dataset["clicked"]), "through", "the click opens the colour picker");
    await field.evaluate((input: HTMLInputElement, chosen) => {
      input.value = chosen;
      for (const type of ["input", "change"]) input.dispatchEvent(new Event(type, { bubbles: true }));
    }, color);
  }

  /** Exports by the dialog. */
  async export(name: string): Promise<{ name: string; bytes: Buffer }> {
    await this.page.click("[data-test=export]");
    const file = await downloaded(this.page, () => this.page.click(`[data-test="export-${name}"]`));
    await this.page.keyboard.press("Escape");
    return file;
  }

  /** Pixels of a pane whose colour the test accepts. */
  async countPixels(view: string, isWanted: (r: number, g: number, b: number) => boolean): Promise<number> {
    const { colors } = await this.decoded(await this.pane(view).screenshot());
    return colors.filter((color) => isWanted(color & 255, (color >> 8) & 255, (color >> 16) & 255)).length;
  }

  /** The same once two counts agree, or after ten: a frame comes when there is time for it. */
  async countPixelsAtRest(view: string, isWanted: (r: number, g: number, b: number) => boolean): Promise<number> {
    let last = await this.countPixels(view, isWanted);
    for (let n = 0; n < 10; ++n) {
      await this.page.waitForTimeout(500);
      const count = await this.countPixels(view, isWanted);
      if (count === last) break;
      last = count;
    }
    return last;
  }

  /** A PNG's pixels row by row, red in the lowest byte. */
  async decoded(picture: Buffer): Promise<{ width: number; colors: number[] }> {
    return this.page.evaluate(async (data) => {
      const image = new Image();
      image.src = `data:image/png;base64,${data}`;
      await image.decode();
      const canvas = document.createElement("canvas");
      [canvas.width, canvas.height] = [image.width, image.height];
      const context = canvas.getContext("2d")!;
      context.drawImage(image, 0, 0);
      return { width: image.width, colors: [...new Uint32Array(context.getImageData(0, 0, image.width, image.height).data.buffer)] };
    }, picture.toString("base64"));
  }

  /** Waits until so many are seen: a frame comes when there is time for it, a rough one first. */
  async waitForPixels(view: string, isWanted: (r: number, g: number, b: number) => boolean, isEnough: (count: number) => boolean): Promise<void> {
    const counts: number[] = [];
    for (let n = 0; n < 60; ++n) {
      counts.push(await this.countPixels(view, isWanted));
      if (isEnough(counts.at(-1)!)) return;
      await this.page.waitForTimeout(200);
    }
    assert.fail(`the ${view} view has ${counts.join(", ")} such pixels`);
  }
}

/** Places on a circle, the last one near the first. */
export function circle(radius: number, count = 24): [number, number][] {
  return Array.from({ length: count + 1 }, (_, i) => {
    const angle = (2 * Math.PI * i) / count;
    return [radius * Math.cos(angle), radius * Math.sin(angle)];
  });
}
