// SPDX-License-Identifier: Apache-2.0
// The page under a person's hands: keys that are typed, Tab, real clicks, a pen with the hand beside it. Nothing here sets a field.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { beforeEach, describe, test } from "node:test";
import type { CDPSession } from "playwright-core";
import { onlyChromium } from "./browsers";
import { BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

beforeEach(async () => {
  viewer = await visits.next();
});

const names = () => viewer.page.locator(".structure-row button.name").allTextContents();
const activeName = () => viewer.page.locator(".structure-row.active .name").textContent();
const notice = (words: string) => viewer.page.locator(".notice", { hasText: words });
const focused = () =>
  viewer.page.evaluate(() => {
    const { dataset, className } = document.activeElement as HTMLElement;
    return dataset["test"] ?? dataset["part"] ?? className;
  });

async function tabTo(wanted: string): Promise<string[]> {
  const passed: string[] = [];
  while (passed.length < 120) {
    await viewer.page.keyboard.press("Tab");
    passed.push(await focused());
    if (passed.at(-1) === wanted) return passed;
  }
  return assert.fail(`Tab does not reach ${wanted}: ${passed.join(" ")}`);
}

test("a new user drags around a structure with the tool that the hint leaves him, and has a contour", async () => {
  const { page } = viewer;
  assert.equal(await page.locator("[data-test=tool-wire]").getAttribute("aria-pressed"), "true");
  const ring = circle(await viewer.pixels("axial", BALL_RADIUS_MM), 60);
  await viewer.drag("axial", ring.slice(0, -1)); // a hand does not end where it began
  await viewer.waitForContours(1);
  assert.equal(await page.locator(".contour-row").getAttribute("data-kind"), "freehand");
  await viewer.surfaceShown();
});

describe("the keyboard", () => {
  test("reaches every control by Tab, and the panel's, and comes around", async () => {
    await viewer.drawBall("axial", 1);
    await tabTo("tool-edit");
    const passed = await tabTo("delete-contour");
    await tabTo("tool-edit");
    for (const control of [
      "presets",
      "number",
      "layout-overview",
      "layout-single",
      "import",
      "export",
      "help",
      "overlay",
      "slice-slider",
      "add-structure",
      "color",
      "name",
      "eye",
    ])
      assert.ok(passed.includes(control), `${control}: ${passed.join(" ")}`);
  });

  test(
    "opens export, and the chooser of a file to import",
    onlyChromium("from the last control Tab goes to Firefox's own toolbar, where Playwright's keys do not follow"),
    async () => {
      const { page } = viewer;
      await tabTo("export");
      await page.keyboard.press("Enter");
      await page.waitForSelector("[data-test=export-dialog]");
      await page.keyboard.press("Escape");
      await tabTo("import");
      await page.keyboard.press("Enter");
      await tabTo("import-file");
      // A browser opens a chooser only within seconds of a key: on a busy machine they may have passed before the page gets to it.
      const chooser = page.waitForEvent("filechooser");
      const isOpen = () => Promise.race([chooser.then(() => true), page.waitForTimeout(8000).then(() => false)]);
      for (let tries = 0; tries < 5; ++tries) {
        await page.keyboard.press("Enter");
        if (await isOpen()) break;
      }
      assert.ok(!(await chooser).isMultiple());
    },
  );

  test("types the window's numbers, and what is no window is not kept", async () => {
    const { page } = viewer;
    const [center, width] = [page.locator(".toolbar .number").nth(0), page.locator(".toolbar .number").nth(1)];
    await viewer.type(center, "123");
    await page.keyboard.press("Tab");
    await page.keyboard.type("45");
    await page.keyboard.press("Enter");
    assert.deepEqual([await center.inputValue(), await width.inputValue()], ["123", "45"]);
    await viewer.type(width, "-3");
    await page.keyboard.press("Enter");
    assert.equal(await width.inputValue(), "45");
  });

  test("renames by F2, and Esc gives that up", async () => {
    const { page } = viewer;
    await page.keyboard.press("F2");
    await page.keyboard.type("Liver l f");
    await page.keyboard.press("Enter");
    await viewer.waitForStep("undo", "Rename");
    assert.deepEqual(await names(), ["Liver l f"]);
    await tabTo("name");
    await page.keyboard.press("F2");
    await page.keyboard.type("Spleen");
    await page.keyboard.press("Escape");
    await page.waitForSelector(".structure-row button.name");
    assert.deepEqual(await names(), ["Liver l f"]);
    await page.keyboard.press("l"); // the tools have the keys again
    await page.waitForSelector("[data-test=tool-wire][aria-pressed=true]");
  });
});

describe("the list of structures", () => {
  test("shows at once which one a click made active; the name is typed after a double click only", async () => {
    const { page } = viewer;
    await viewer.addStructure();
    await page.waitForSelector(".structure:nth-child(2) .structure-row.active");
    await page.locator(".structure-row button.name").nth(0).click();
    await page.waitForSelector(".structure:nth-child(1) .structure-row.active");
    assert.equal(await page.locator(".structure-row.active").count(), 1);
    await page.keyboard.press("s");
    await page.waitForSelector("[data-test=tool-spline][aria-pressed=true]");
    await viewer.rename(1, "Kidney");
    await viewer.waitForStep("undo", "Rename");
    assert.deepEqual(await names(), ["Structure 1", "Kidney"]);
    assert.equal(await activeName(), "Kidney");
  });

  test(
    "takes a slow double click for the name that it began on, though the first click moves the rows",
    onlyChromium("Playwright presses twice there"),
    async () => {
      const { page } = viewer;
      await viewer.addStructure();
      await page.locator(".structure-row button.name").nth(0).click();
      await page.waitForSelector(".structure:nth-child(1) .structure-row.active");
      const { x, y, width, height } = (await page.locator(".structure-row button.name").nth(1).boundingBox())!;
      await page.mouse.move(x + width / 2, y + height / 2);
      await page.mouse.down();
      await page.mouse.up();
      await page.waitForSelector(".structure:nth-child(2) .structure-row.active");
      assert.ok((await page.locator(".structure-row button.name").nth(1).boundingBox())!.y < y - height / 2, "its row has moved");
      await page.mouse.down({ clickCount: 2 });
      await page.mouse.up({ clickCount: 2 });
      await page.keyboard.type("Kidney");
      await page.keyboard.press("Enter");
      await viewer.waitForStep("undo", "Rename");
      assert.deepEqual(await names(), ["Structure 1", "Kidney"]);
    },
  );

  test("follows what happens while a name is typed, and does not take the name away", async () => {
    const { page } = viewer;
    await viewer.doubleClick(page.locator(".structure-row button.name"));
    await page.keyboard.type("Ki");
    const other = await Viewer.open(visits.browser, visits.server.address);
    await other.addStructure();
    await other.page.close();
    await page.waitForSelector(".structure:nth-child(2)");
    await page.keyboard.type("dney");
    await page.keyboard.press("Enter");
    await viewer.waitForStep("undo", "Rename");
    assert.deepEqual(await names(), ["Kidney", "Structure 2"]);
  });
});

describe("the pointer", () => {
  test("leaves every point of a stroke, however busy the page is", onlyChromium("Playwright hears nothing of Firefox's WebSocket"), async () => {
    const { page } = viewer;
    const stroke = new Promise<number>((resolve) => {
      page.on("websocket", (socket) =>
        socket.on("framesent", ({ payload }) => {
          const call = JSON.parse(String(payload)) as { call: string; control?: { path?: unknown[] }[] };
          if (call.call === "contour.add") resolve(call.control![0]!.path!.length);
        }),
      );
    });
    await page.reload();
    await viewer.ready();
    await page.keyboard.press("f");
    const places = await Promise.all(circle(await viewer.pixels("axial", BALL_RADIUS_MM), 100).map(([x, y]) => viewer.at("axial", x, y)));
    await page.mouse.move(...places[0]!);
    await page.mouse.down();
    await page.evaluate(() => {
      const work = () => {
        for (const until = performance.now() + 150; performance.now() < until;);
        setTimeout(work);
      };
      work();
    });
    await Promise.all(places.slice(1).map((place) => page.mouse.move(...place)));
    await page.mouse.up();
    const points = await stroke;
    assert.ok(points >= 99, `${points} points of 100 moves`);
    await viewer.waitForContours(1);
  });

  const half = (from: number, to: number) => circle(1, 24).slice(from, to + 1);

  /** A circle of which the second half follows after something else has touched the screen. */
  async function strokeAround(
    hand: (type: "mousePressed" | "mouseMoved" | "mouseReleased", at: [number, number]) => Promise<unknown>,
    meanwhile: () => Promise<void>,
  ): Promise<void> {
    const radius = await viewer.pixels("axial", BALL_RADIUS_MM);
    const place = ([x, y]: [number, number]) => viewer.at("axial", x * radius, y * radius);
    await hand("mousePressed", await place([1, 0]));
    for (const at of half(1, 12)) await hand("mouseMoved", await place(at));
    await meanwhile();
    for (const at of half(13, 24)) await hand("mouseMoved", await place(at));
    await hand("mouseReleased", await place([1, 0]));
    await viewer.waitForContours(1);
    await viewer.surfaceShown();
  }

  const asPen =
    (input: CDPSession) =>
    (type: string, [x, y]: [number, number]) =>
      input.send("Input.dispatchMouseEvent", {
        type: type as "mouseMoved",
        x,
        y,
        button: "left",
        buttons: type === "mouseReleased" ? 0 : 1,
        clickCount: 1,
        pointerType: "pen",
      });

  async function palm(input: CDPSession): Promise<void> {
    const [x, y] = await viewer.at("axial", 40, 60);
    await input.send("Input.dispatchTouchEvent", { type: "touchStart", touchPoints: [{ x, y, id: 7 }] });
    await input.send("Input.dispatchTouchEvent", { type: "touchMove", touchPoints: [{ x: x + 9, y: y + 9, id: 7 }] });
    await input.send("Input.dispatchTouchEvent", { type: "touchEnd", touchPoints: [] });
  }

  test(
    "that drew first draws on: a touch of the palm beside the pen does nothing, then or later",
    onlyChromium("pen and touch need its DevTools"),
    async () => {
      const input = await viewer.page.context().newCDPSession(viewer.page);
      await viewer.page.keyboard.press("f");
      const said = notice("A pen draws here").waitFor(); // it is gone again after some seconds
      await strokeAround(asPen(input), () => palm(input));
      const whole = await viewer.volume();
      assert.ok(whole > 200, `${whole} ml: the whole circle, not a half`);
      await palm(input);
      await said;
      await viewer.saved();
      assert.equal(await viewer.contours(), 1);
    },
  );

  test("of a second finger neither ends nor bends the first one's stroke", onlyChromium("pen and touch need its DevTools"), async () => {
    const input = await viewer.page.context().newCDPSession(viewer.page);
    await viewer.page.keyboard.press("f");
    const touch = (type: "touchStart" | "touchMove" | "touchEnd", ...at: [number, number][]) =>
      input.send("Input.dispatchTouchEvent", { type, touchPoints: at.map(([x, y], id) => ({ x, y, id })) });
    let first: [number, number] = [0, 0];
    const hand = (type: string, at: [number, number]) => {
      first = at;
      return type === "mouseReleased" ? touch("touchEnd") : touch(type === "mousePressed" ? "touchStart" : "touchMove", at);
    };
    await strokeAround(hand, async () => {
      const second = await viewer.at("axial", 30, 40);
      await touch("touchStart", first, second);
      await touch("touchMove", first, [second[0] + 20, second[1]]);
      await touch("touchMove", first); // the second one is lifted
    });
    assert.equal(await viewer.contours(), 1);
    assert.ok((await viewer.volume()) > 200);
  });
});

describe("what a hand gets wrong is said, with a way back", () => {
  const eight = (radius: number) =>
    Array.from({ length: 41 }, (_, i): [number, number] => [radius * Math.sin((Math.PI * i) / 20), 0.6 * radius * Math.sin((Math.PI * i) / 10)]);

  test("a contour that crosses itself", async () => {
    const { page } = viewer;
    await page.keyboard.press("f");
    await viewer.drag("axial", eight(await viewer.pixels("axial", BALL_RADIUS_MM)));
    await notice("crosses itself at the ringed place").waitFor();
    await page.locator("[data-test=crosses-itself]").waitFor();
    await page.locator("[data-test=self-crossing]").waitFor();
    const isOrange = (r: number, g: number, b: number) => Math.abs(r - 255) < 12 && Math.abs(g - 143) < 14 && Math.abs(b - 63) < 24;
    assert.ok((await viewer.countPixels("axial", isOrange)) > 0, "a ring");
    await notice("crosses itself").locator("button").click();
    await viewer.waitForContours(0);
    assert.equal(await notice("crosses itself").count(), 0);
  });

  test("a slip of a few pixels, which is a contour only if it is meant", async () => {
    const { page } = viewer;
    await page.keyboard.press("f");
    await viewer.drag("axial", [
      [0, 0],
      [3, 3],
      [7, 2],
    ]);
    await notice("less than 5 pixels wide").waitFor();
    await viewer.drag("axial", [
      [0, 0],
      [60, 1],
      [90, 2],
    ]);
    await viewer.saved();
    assert.equal(await viewer.contours(), 0);
    await notice("less than 5 pixels wide").locator("button").click();
    await viewer.waitForContours(1);
  });

  test("drawing into a structure that is hidden", async () => {
    const { page } = viewer;
    await page.locator(".structure-row button[title=Hide]").click();
    await page.waitForSelector(".structure-row button[title=Show]");
    await page.keyboard.press("f");
    await viewer.drag("axial", circle(40));
    await notice("Structure 1 is hidden").waitFor();
    assert.equal(await viewer.contours(), 0);
    await notice("Structure 1 is hidden").locator("button").click();
    await page.waitForSelector(".structure-row button[title=Hide]");
    await viewer.drawBall("axial", 1);
  });

  test("one contour, or several on one slice: the depth is a guess", async () => {
    const { page } = viewer;
    const guess = page.locator("[data-test=depth-guess]");
    await viewer.drawBall("axial", 1);
    await viewer.surfaceShown();
    assert.match((await guess.textContent())!, /^One contour: the depth is a guess/);
    await viewer.drawBall("coronal", 2);
    await viewer.surfaceShown();
    assert.equal(await guess.count(), 0);
  });

  test("contours that lie outside of the image are asked about before they are imported", async () => {
    const { page } = viewer;
    const path = join(visits.folder.path, "elsewhere.json");
    await viewer.drawBall("axial", 1);
    const drawing = JSON.parse((await viewer.export("contours.json")).bytes.toString()) as {
      planes: { origin: number[]; contours: { points: number[][] }[] }[];
    };
    for (const plane of drawing.planes) for (const p of [plane.origin, ...plane.contours.flatMap((contour) => contour.points)]) p[0]! += 800;
    writeFileSync(path, JSON.stringify(drawing));
    await viewer.import(path);
    const dialog = page.locator("[data-test=doubts-dialog]");
    await dialog.waitFor();
    assert.match((await dialog.textContent())!, /mm outside of the image/);
    await page.click("[data-test=import-not]");
    await viewer.saved();
    assert.equal(await viewer.contours(), 1);
    await viewer.import(path);
    await page.click("[data-test=import-anyway]");
    await viewer.waitForContours(2);
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(1);
  });

  test("the only contour is drawn and undone, over and over, without an error", async () => {
    const { page } = viewer;
    for (let round = 0; round < 4; ++round) {
      await page.keyboard.press("f");
      await viewer.drag("axial", circle(60 + round, 20));
      await viewer.waitForContours(1);
      await page.keyboard.press("Control+z");
      await viewer.waitForContours(0);
    }
    await viewer.saved();
    await page.waitForSelector(".panel[data-stage=none]");
    assert.deepEqual(viewer.complaints, []);
    assert.equal(await page.locator(".notice").count(), 0);
  });
});
