// SPDX-License-Identifier: Apache-2.0
// Somebody who draws at the pace of a hand, and misses what he aims at as hands do.
import { spawnSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { KONTUR, type Viewer } from "../e2e/support";
import { placeIn, type Frame, type Place, type Truth, type Vec3 } from "./truth";

export const READ_HINT_MS = 8000;
export const CHOOSE_MS = 2500; // to find a button
export const LOOK_MS = 4000; // at the result
const CLICK_MS = 1300; // to aim and to click
const WHEEL_MS = 150;
const AIM_MM = 1.5; // a click or a stroke misses the border by up to as much
const STROKE_PIXELS_PER_S = 250;
const MOVE_MS = 32;

export class User {
  private seed = 7;
  private readonly began = Date.now();
  private uncountedMs = 0; // in which the script found out what a user sees at once

  constructor(
    readonly viewer: Viewer,
    readonly truth: Truth,
    private readonly pictures: string | undefined = process.env["KONTUR_PICTURES"], // a folder for screenshots
  ) {}

  says(what: string): void {
    console.log(`${what} after ${((Date.now() - this.began - this.uncountedMs) / 1000).toFixed(0)} s`);
  }

  async waits(ms: number): Promise<void> {
    await this.viewer.page.waitForTimeout(ms);
  }

  /** Reads the hint and takes the tool for strokes, on a screen of a common size. */
  async takesFreehand(): Promise<void> {
    await this.viewer.page.setViewportSize({ width: 1600, height: 900 });
    await this.waits(READ_HINT_MS);
    await this.viewer.closeHint();
    await this.viewer.page.keyboard.press("f");
    await this.waits(CHOOSE_MS);
  }

  async photographs(name: string): Promise<void> {
    if (this.pictures) await this.viewer.page.screenshot({ path: join(this.pictures, `${name}.png`) });
  }

  /** From -1 to 1. */
  private chance(): number {
    this.seed = (this.seed * 16807) % 2147483647;
    return (2 * this.seed) / 2147483647 - 1;
  }

  /** The place in space under a place of a view, as the status line tells it. */
  private async placeUnder(view: string, right: number, down: number): Promise<Vec3> {
    const { page } = this.viewer;
    const begun = Date.now();
    const cursor = page.locator("[data-test=cursor]");
    await page.mouse.move(...(await this.viewer.at(view, right + 25, down + 25)));
    await this.waits(200);
    const before = await cursor.textContent();
    await page.mouse.move(...(await this.viewer.at(view, right, down)));
    await page.waitForFunction((text) => document.querySelector("[data-test=cursor]")!.textContent !== text, before);
    let text = "";
    for (let now = await cursor.textContent(); now !== text; now = await cursor.textContent()) {
      text = now!; // on a busy machine the place before is told late
      await this.waits(100);
    }
    this.uncountedMs += Date.now() - begun;
    return [...text.matchAll(/([RLAPIS]) (\d+\.\d)/g)].map(([, letter, mm]) => ("RAI".includes(letter!) ? -1 : 1) * Number(mm)) as Vec3;
  }

  middle(view: string): Promise<Vec3> {
    return this.placeUnder(view, 0, 0);
  }

  /** The plane that a view shows. */
  async frame(view: string): Promise<Frame> {
    const arm = 90;
    const unit = (from: Vec3, to: Vec3): Vec3 => {
      const d = to.map((value, i) => value - from[i]!);
      return d.map((value) => value / Math.hypot(...d)) as Vec3;
    };
    const [middle, right, down] = [await this.middle(view), await this.placeUnder(view, arm, 0), await this.placeUnder(view, 0, arm)];
    return { middle, u: unit(middle, right), v: unit(middle, down) };
  }

  /** All views go to a place that this one shows. */
  async jumpsTo(view: string, p: Vec3): Promise<void> {
    const { page } = this.viewer;
    const scale = await this.viewer.pixels(view, 1);
    const [x, y] = placeIn(await this.frame(view), p);
    await page.keyboard.down("Shift");
    await page.mouse.move(...(await this.viewer.at(view, scale * x, scale * y)), { steps: 20 });
    await page.keyboard.up("Shift");
    await this.viewer.slicesShown();
  }

  /** Scrolls until the view shows the slice of this place. */
  async scrollsTo(view: string, p: Vec3): Promise<void> {
    const { page } = this.viewer;
    const frame = await this.frame(view);
    const away = (middle: Vec3) => {
      const d = p.map((value, i) => value - middle[i]!) as Vec3;
      const [x, y] = placeIn({ ...frame, middle }, p);
      return Math.sqrt(Math.max(Math.hypot(...d) ** 2 - x * x - y * y, 0));
    };
    let best = away(frame.middle);
    let direction = 120;
    for (let turns = 0; turns < 2 && best > 0.5;) {
      await page.mouse.wheel(0, direction);
      await this.waits(WHEEL_MS);
      const now = away(await this.middle(view));
      if (now < best - 1e-6) best = now;
      else {
        await page.mouse.wheel(0, -direction);
        await this.waits(WHEEL_MS);
        direction = -direction;
        ++turns;
      }
    }
    await this.viewer.slicesShown();
  }

  async zooms(view: string, clicks: number, p: Vec3): Promise<void> {
    const { page } = this.viewer;
    const scale = await this.viewer.pixels(view, 1);
    const [x, y] = placeIn(await this.frame(view), p);
    await page.mouse.move(...(await this.viewer.at(view, scale * x, scale * y)));
    await page.keyboard.down("Control");
    for (let i = 0; i < clicks; ++i) await page.mouse.wheel(0, -150);
    await page.keyboard.up("Control");
    await this.viewer.slicesShown();
  }

  /** The borders that he sees in a view; the largest first. */
  async sees(view: string): Promise<{ frame: Frame; outlines: Place[][] }> {
    const frame = await this.frame(view);
    return { frame, outlines: this.truth.outlines(frame) };
  }

  /** Has it shown where a contour tells most, looks at the outline that is expected there, and takes it. */
  async acceptsProposal(): Promise<void> {
    const { page } = this.viewer;
    await this.viewer.surfaceShown();
    const before = await this.viewer.contours();
    await page.keyboard.press("g");
    await page.locator(".hint", { hasText: "A proposal" }).waitFor();
    await this.viewer.slicesShown();
    await this.waits(LOOK_MS);
    await page.keyboard.press("Enter");
    await this.viewer.waitForContours(before + 1);
  }

  /** Goes around it in one stroke, which sways from side to side. */
  async strokesAround(view: string, line: readonly Place[]): Promise<void> {
    const { page } = this.viewer;
    const scale = await this.viewer.pixels(view, 1);
    const origin = await this.viewer.at(view, 0, 0);
    const step = (STROKE_PIXELS_PER_S * MOVE_MS) / 1000 / scale; // mm
    const [sway, other] = [this.chance(), this.chance()];
    const way = spaced(line, step).map(([x, y], i): Place => {
      const t = i * step;
      return [x + (AIM_MM / 2) * (Math.sin(t / 9 + 3 * sway) + this.chance() / 4), y + (AIM_MM / 2) * (Math.sin(t / 13 + 3 * other) + this.chance() / 4)];
    });
    const to = ([x, y]: Place): Place => [origin[0] + scale * x, origin[1] + scale * y];
    await page.mouse.move(...to(way[0]!), { steps: 12 });
    await this.waits(CLICK_MS);
    await page.mouse.down();
    for (const place of way.slice(1)) {
      const due = Date.now() + MOVE_MS;
      await page.mouse.move(...to(place));
      if (due > Date.now()) await this.waits(due - Date.now());
    }
    await page.mouse.up();
    await this.viewer.saved();
  }

  /** Looks, exports the mask, and hears how good it is. */
  async exports(folder: string, truth: string): Promise<void> {
    await this.viewer.surfaceShown();
    await this.waits(LOOK_MS + CHOOSE_MS);
    const mask = join(folder, "mask.nii.gz");
    writeFileSync(mask, (await this.viewer.export("mask.nii.gz")).bytes);
    this.says("mask exported");
    const compared = spawnSync(KONTUR, ["compare", mask, truth, "--json"], { encoding: "utf8" });
    const { dice } = JSON.parse(compared.stdout) as { dice: number };
    console.log(`${await this.viewer.contours()} contours, Dice with the truth: ${dice.toFixed(3)}`);
  }
}

/** A closed line at equal steps. */
function spaced(line: readonly Place[], step: number): Place[] {
  const points: Place[] = [];
  let rest = 0;
  for (let i = 0; i < line.length; ++i) {
    const a = line[i]!;
    const b = line[(i + 1) % line.length]!;
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    for (; rest < length; rest += step) points.push([a[0] + ((b[0] - a[0]) * rest) / length, a[1] + ((b[1] - a[1]) * rest) / length]);
    rest -= length;
  }
  return points;
}
