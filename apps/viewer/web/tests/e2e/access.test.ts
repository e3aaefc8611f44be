// SPDX-License-Identifier: Apache-2.0
// The page for those who use it by the keyboard or a screen reader, and for those whom colours or motion do not serve.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { describe, test } from "node:test";
import { BROWSER, EMULATES_MEDIA, launch } from "./browsers";
import { drawCrossingCircles } from "./crossing_circles";
import { BallVisits, Viewer } from "./support";

const AXE = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const visits = new BallVisits();
let viewer: Viewer;

interface Violation {
  id: string;
  nodes: { target: unknown[]; failureSummary?: string }[];
}

/** What axe finds wrong by WCAG 2.0 to 2.2, A and AA. */
async function violations(): Promise<string[]> {
  // Half way through a change of colours there may be too little contrast.
  await viewer.page.evaluate(() =>
    Promise.allSettled(
      document
        .getAnimations()
        .filter((one) => one instanceof CSSTransition)
        .map((one) => one.finished),
    ),
  );
  await viewer.page.evaluate(AXE); // not by a script element, which the page's policy refuses
  const found = await viewer.page.evaluate(async () => {
    const { axe } = window as unknown as { axe: { run: (options: object) => Promise<{ violations: Violation[] }> } };
    return (await axe.run({ runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa"] })).violations;
  });
  return found.map(({ id, nodes }) => `${id}: ${nodes.map(({ target, failureSummary }) => `${target.join(" ")} (${failureSummary})`).join("; ")}`);
}

let opened: Promise<void> | null = null;
const open = () => (opened ??= prepare());

async function prepare(): Promise<void> {
  viewer = await visits.next();
  await viewer.page.setViewportSize({ width: 1440, height: 900 }); // the whole toolbar fits, by Firefox's letters, too
  await drawCrossingCircles(viewer);
  await viewer.page.locator(".contour-row").first().click();
  await viewer.surfaceShown();
}

const theme = ({ page }: Viewer) => page.evaluate(() => document.documentElement.dataset["theme"]);

/** By the keyboard: the list that a click opens is the browser's own. */
async function choose(theme: string): Promise<void> {
  const { page } = viewer;
  await page.click("[data-test=appearance]");
  const field = page.locator("[data-test=theme]");
  await field.focus();
  await page.keyboard.press("Home");
  for (let n = 0; n < 5 && (await field.inputValue()) !== theme; ++n) await page.keyboard.press("ArrowDown");
  assert.equal(await field.inputValue(), theme);
  await page.keyboard.press("Escape");
  await field.waitFor({ state: "hidden" });
}

describe("axe finds nothing", () => {
  test("on the page with structures, contours, conflicts and figures", async () => {
    await open();
    assert.deepEqual(await violations(), []);
  });

  for (const name of ["export", "import", "help", "statistics-open", "appearance"])
    test(`in what "${name}" opens`, async () => {
      await open();
      await viewer.page.click(`[data-test=${name}]`);
      if (name === "statistics-open") await viewer.page.locator("[data-test=statistics]").waitFor();
      const found = await violations();
      await viewer.page.keyboard.press("Escape");
      await viewer.page.locator("dialog[open], :popover-open").waitFor({ state: "detached" });
      assert.deepEqual(found, []);
    });
});

describe("axe finds nothing in the theme", () => {
  const background = (place: string) => viewer.page.locator(place).evaluate((one) => getComputedStyle(one).backgroundColor);

  for (const [theme, surface] of [
    ["light", "rgb(242, 245, 247)"],
    ["dark-contrast", "rgb(5, 7, 10)"],
    ["light-contrast", "rgb(255, 255, 255)"],
  ] as const)
    test(theme, async () => {
      await open();
      await choose(theme);
      assert.equal(await background(".toolbar"), surface);
      assert.equal(await background(".pane.slice >> nth=0"), "rgb(0, 0, 0)", "slices stay black");
      assert.deepEqual(await violations(), []);
      await viewer.page.click("[data-test=export]");
      assert.deepEqual(await violations(), []);
      await viewer.page.keyboard.press("Escape");
    });

  test("that was chosen last, in the next page, too", async () => {
    await open();
    const { page } = viewer;
    await choose("light");
    await page.reload();
    await viewer.ready();
    assert.equal(await theme(viewer), "light");
  });

  test("of the system, where those are chosen", EMULATES_MEDIA, async () => {
    await open();
    const { page } = viewer;
    await choose("system");
    for (const colorScheme of ["light", "dark"] as const) {
      await page.emulateMedia({ colorScheme });
      await page.waitForFunction((wanted) => document.documentElement.dataset["theme"] === wanted, colorScheme);
    }
    assert.deepEqual(viewer.complaints, []);
  });

  test("of the system, where none were ever chosen", { skip: BROWSER === "firefox" ? false : "Chromium is asked by the test before" }, async () => {
    await open();
    for (const scheme of ["light", "dark"] as const) {
      const browser = await launch({ webgl: false, scheme });
      const other = await Viewer.open(browser, visits.server.address);
      assert.equal(await theme(other), scheme);
      await browser.close();
    }
  });
});

describe("the keyboard alone", () => {
  test("reaches every control, and comes back to where it began", async () => {
    await open();
    const { page } = viewer;
    const all = await page.evaluate(() => {
      const can = "button:not(:disabled), input, select, canvas[tabindex='0'], [tabindex='0']";
      return [...document.querySelectorAll<HTMLElement>(can)].filter((one) => one.checkVisibility() && !one.closest("[popover]")).length;
    });
    await page.evaluate(() => (document.activeElement as HTMLElement).blur());
    const reached = new Set<string>();
    for (let i = 0; i < all + 8; ++i) {
      await page.keyboard.press("Tab");
      reached.add(
        await page.evaluate(() => {
          const one = document.activeElement!;
          return one === document.body ? "" : [...document.querySelectorAll("*")].indexOf(one).toString();
        }),
      );
    }
    reached.delete("");
    assert.ok(reached.size >= all, `${reached.size} of ${all} controls`);
  });

  test("draws a contour, bends it, and takes both back", async () => {
    await open();
    const { page } = viewer;
    const before = await viewer.contours();
    const keys = async (...pressed: string[]): Promise<void> => {
      for (const key of pressed) await page.keyboard.press(key);
    };
    const far = (direction: string, times: number) => keys(...Array<string>(times).fill(`Alt+Shift+Arrow${direction}`));
    await page.evaluate(() => (document.activeElement as HTMLElement).blur());
    await keys("2", "s"); // the second view alone
    await far("Left", 5);
    assert.ok(await page.locator("[data-view=sagittal] [data-test=key-pointer]").isVisible());
    for (const direction of ["Up", "Right", "Down", "Left"]) {
      await far(direction, direction === "Up" ? 5 : 10);
      await keys("Alt+Enter");
    }
    await keys("Enter");
    await viewer.waitForContours(before + 1);
    await viewer.waitForStep("undo", "Draw a contour");
    await viewer.saved();
    await keys("v", "Alt+Shift+Enter"); // on the last point
    await far("Left", 2);
    await keys("Alt+ArrowLeft", "Alt+Shift+Enter");
    await viewer.waitForStep("undo", "Move a point");
    await keys("Control+z");
    await viewer.waitForStep("undo", "Draw a contour");
    await keys("Control+z", "Escape", "0");
    await viewer.waitForContours(before);
    await page.locator("[data-test=key-pointer]").waitFor({ state: "detached" });
  });
});

describe("the system's wishes", () => {
  test("are heard: more contrast, forced colours, less motion", EMULATES_MEDIA, async () => {
    await open();
    const { page } = viewer;
    const line = () => page.evaluate(() => getComputedStyle(document.documentElement).getPropertyValue("--line").trim());
    const usual = await line();
    await page.emulateMedia({ contrast: "more" });
    await page.waitForFunction(() => document.documentElement.dataset["contrast"] === "more");
    assert.notEqual(await line(), usual);
    await page.emulateMedia({ contrast: null, reducedMotion: "reduce" });
    const moves = () =>
      page.evaluate(() => [...document.querySelectorAll("*")].filter((one) => Number.parseFloat(getComputedStyle(one).transitionDuration) > 0.01).length);
    assert.equal(await moves(), 0);
    await page.emulateMedia({ reducedMotion: null });
    assert.ok((await moves()) > 0, "the test can fail");
    await page.emulateMedia({ forcedColors: "active" });
    assert.deepEqual(await violations(), []);
    const pressed = await page
      .locator('[aria-pressed="true"]')
      .first()
      .evaluate((one) => getComputedStyle(one).forcedColorAdjust);
    assert.equal(pressed, "none", "what is pressed keeps a colour of its own");
    await page.emulateMedia({ forcedColors: null });
  });
});
