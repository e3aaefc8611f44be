// SPDX-License-Identifier: Apache-2.0
// A new user's first structure, at the pace of a hand: opens the phantom, finds the metastasis in the liver, draws around it
// by live-wire in three views and exports the mask. Prints how long that took and how good it is. Run by bench/viewer walk.
import { spawnSync } from "node:child_process";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { gunzipSync } from "node:zlib";
import { launch } from "../e2e/browsers";
import { KONTUR, run, Server, temporaryFolder, Viewer } from "../e2e/support";

const READ_HINT_MS = 8000;
const CLICK_MS = 1300; // to aim and to click
const CHOOSE_MS = 2500; // to find a button
const WHEEL_MS = 150;
const LOOK_MS = 4000; // at the result
const AIM_MM = 1.5; // a click misses the border by as much

type Vec3 = [number, number, number];

/** The truth, to know where the user sees the border. */
class Truth {
  private readonly bytes: Buffer;
  private readonly size: Vec3;
  private readonly rows: number[][];

  constructor(path: string) {
    const file = gunzipSync(readFileSync(path));
    this.bytes = file.subarray(file.readFloatLE(108));
    this.size = [42, 44, 46].map((at) => file.readInt16LE(at)) as Vec3;
    this.rows = [280, 296, 312].map((at) => [0, 4, 8, 12].map((offset) => file.readFloatLE(at + offset)));
  }

  /** For axes that are those of the patient, as the phantom's are. */
  has([x, y, z]: Vec3): boolean {
    const ras = [-x, -y, z];
    const [i, j, k] = ras.map((value, axis) => Math.round((value - this.rows[axis]![3]!) / this.rows[axis]![axis]!)) as Vec3;
    if ([i, j, k].some((value, axis) => value < 0 || value >= this.size[axis]!)) return false;
    return this.bytes[i + this.size[0] * (j + this.size[1] * k)] !== 0;
  }

  center(): Vec3 {
    const sum = [0, 0, 0];
    let count = 0;
    for (let k = 0, at = 0; k < this.size[2]; ++k)
      for (let j = 0; j < this.size[1]; ++j)
        for (let i = 0; i < this.size[0]; ++i, ++at)
          if (this.bytes[at]) [i, j, k].forEach((index, axis) => (sum[axis]! += index)), ++count;
    const ras = sum.map((value, axis) => this.rows[axis]![3]! + (this.rows[axis]![axis]! * value) / count);
    return [-ras[0]!, -ras[1]!, ras[2]!];
  }
}

const AXES: Record<string, [Vec3, Vec3]> = { axial: [[1, 0, 0], [0, 1, 0]], coronal: [[1, 0, 0], [0, 0, -1]], sagittal: [[0, 1, 0], [0, 0, -1]] };
const along = (p: Vec3, d: Vec3, mm: number): Vec3 => p.map((value, i) => value + mm * d[i]!) as Vec3;

class User {
  private seed = 7;

  constructor(
    readonly viewer: Viewer,
    readonly truth: Truth,
  ) {}

  async waits(ms: number): Promise<void> {
    await this.viewer.page.waitForTimeout(ms);
  }

  private miss(): number {
    this.seed = (this.seed * 16807) % 2147483647;
    return AIM_MM * ((2 * this.seed) / 2147483647 - 1);
  }

  /** The place in space under the middle of a view, as the status line tells it. */
  async middle(view: string): Promise<Vec3> {
    const { page } = this.viewer;
    const cursor = page.locator("[data-test=cursor]");
    await page.mouse.move(...(await this.viewer.at(view, 40, 40)));
    await this.waits(300);
    const before = await cursor.textContent();
    await page.mouse.move(...(await this.viewer.at(view, 0, 0)));
    await page.waitForFunction((text) => document.querySelector("[data-test=cursor]")!.textContent !== text, before);
    const text = (await cursor.textContent())!;
    return [...text.matchAll(/([RLAPIS]) (\d+\.\d)/g)].map(([, letter, mm]) => ("RAI".includes(letter!) ? -1 : 1) * Number(mm)) as Vec3;
  }

  async placeOf(view: string, p: Vec3, middle: Vec3): Promise<[number, number]> {
    const scale = await this.viewer.pixels(view, 1);
    return AXES[view]!.map((axis) => scale * axis.reduce((sum, value, i) => sum + value * (p[i]! - middle[i]!), 0)) as [number, number];
  }

  /** Clicks around what is seen there, as well as a hand can. */
  async drawsAround(view: string, clicks: number): Promise<void> {
    const middle = await this.middle(view);
    const [u, v] = AXES[view]!;
    const normal = [0, 1, 2].find((i) => u[i] === 0 && v[i] === 0)!;
    const start = this.truth.center();
    start[normal] = middle[normal]!;
    for (let n = 0; n < clicks; ++n) {
      const angle = (2 * Math.PI * n) / clicks;
      const direction = u.map((value, i) => value * Math.cos(angle) + v[i]! * Math.sin(angle)) as Vec3;
      let border = 0;
      while (this.truth.has(along(start, direction, border))) border += 0.2;
      await this.viewer.page.mouse.move(...(await this.viewer.at(view, ...(await this.placeOf(view, along(start, direction, border + this.miss()), middle)))), { steps: 12 });
      await this.waits(CLICK_MS);
      await this.viewer.page.mouse.down();
      await this.viewer.page.mouse.up();
    }
    await this.viewer.page.keyboard.press("Enter");
    await this.waits(CHOOSE_MS);
  }
}

const folder = temporaryFolder();
const pictures = process.env["KONTUR_PICTURES"]; // a folder for screenshots
const browser = await launch();
try {
  run("phantom", folder.path, "--scan", "abdomen", "--quiet");
  const truth = new Truth(join(folder.path, "abdomen_truth_metastasis.nii.gz"));
  const server = await Server.start(folder.path, "phantom");
  const start = Date.now();
  const seconds = () => ((Date.now() - start) / 1000).toFixed(0);
  const viewer = await Viewer.open(browser, server.address);
  const { page } = viewer;
  await page.setViewportSize({ width: 1600, height: 900 });
  const picture = async (name: string) => pictures && (await page.screenshot({ path: join(pictures, `${name}.png`) }));
  const user = new User(viewer, truth);
  const target = truth.center();
  await picture("walk_hint");
  await user.waits(READ_HINT_MS);
  await viewer.closeHint();
  await user.waits(CHOOSE_MS);
  await page.selectOption("[data-test=presets]", { label: "Liver" });
  await user.waits(CHOOSE_MS);

  // Scrolls through the axial slices until the metastasis is there, and brings the other views along.
  let middle = await user.middle("axial");
  const reaches = (slices: number) => Math.abs(middle[2] - target[2]) < 2 || slices === 200;
  for (let slices = 0; !reaches(slices); ++slices) {
    await page.mouse.wheel(0, middle[2] < target[2] ? -120 : 120); // down leads to the feet
    await user.waits(WHEEL_MS);
    middle = await user.middle("axial");
  }
  const place = await user.placeOf("axial", target, middle);
  await page.keyboard.down("Shift");
  await page.mouse.move(...(await viewer.at("axial", ...place)), { steps: 20 });
  await page.keyboard.up("Shift");
  await viewer.slicesShown();
  console.log(`found after ${seconds()} s`);
  for (const view of ["axial", "coronal", "sagittal"]) {
    const spot = await user.placeOf(view, target, await user.middle(view));
    await page.mouse.move(...(await viewer.at(view, ...spot)));
    await page.keyboard.down("Control");
    for (let i = 0; i < 3; ++i) await page.mouse.wheel(0, -150);
    await page.keyboard.up("Control");
    await viewer.slicesShown();
    await user.drawsAround(view, 7);
    console.log(`drawn in the ${view} view after ${seconds()} s`);
    await picture(`walk_${view}`);
  }
  await viewer.surfaceShown();
  await user.waits(LOOK_MS);
  await picture("walk_done");
  await user.waits(CHOOSE_MS);
  const mask = join(folder.path, "mask.nii.gz");
  writeFileSync(mask, (await viewer.export("mask.nii.gz")).bytes);
  console.log(`mask exported after ${seconds()} s`);
  const compared = spawnSync(KONTUR, ["compare", mask, join(folder.path, "abdomen_truth_metastasis.nii.gz"), "--json"], { encoding: "utf8" });
  const { dice } = JSON.parse(compared.stdout) as { dice: number };
  console.log(`Dice with the truth: ${dice.toFixed(3)}`);
  await server.end();
} finally {
  await browser.close();
  folder.remove();
}
