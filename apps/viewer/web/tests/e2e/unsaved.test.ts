// SPDX-License-Identifier: Apache-2.0
// What becomes of a user's work when kontur cannot save it, or is gone.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { before, beforeEach, describe, test } from "node:test";
import type { Browser } from "playwright-core";
import { launch, NO_WEBGL } from "./browsers";
import { BALL_RADIUS_MM, circle, cleanUp, Server, temporaryFolder, Viewer, writeBallImage } from "./support";

const folder = temporaryFolder();
const image = join(folder.path, "ball.nii");
const canFillDisk = spawnSync("prlimit", ["--version"]).status === 0;
let project: string;
let server: Server;
let browser: Browser;
let viewer: Viewer;
let visit = 0;

before(async () => {
  writeBallImage(image);
  browser = await launch(NO_WEBGL);
});

beforeEach(async () => {
  await viewer?.page.close();
  await server?.end();
  project = join(folder.path, `visit${++visit}.kontur`);
  server = await Server.start(folder.path, image, "--project", project);
  viewer = await Viewer.open(browser, server.address);
  await viewer.closeHint();
});

cleanUp(folder, () => [browser, server]);

const saved = (state: "saved" | "lost" | "unsaved") => viewer.page.waitForSelector(`[data-test=saved][data-state=${state}]`);
const silent = (words: string) => viewer.page.locator("[data-test=saved][data-state=silent]", { hasText: words }).waitFor();
const notice = (words: string) => viewer.page.locator(".notice", { hasText: words });
const hasSketch = async () => (await viewer.page.locator("[data-test=undo]").getAttribute("title"))!.includes("Place a point");

/** Clicks a spline's points around the ball, and waits until the last one is there. */
async function clickSpline(): Promise<void> {
  await viewer.page.keyboard.press("s");
  for (const place of circle(await viewer.pixels("axial", BALL_RADIUS_MM), 6).slice(0, 6)) await viewer.click("axial", ...place);
  await viewer.waitForStep("undo", "Place a point");
}

async function drawByHand(): Promise<void> {
  await viewer.page.keyboard.press("f");
  await viewer.drag("axial", circle(await viewer.pixels("axial", BALL_RADIUS_MM), 36));
}

/** Redraws the right side of the circle that was drawn, from line to line. */
async function redraw(): Promise<void> {
  await viewer.page.keyboard.press("r");
  const radius = await viewer.pixels("axial", BALL_RADIUS_MM);
  await viewer.drag(
    "axial",
    Array.from({ length: 13 }, (_, i) => [radius * (1 + 0.3 * Math.sin((Math.PI * i) / 12)) * Math.cos((i - 6) / 10), radius * Math.sin((i - 6) / 10)]),
  );
}

/** Loads the page again, with a connection that is lost in place of the first reply to this call. */
async function cutReplyTo(call: string): Promise<() => boolean> {
  let isCut = false;
  await viewer.page.routeWebSocket("**/api/socket", (socket) => {
    const beyond = socket.connectToServer();
    socket.onMessage((message) => {
      if (!isCut && String(message).includes(call)) {
        beyond.onMessage((reply) => String(reply).includes("result") && void socket.close()); // what comes before is kept back, too
        isCut = true;
      }
      beyond.send(message);
    });
  });
  await viewer.page.reload();
  await viewer.ready();
  return () => isCut;
}

/** No file may grow any longer, or all may. */
const fillDisk = (full: boolean) =>
  assert.equal(spawnSync("prlimit", ["--pid", String(server.pid), `--fsize=${full ? "4096" : "unlimited"}:unlimited`]).status, 0);

const restart = async () => (server = await Server.start(folder.path, project, "--port", server.port, "--token", server.token));

describe("a contour that was closed", () => {
  for (const draw of [clickSpline, drawByHand])
    test(
      `stays while the disk is full, and is saved once by Enter when it is not (${draw.name})`,
      { skip: !canFillDisk && "there is no prlimit" },
      async () => {
        const { page } = viewer;
        if (draw === clickSpline) await clickSpline();
        fillDisk(true);
        if (draw === drawByHand) await drawByHand();
        else await page.keyboard.press("Enter");
        await notice("is not saved").waitFor();
        await saved("unsaved");
        await page.keyboard.press("v"); // takes leave of what is only begun
        assert.ok(await hasSketch());
        await page.click("[data-test=export]");
        await page.locator("[data-test=export-missing]").waitFor();
        await page.keyboard.press("Escape");
        fillDisk(false);
        await page.keyboard.press("Enter");
        await viewer.waitForContours(1);
        await saved("saved");
        assert.equal(await notice("is not saved").count(), 0);
        await page.reload();
        await viewer.ready();
        assert.equal(await viewer.contours(), 1);
        assert.ok(!(await hasSketch()));
      },
    );

  test("stays when kontur was killed; the page says what is lost and where to go on, and saves when it is back", async () => {
    const { page } = viewer;
    await clickSpline();
    await server.end("SIGKILL");
    await saved("lost");
    await notice("the address that it prints then").waitFor();
    await page.keyboard.press("Enter");
    await notice("is not saved").waitFor();
    assert.ok((await notice("is not saved").textContent())!.includes(`--port ${server.port} --token ${server.token}`), "as it is started again below");
    assert.match((await page.locator("[data-test=saved]").textContent())!, /not all is saved/);
    assert.ok(await hasSketch());
    await restart();
    await saved("unsaved");
    assert.equal(await notice("the address that it prints then").count(), 0);
    assert.equal(await notice("is not saved").count(), 1);
    await page.keyboard.press("Enter");
    await viewer.waitForContours(1);
    await saved("saved");
  });

  test("is there once if it was saved and only the reply was lost", async () => {
    const { page } = viewer;
    const isCut = await cutReplyTo("contour.add");
    await clickSpline();
    await page.keyboard.press("Enter");
    await notice("had been saved").waitFor();
    assert.ok(isCut());
    assert.equal(await viewer.contours(), 1);
    assert.ok(!(await hasSketch()));
    await saved("saved");
  });
});

describe("a piece that was redrawn", () => {
  /** The project's history, which undo leads back through, has the piece once. */
  async function isThereOnce(): Promise<void> {
    await saved("saved");
    await viewer.waitForStep("undo", "Redraw a part");
    assert.equal(await viewer.contours(), 1);
    await viewer.page.keyboard.press("Control+z");
    await viewer.waitForStep("undo", "Draw a contour");
  }

  test("stays while the disk is full, and is saved once by Enter when it is not", { skip: !canFillDisk && "there is no prlimit" }, async () => {
    const { page } = viewer;
    await drawByHand();
    await viewer.waitForStep("undo", "Draw a contour");
    fillDisk(true);
    await redraw();
    await notice("The piece that you redrew is not saved").waitFor();
    await saved("unsaved");
    await page.keyboard.press("v"); // takes leave of what is only begun
    await page.click("[data-test=export]");
    await page.locator("[data-test=export-missing]").waitFor();
    await page.keyboard.press("Escape");
    fillDisk(false);
    await page.keyboard.press("Enter");
    await isThereOnce();
    assert.equal(await notice("is not saved").count(), 0);
  });

  test("stays when kontur was killed, and is saved once by Enter when it is back", async () => {
    const { page } = viewer;
    await drawByHand();
    await viewer.waitForStep("undo", "Draw a contour");
    await server.end("SIGKILL");
    await saved("lost");
    await redraw();
    await notice(`--port ${server.port} --token ${server.token}`).waitFor();
    await restart();
    await saved("unsaved");
    await page.keyboard.press("Enter");
    await isThereOnce();
  });

  test("is there once if it was saved and only the reply was lost", async () => {
    const isCut = await cutReplyTo("contour.redraw");
    await drawByHand();
    await viewer.waitForStep("undo", "Draw a contour");
    await redraw();
    await notice("had been saved").waitFor();
    assert.ok(isCut());
    await isThereOnce();
  });
});

describe("a kontur that is suspended", () => {
  test("is said not to answer while an edit waits, and when it goes on has the edit once", async () => {
    const { page } = viewer;
    await clickSpline();
    server.suspend();
    await page.keyboard.press("Enter");
    await silent("your last edit waits for it");
    assert.equal(await viewer.contours(), 0);
    server.resume();
    await viewer.waitForContours(1);
    await saved("saved");
    assert.ok(!(await hasSketch()));
    await viewer.waitForStep("undo", "Draw a contour");
    await page.keyboard.press("Control+z");
    await viewer.waitForContours(0);
    await page.waitForSelector("[data-test=undo]:disabled");
    assert.deepEqual(viewer.complaints, []);
  });

  test("is said not to answer while nothing is done; what is done then waits for it, too", async () => {
    const { page } = viewer;
    await drawByHand();
    await viewer.waitForStep("undo", "Draw a contour");
    await saved("saved");
    const before = await viewer.slice("axial");
    server.suspend();
    await silent("the page waits for it");
    await redraw();
    await silent("your last edit waits for it");
    await page.mouse.wheel(0, 120);
    server.resume();
    await saved("saved");
    await viewer.slicesShown();
    assert.notEqual(await viewer.slice("axial"), before);
    assert.equal(await page.locator(".notice").count(), 0);
    await viewer.waitForStep("undo", "Redraw a part");
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("undo", "Draw a contour");
    assert.deepEqual(viewer.complaints, []);
  });

  test("and then killed leaves the contour that was closed meanwhile on its slice", async () => {
    const { page } = viewer;
    await clickSpline();
    server.suspend();
    await page.keyboard.press("Enter");
    await silent("your last edit waits for it");
    await server.end("SIGKILL");
    await saved("lost");
    await notice("The contour that you closed is not saved").waitFor();
    await restart();
    await saved("unsaved");
    await page.keyboard.press("Enter");
    await viewer.waitForContours(1);
    await saved("saved");
  });
});

test("a kontur that takes long over a call is not said not to answer", async () => {
  const { page } = viewer;
  let isBusy = false;
  await page.routeWebSocket("**/api/socket", (socket) => {
    const beyond = socket.connectToServer();
    beyond.onMessage((message) => isBusy || socket.send(message));
  });
  await page.reload();
  await viewer.ready();
  isBusy = true;
  await drawByHand();
  for (let i = 0; i < 3; ++i) await page.waitForResponse("**/icon.svg"); // each asked for 5 s after the one before
  assert.equal(await page.getAttribute("body", "data-connection"), "open");
  assert.equal(await page.getAttribute("[data-test=saved]", "data-state"), "saving");
});

describe("without a connection", () => {
  test("an edit that kontur had not confirmed is said to be perhaps lost, until one is saved", async () => {
    const { page } = viewer;
    let isCut = false;
    await page.routeWebSocket("**/api/socket", (socket) => {
      const beyond = socket.connectToServer();
      socket.onMessage((message) => {
        if (isCut || !String(message).includes("structure.set")) return beyond.send(message);
        isCut = true;
        return void socket.close();
      });
    });
    await page.reload();
    await viewer.ready();
    const hide = page.locator(".structure-row .icon-button").first();
    await hide.click();
    await notice("it may not be saved").waitFor();
    await saved("unsaved");
    assert.equal(await notice("is lost. What was saved").count(), 0, "it is connected again");
    await hide.click();
    await saved("saved");
  });

  test("an edit and an import say that nothing was done, and the list shows what is saved", async () => {
    const { page } = viewer;
    await server.end("SIGKILL");
    await saved("lost");
    await viewer.pickColor(page.locator(".structure .color"), "#3366ff");
    await notice("nothing was changed").waitFor();
    await page.waitForFunction(() => document.querySelector<HTMLInputElement>(".structure .color")!.value !== "#3366ff");
    const path = join(folder.path, "contours.json");
    writeFileSync(path, "{}");
    await viewer.import(path);
    await notice("kontur does not answer").waitFor();
    await restart();
    await saved("unsaved");
  });

  test("an address at which no kontur answers is named as such", async () => {
    const { page } = viewer;
    await page.goto("about:blank");
    await page.goto(server.address.replace(/.$/, (last) => (last === "a" ? "b" : "a")));
    await notice("the address that it printed last").waitFor();
  });
});

describe("a tab that is closed", () => {
  test("keeps the last point of a contour that is being drawn", async () => {
    await clickSpline();
    await viewer.page.reload();
    await viewer.ready();
    await viewer.waitForStep("undo", "Place a point");
    await viewer.page.keyboard.press("Enter");
    await viewer.waitForContours(1);
    assert.match((await viewer.page.locator(".contour-points").textContent())!, /^6/);
  });

  test("asks first where it cannot save what is being drawn", async () => {
    const { page } = viewer;
    const asked: string[] = [];
    page.on("dialog", (dialog) => {
      asked.push(dialog.type());
      void dialog.accept();
    });
    await clickSpline();
    await server.end("SIGKILL");
    await saved("lost");
    await page.goto("about:blank");
    assert.deepEqual(asked, ["beforeunload"]);
  });
});
