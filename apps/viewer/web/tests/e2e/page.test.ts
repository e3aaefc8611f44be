// SPDX-License-Identifier: Apache-2.0
// A user's visit, from an image to files, in one browser: each step goes on where the last one ended.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { BALL_RADIUS_MM, circle, cleanUp, run, Server, temporaryFolder, Viewer, voxels, writeBallImage } from "./support";

const folder = temporaryFolder();
const image = join(folder.path, "ball.nii");
const project = join(folder.path, "ball.kontur");
let server: Server;
let browser: Browser;
let viewer: Viewer;

before(async () => {
  writeBallImage(image);
  server = await Server.start(folder.path, image, "--project", project);
  browser = await launch();
  viewer = await Viewer.open(browser, server.address);
});

cleanUp(folder, () => [browser, server]);

const isAmber = (r: number, g: number, b: number) => r > 90 && r > 1.25 * g && g > 1.3 * b;
const contoursNow = async () => JSON.parse((await viewer.export("contours.json")).bytes.toString()) as unknown;
const undoTitle = () => viewer.page.locator("[data-test=undo]").getAttribute("title");

describe("the page", () => {
  test("shows a hint, four slices and what lies under the pointer", async () => {
    await viewer.closeHint();
    assert.ok(await viewer.page.locator("[data-test=undo]").isDisabled(), "nothing has been done");
    const inside = await viewer.countPixels("axial", (r, g, b) => r === g && g === b && r > 90);
    assert.ok(inside > 1000, `${inside} bright pixels in the axial slice`);
    await viewer.page.mouse.move(...(await viewer.at("axial", 10, 10)));
    await viewer.page.waitForFunction(() => /· {2}1[0-3]\d(\.\d+)?( HU)?$/.test(document.querySelector("[data-test=cursor]")!.textContent ?? ""));
  });

  test("scrolls by wheel, keys and slider, each view on its own", async () => {
    const { page } = viewer;
    const [first, other] = [await viewer.slice("axial"), await viewer.slice("coronal")];
    await page.mouse.move(...(await viewer.at("axial", 0, 0)));
    await page.mouse.wheel(0, 120);
    await page.waitForFunction((slice) => document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["slice"] === String(slice + 1), first);
    await page.keyboard.press("ArrowUp");
    await page.waitForFunction((slice) => document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["slice"] === String(slice), first);
    assert.equal(await viewer.slice("coronal"), other);
    await viewer.slicesShown();
  });

  test("draws freehand on the axial slice, and the surface appears everywhere", async () => {
    await viewer.page.keyboard.press("f");
    await viewer.drag("axial", circle(await viewer.pixels("axial", BALL_RADIUS_MM)));
    await viewer.waitForContours(1);
    await viewer.surfaceShown();
    assert.match((await undoTitle())!, /^Undo: /);
  });

  test("follows the edge on the coronal slice by live-wire, from clicks beside it", async () => {
    await viewer.page.keyboard.press("l");
    const radius = (await viewer.pixels("coronal", BALL_RADIUS_MM)) + 2;
    for (const [right, down] of circle(radius, 6).slice(0, 6)) await viewer.click("coronal", right, down);
    await viewer.page.keyboard.press("Enter");
    await viewer.waitForContours(2);
    await viewer.surfaceShown();
    assert.equal(await viewer.page.locator(".contour-row[data-kind=livewire]").count(), 1);
    await viewer.slicesShown(); // where contours cross is asked for after the surface
    const crossings = Number(await viewer.pane("sagittal").getAttribute("data-crossings"));
    assert.equal(crossings, 2, "both contours cross the sagittal slice");
  });

  test("draws spline and hand-drawn stretches in one contour on the turned oblique plane", async () => {
    await viewer.page.keyboard.press("v");
    const line = 0.33 * Math.min((await viewer.pane("axial").boundingBox())!.width, (await viewer.pane("axial").boundingBox())!.height);
    await viewer.drag("axial", [
      [line * Math.SQRT1_2, line * Math.SQRT1_2],
      [line, line * 0.2],
    ]);
    await viewer.page.waitForFunction(() => document.querySelector<HTMLElement>("[data-view=oblique]")!.dataset["turned"] === "true");
    await viewer.slicesShown();
    await viewer.page.keyboard.press("s");
    const radius = await viewer.pixels("oblique", BALL_RADIUS_MM);
    const places = circle(radius, 12);
    for (const place of places.slice(0, 6)) await viewer.click("oblique", ...place);
    await viewer.drag("oblique", places.slice(5, 9));
    for (const place of places.slice(9, 12)) await viewer.click("oblique", ...place);
    await viewer.click("oblique", ...places[0]!);
    await viewer.waitForContours(3);
    await viewer.surfaceShown();
    assert.equal(await viewer.page.locator(".contour-row[data-kind=mixed]").count(), 1);
    assert.ok((await viewer.countPixels("surface", isAmber)) > 2000, "the 3D view shows the surface");
  });

  test("exports the mask that the command line makes of the same contours", async () => {
    const mask = await viewer.export("mask.nii.gz");
    const contours = await viewer.export("contours.json");
    const paths = ["contours.json", "line.nii.gz"].map((name) => join(folder.path, name)) as [string, string];
    writeFileSync(paths[0], contours.bytes);
    run("segment", paths[0], "--image", image, "--output", paths[1]);
    const [exported, segmented] = [voxels(mask.bytes), voxels(readFileSync(paths[1]))];
    assert.deepEqual(exported, segmented);
    assert.ok(exported.includes(1));
    const volume = Number.parseFloat((await viewer.page.locator(".figure strong").first().textContent())!);
    const truth = (4 / 3) * Math.PI * (BALL_RADIUS_MM / 10) ** 3;
    assert.ok(Math.abs(volume / truth - 1) < 0.08, `${volume} ml; the ball has ${truth.toFixed(0)} ml`);
  });

  test("exports every other format", async () => {
    for (const [name, start] of [
      ["mask.nrrd", "NRRD"],
      ["mask.mha", "ObjectType"],
      ["mesh.ply", "ply"],
      ["contours.mrk.json", "{"],
      ["picture.png", "\x89PNG"],
      ["project.kontur", "SQLite format 3"],
    ] as const)
      assert.equal((await viewer.export(name)).bytes.subarray(0, start.length).toString("latin1"), start, name);
  });

  test("exports one picture of all views as they are seen, the surface, too", async () => {
    await viewer.surfaceShown();
    const { width, colors } = await viewer.decoded((await viewer.export("views.png")).bytes);
    const panes = await viewer.page.evaluate(() => {
      const stage = document.querySelector(".stage")!.getBoundingClientRect();
      return [...document.querySelectorAll(".pane")].map((pane) => {
        const box = pane.getBoundingClientRect();
        return { left: box.left - stage.left, top: box.top - stage.top, right: box.right - stage.left, bottom: box.bottom - stage.top };
      });
    });
    const isOrange = (color: number): boolean => (color & 255) - ((color >> 16) & 255) > 60; // as the structure is
    const colored = panes.map(({ left, top, right, bottom }) => {
      const isIn = (x: number, y: number): boolean => x >= left && x < right && y >= top && y < bottom;
      return colors.filter((color, i) => isOrange(color) && isIn(i % width, Math.floor(i / width))).length;
    });
    assert.ok(colored.length === 5 && colored.every((count) => count > 100), colored.join(", "));
    assert.ok(colored.at(-1)! > 1000, "the surface in 3D");
  });

  test("drags a point of the live-wire contour; undo and redo bring back both states", async () => {
    const { page } = viewer;
    const original = await contoursNow();
    await page.keyboard.press("v");
    await page.locator(".contour-row[data-kind=livewire]").click();
    await viewer.slicesShown();
    const radius = await viewer.pixels("coronal", BALL_RADIUS_MM);
    await viewer.drag("coronal", [
      [radius, 0],
      [radius + 8, 3],
      [radius + 16, 6],
    ]);
    await page.waitForFunction(() => !document.querySelector("[data-test=undo]")!.getAttribute("title")!.includes("Draw"));
    await viewer.surfaceShown();
    const edited = await contoursNow();
    assert.notDeepEqual(edited, original);
    await page.keyboard.press("Control+z");
    await page.waitForSelector("[data-test=redo]:enabled");
    assert.deepEqual(await contoursNow(), original);
    await page.keyboard.press("Control+Shift+z");
    await page.waitForSelector("[data-test=redo]:disabled");
    assert.deepEqual(await contoursNow(), edited);
  });

  test("accepts what is proposed on the next slice, deletes it, and undoes that", async () => {
    const { page } = viewer;
    await page.locator(".contour-row[data-kind=freehand]").click();
    await page.keyboard.press("c");
    await page.locator(".hint", { hasText: "A proposal" }).waitFor();
    await page.keyboard.press("Enter");
    await viewer.waitForContours(4);
    await page.waitForSelector(".contour-row.selected");
    await page.keyboard.press("Delete");
    await viewer.waitForContours(3);
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(4);
    await viewer.saved();
  });

  test("finds everything again after kill -9, history too", async () => {
    const before = await contoursNow();
    const undo = await undoTitle();
    assert.deepEqual(viewer.complaints, []);
    const { port, token } = server;
    await server.end("SIGKILL");
    await viewer.page.waitForSelector("[data-test=saved][data-state=lost]");
    server = await Server.start(folder.path, project, "--port", port, "--token", token);
    await viewer.page.waitForSelector("[data-test=saved][data-state=saved]");
    assert.deepEqual(await contoursNow(), before);
    assert.equal(await undoTitle(), undo);
    viewer.complaints.length = 0; // the browser has told that the connection was lost
    await viewer.page.reload();
    await viewer.ready();
    await viewer.waitForContours(4);
    assert.equal(await viewer.page.locator("[data-test=first-hint]").count(), 0);
    for (let left = 4; left > 0; --left) {
      await viewer.page.waitForSelector("[data-test=undo]:enabled");
      await viewer.page.keyboard.press("Control+z");
    }
    await viewer.waitForContours(1);
  });

  test("imports contours as a new structure, and shows its surface", async () => {
    await viewer.import(join(folder.path, "contours.json"));
    await viewer.waitForContours(4);
    assert.equal(await viewer.page.locator(".structure").count(), 2);
    await viewer.surfaceShown();
  });

  test("says by a sentence what cannot be imported", async () => {
    const { page } = viewer;
    const path = join(folder.path, "broken.json");
    writeFileSync(path, "{ no contours");
    await viewer.import(path);
    const notice = page.locator(".notice.error");
    await notice.waitFor();
    assert.ok((await notice.textContent())!.length > 20);
    await notice.click();
    viewer.complaints.length = 0; // the browser logs the refusal, too
  });

  test("shows one view alone and the 3D view big, at any size", async () => {
    const { page } = viewer;
    await page.keyboard.press("3");
    await page.waitForFunction(() => document.querySelector("[data-view=coronal]")!.getBoundingClientRect().width > 800);
    await page.keyboard.press("0");
    await page.click("[data-test=layout-big-surface]");
    await page.setViewportSize({ width: 3840, height: 2160 });
    await viewer.slicesShown();
    await page.waitForFunction(() => document.querySelector("[data-view=surface]")!.getBoundingClientRect().width > 2000);
    assert.deepEqual(viewer.complaints, []);
  });
});
