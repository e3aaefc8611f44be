// SPDX-License-Identifier: Apache-2.0
// What can be done to contours, views and files beyond the first visit (page.test.ts), each from a drawing of its own.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { beforeEach, describe, test } from "node:test";
import { onlyChromium } from "./browsers";
import { BALL_ML, BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;

interface Drawing {
  planes: { contours: { points: [number, number, number][] }[] }[];
}

const points = async (): Promise<[number, number, number][]> =>
  (JSON.parse((await viewer.export("contours.json")).bytes.toString()) as Drawing).planes.flatMap((plane) =>
    plane.contours.flatMap((contour) => contour.points),
  );
const most = (all: [number, number, number][], axis: number): number => Math.max(...all.map((p) => p[axis]!));
const near = (actual: number, expected: number, tolerance: number, what: string): void =>
  assert.ok(Math.abs(actual - expected) <= tolerance, `${what}: ${actual} is not ${expected} to within ${tolerance}`);
const isOrange = (r: number, g: number, b: number): boolean => Math.abs(r - 255) < 12 && Math.abs(g - 143) < 14 && Math.abs(b - 63) < 24;

/** A drawn line is light, in a tint of its structure's amber. */
const isContour = (r: number, g: number, b: number): boolean => r > 225 && r - b > 12 && r - b < 130 && r - g < 60;

/** Draws by hand around the ball, or a circle of another radius. */
async function drawBall(view: string, radius_mm = BALL_RADIUS_MM, contours = 1): Promise<number> {
  const radius = await viewer.drawBall(view, contours, radius_mm); // it is selected
  await viewer.page.keyboard.press("v");
  return radius;
}

beforeEach(async () => {
  viewer = await visits.next();
});

describe("contours", () => {
  test("a part is redrawn from the line back to the line", async () => {
    const radius = await drawBall("axial");
    const original = await points();
    await viewer.page.keyboard.press("r");
    const bulge = circle(radius, 36).slice(-4).concat(circle(radius, 36).slice(1, 5)); // 40 degrees on both sides of the right end
    const end = bulge.length - 1;
    await viewer.drag(
      "axial",
      bulge.map(([x, y], i): [number, number] => [x * (1 + 0.3 * Math.sin((Math.PI * i) / end)), y]),
    );
    await viewer.waitForStep("undo", "Redraw a part");
    await viewer.surfaceShown();
    const redrawn = await points();
    near(most(redrawn, 0), 1.3 * BALL_RADIUS_MM, 2, "the new part's end");
    near(most(redrawn, 1), most(original, 1), 0.2, "the rest");
    await viewer.page.keyboard.press("Control+z");
    await viewer.waitForStep("redo", "Redraw a part");
    assert.deepEqual(await points(), original);
  });

  test("a stretch is pulled, and the rest stays", async () => {
    const radius = await drawBall("axial");
    const pull = await viewer.pixels("axial", 8);
    await viewer.drag("axial", [
      [radius, 0],
      [radius + pull / 2, 0],
      [radius + pull, 0],
    ]);
    await viewer.waitForStep("undo", "Bend a contour");
    await viewer.surfaceShown();
    const pulled = await points();
    near(most(pulled, 0), BALL_RADIUS_MM + 8, 2, "the pulled end");
    near(most(pulled, 1), BALL_RADIUS_MM, 2, "the rest");
  });

  test("a contour is moved within its plane", async () => {
    const radius = await drawBall("axial");
    const by = await viewer.pixels("axial", 10);
    await viewer.page.keyboard.press("m");
    await viewer.drag("axial", [
      [0, radius],
      [by / 2, radius],
      [by, radius],
    ]);
    await viewer.waitForStep("undo", "Move a contour");
    const moved = await points();
    near(most(moved, 0), BALL_RADIUS_MM + 10, 2, "the moved end");
    near(most(moved, 1), BALL_RADIUS_MM, 2, "across");
  });

  test("under the hand outlines come unasked: no view asks for its slice, the 3D view for one mesh a surface", async () => {
    const radius = await drawBall("axial");
    await viewer.saved();
    await viewer.surfaceShown();
    const { page } = viewer;
    const asked: string[] = [];
    page.on("request", (request) => asked.push(request.url().replace(/^.*\/api\//, "")));
    const revisionsOf = () => page.evaluate(() => document.querySelector<HTMLElement>("[data-view=coronal]")!.dataset["revisions"]!);
    const first = await revisionsOf();
    await page.mouse.move(...(await viewer.at("axial", radius, 0)));
    await page.mouse.down();
    let before = first;
    for (const step of [4, 8, 12]) {
      await page.mouse.move(...(await viewer.at("axial", radius + step, 0)));
      await page.waitForFunction(
        (old) => [...document.querySelectorAll<HTMLElement>(".pane.slice")].every((pane) => pane.dataset["revisions"] !== old),
        before,
      );
      before = await revisionsOf();
    }
    await viewer.surfaceShown();
    const surfaces = Number((await revisionsOf()).split(":")[1]) - Number(first.split(":")[1]);
    assert.deepEqual(
      asked.filter((path) => !path.startsWith("mesh/")),
      [],
    );
    assert.ok(surfaces >= 4 && asked.length <= surfaces, `${asked.length} meshes for ${surfaces} surfaces`);
    asked.length = 0;
    await page.mouse.up();
    await viewer.saved();
    await viewer.slicesShown();
    assert.ok(asked.length <= 4 && asked.every((path) => path === "slice"), `the release moves the diamonds in four views: ${asked.join()}`);
  });

  test("points of a spline are inserted, dragged and deleted", async () => {
    const { page } = viewer;
    const radius = await viewer.pixels("coronal", BALL_RADIUS_MM);
    await page.keyboard.press("s");
    for (const place of circle(radius, 6).slice(0, 6)) await viewer.click("coronal", ...place);
    await page.keyboard.press("Enter");
    await viewer.waitForContours(1);
    await page.keyboard.press("v");
    const waitForPoints = (count: number) =>
      page.waitForFunction((wanted) => Number.parseInt(document.querySelector(".contour-points")!.textContent!.replace(/\D+/, ""), 10) === wanted, count);
    await waitForPoints(6);
    const [x, y] = circle(radius, 12)[1]!; // between two of the points
    await page.keyboard.down("Control");
    await viewer.click("coronal", x, y);
    await page.keyboard.up("Control");
    await viewer.waitForStep("undo", "Insert a point");
    await waitForPoints(7);
    await viewer.drag("coronal", [
      [x, y],
      [x + 6, y - 3],
      [x + 12, y - 6],
    ]);
    await viewer.waitForStep("undo", "Move a point");
    await page.keyboard.press("Delete");
    await viewer.waitForStep("undo", "Delete a point");
    await waitForPoints(6);
  });

  test("where two contradict each other a ring stands, and a click on its row goes there", async () => {
    await drawBall("axial");
    await drawBall("coronal", 1.3 * BALL_RADIUS_MM, 2);
    const row = viewer.page.locator("[data-test=conflict]").first();
    await row.waitFor();
    assert.match((await row.textContent())!, /disagree by \d/);
    await viewer.page.mouse.move(...(await viewer.at("axial", 20, 20)));
    await viewer.page.mouse.wheel(0, 600);
    const gone = await viewer.slice("axial");
    await row.click();
    await viewer.page.waitForFunction((slice) => document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["slice"] !== String(slice), gone);
    await viewer.slicesShown();
    for (const view of ["axial", "coronal"]) assert.ok((await viewer.countPixels(view, isOrange)) > 0, `a ring in the ${view} view`);
    assert.ok((await viewer.countPixels("surface", (r, g, b) => r > 190 && g > 90 && g < 160 && b < 110)) > 0, "a mark in 3D");
  });
});

describe("structures", () => {
  test("a hole takes its inside away; hidden contours still count, hidden structures are out of sight", async () => {
    const { page } = viewer;
    await drawBall("axial");
    await drawBall("coronal", BALL_RADIUS_MM, 2);
    await viewer.surfaceShown();
    const whole = await viewer.volume();
    await drawBall("axial", 0.5 * BALL_RADIUS_MM, 3);
    await page.keyboard.press("h");
    await page.waitForSelector(".flag");
    await viewer.surfaceShown();
    const hollow = await viewer.volume();
    assert.ok(hollow < 0.97 * whole, `${hollow} of ${whole} ml`);

    const row = page.locator(".contour-row").first();
    // A line that is not selected, and not what the fill makes of the image.
    const lines = () => viewer.countPixels("axial", (r, g, b) => isContour(r, g, b) && r - b > 70);
    const drawn = await lines();
    await row.hover();
    await row.locator("button[title=Hide]").click();
    await page.waitForSelector(".contour-row.off");
    await page.mouse.move(0, 0);
    await viewer.slicesShown();
    for (let tries = 0; (await lines()) >= drawn && tries < 50; ++tries) await page.waitForTimeout(100); // it is painted in the next frame
    assert.ok((await lines()) < drawn, "the axial view no longer shows it");
    assert.equal(await viewer.volume(), hollow);

    await page.locator(".structure-row button[title=Hide]").click();
    await page.waitForSelector(".structure-row button[title=Show]");
    await viewer.slicesShown();
    await page.waitForFunction(() => document.querySelector<HTMLElement>("[data-view=sagittal]")!.dataset["revisions"] === "");
    await page.keyboard.press("Control+z");
    await page.keyboard.press("Control+z");
    await page.waitForFunction(() => !document.querySelector(".contour-row.off"));
  });

  test("several, each with its name, colour and surface; contours change over", async () => {
    const { page } = viewer;
    await drawBall("axial");
    await viewer.addStructure();
    const second = page.locator(".structure").nth(1);
    await viewer.rename(1, "Lesion");
    await viewer.waitForStep("undo", "Rename");
    await viewer.pickColor(second.locator(".color"), "#3366ff");
    await viewer.waitForStep("undo", "Colour Lesion");
    await drawBall("coronal", 0.8 * BALL_RADIUS_MM, 2);
    assert.equal(await second.locator(".contour-row").count(), 1);
    await viewer.surfaceShown();
    const small = await viewer.volume();
    const isBlue = (r: number, g: number, b: number): boolean => b > 90 && b > 1.4 * g && b > 2 * r;
    assert.ok((await viewer.countPixels("coronal", isBlue)) > 0, "its outline has its colour");
    assert.equal((await viewer.export("mask.nii.gz")).name, "ball_Lesion.nii.gz");
    await page.locator(".contour-row").first().click();
    await page.locator("[data-test=owner]").selectOption({ label: "Lesion" });
    await viewer.waitForStep("undo", "Change a contour");
    await page.waitForFunction(() => document.querySelectorAll(".structure")[1]!.querySelectorAll(".contour-row").length === 2);
    await viewer.surfaceShown();
    assert.ok((await viewer.volume()) > 1.1 * small);
  });
});

describe("live-wire", () => {
  for (const view of ["axial", "oblique"])
    test(`finds the ball's edge from clicks beside it on the ${view} view`, async () => {
      const { page } = viewer;
      if (view === "oblique") {
        const box = (await viewer.pane("axial").boundingBox())!;
        const line = 0.33 * Math.min(box.width, box.height);
        await page.keyboard.press("v");
        await viewer.drag("axial", [
          [line * Math.SQRT1_2, line * Math.SQRT1_2],
          [line, line * 0.3],
        ]);
        await page.waitForSelector("[data-view=oblique][data-turned=true]");
        await viewer.slicesShown();
      }
      await page.keyboard.press("l");
      const beside = (await viewer.pixels(view, BALL_RADIUS_MM)) + 3;
      for (const place of circle(beside, 6).slice(0, 6)) await viewer.click(view, ...place);
      await page.keyboard.press("Enter");
      await viewer.waitForContours(1);
      const distances = (await points()).map((p) => Math.hypot(...p));
      near(Math.max(...distances), BALL_RADIUS_MM, 1.5, "the farthest point");
      near(Math.min(...distances), BALL_RADIUS_MM, 1.5, "the nearest point");
    });
});

describe("contours that contradict each other altogether", () => {
  test("have a surface between them, and are told with the places", async () => {
    await drawBall("axial");
    await drawBall("coronal", 0.1 * BALL_RADIUS_MM, 2);
    await viewer.surfaceShown();
    await viewer.page.locator("[data-test=conflict]").first().waitFor();
    assert.ok((await viewer.volume()) > 0.1 * BALL_ML);
  });
});

describe("a contour that is being drawn", () => {
  test("has points that undo and redo, comes back after Esc, and after the tab was closed", async () => {
    const { page } = viewer;
    const places = circle(await viewer.pixels("axial", BALL_RADIUS_MM), 8);
    await page.keyboard.press("s");
    for (const place of places.slice(0, 5)) await viewer.click("axial", ...place);
    await page.keyboard.press("Control+z");
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("redo", "Place a point");
    await page.keyboard.press("Control+Shift+z");
    await page.keyboard.press("Control+Shift+z");
    await page.waitForSelector("[data-test=redo]:disabled");
    await page.keyboard.press("Escape");
    await viewer.waitForStep("undo", "Leave the contour");
    await page.keyboard.press("Control+z");
    await viewer.waitForStep("undo", "Place a point");
    await page.waitForTimeout(1000); // longer than the page waits before it saves where the user is
    await page.reload();
    await viewer.ready();
    await viewer.waitForStep("undo", "Place a point");
    for (const place of places.slice(5, 8)) await viewer.click("axial", ...place);
    await page.keyboard.press("Enter");
    await viewer.waitForContours(1);
    await viewer.surfaceShown();
    near(await viewer.volume(), BALL_ML, 0.35 * BALL_ML, "volume from one contour");
  });
});

describe("views", () => {
  test("a dragged line moves its plane, a dragged dot turns it, and the title's arrow brings it back", async () => {
    const { page } = viewer;
    await page.keyboard.press("v");
    const box = (await viewer.pane("axial").boundingBox())!;
    const reach = 0.33 * Math.min(box.width, box.height);
    const before = await viewer.slice("coronal");
    await viewer.drag("axial", [
      [0.6 * reach, 0],
      [0.6 * reach, 15],
      [0.6 * reach, 30],
    ]);
    await page.waitForFunction((slice) => document.querySelector<HTMLElement>("[data-view=coronal]")!.dataset["slice"] !== String(slice), before);
    assert.equal(await viewer.pane("coronal").getAttribute("data-turned"), "false");
    const moved = 30; // the crosshair has gone down with the line
    await viewer.drag("axial", [
      [reach, moved],
      [reach * Math.cos(0.2), moved + reach * Math.sin(0.2)],
      [reach * Math.cos(0.5), moved + reach * Math.sin(0.5)],
    ]);
    await page.waitForSelector("[data-view=coronal][data-turned=true]");
    await viewer.slicesShown();
    await viewer.pane("coronal").hover();
    await viewer.pane("coronal").locator("[data-test=reset-coronal]").click();
    await page.waitForSelector("[data-view=coronal][data-turned=false]");
  });

  test("the window follows a right drag, a preset and typed numbers", async () => {
    const { page } = viewer;
    const numbers = () => page.locator(".toolbar .number").evaluateAll((inputs) => inputs.map((input) => Number((input as HTMLInputElement).value)));
    const [center, width] = await numbers();
    await viewer.drag(
      "axial",
      [
        [0, 0],
        [20, 10],
        [40, 20],
      ],
      "right",
    );
    const [darker, wider] = await numbers();
    assert.ok(darker! > center! && wider! > width!, `${darker} / ${wider} from ${center} / ${width}`);
    const before = await viewer.pane("axial").screenshot();
    await viewer.type(page.locator(".toolbar .number").nth(1), "20");
    await page.keyboard.press("Enter");
    assert.equal((await numbers())[1], 20);
    await page.keyboard.press("l");
    await page.waitForSelector("[data-test=tool-wire][aria-pressed=true]");
    await viewer.slicesShown();
    assert.notDeepEqual(await viewer.pane("axial").screenshot(), before);
  });

  test("every button says what it does, and ? lists mouse and keyboard", async () => {
    const { page } = viewer;
    const silent = await page.locator("button").evaluateAll((buttons) => buttons.filter((one) => !(one as HTMLButtonElement).title).length);
    assert.equal(silent, 0);
    await page.keyboard.press("?");
    const sheet = page.locator("[data-test=help-dialog]");
    await sheet.waitFor();
    const box = (await sheet.boundingBox())!;
    assert.ok(box.y >= 0 && box.y + box.height <= 720, "it fits at 1280 x 720");
    for (const words of ["Shift + move", "propose the outline on the next", "insert a point"]) assert.ok((await sheet.textContent())!.includes(words));
    await page.keyboard.press("l"); // the sheet has the keyboard
    await page.keyboard.press("Escape");
    await page.waitForSelector("[data-test=help-dialog]", { state: "detached" });
    assert.equal(await page.locator("[data-test=tool-wire]").getAttribute("aria-pressed"), "true");
  });

  test(
    "a slice that another request overtook is asked for again, under the name of this load of the page",
    onlyChromium("Playwright is not told what Firefox's requests hold"),
    async () => {
      const { page } = viewer;
      const pages = new Set<unknown>();
      let refusals = 3;
      await page.route("**/api/slice", async (route) => {
        const request = route.request().postDataJSON() as { view: string; page: unknown; pixels: boolean };
        pages.add(request.page);
        if (request.view !== "axial" || !request.pixels || refusals === 0) return route.continue();
        --refusals;
        return route.fulfill({ status: 409, json: { error: { kind: "cancelled", message: "a later slice of this view was asked for" } } });
      });
      const before = Number(await viewer.pane("axial").getAttribute("data-slices"));
      await page.mouse.move(...(await viewer.at("axial", 0, 0)));
      await page.mouse.wheel(0, 120);
      await page.waitForFunction((count) => Number(document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["slices"]) > count, before);
      assert.equal(refusals, 0);
      const [name] = pages;
      assert.equal(pages.size, 1);
      assert.match(String(name), /^[0-9a-f]{16,64}$/);
      assert.equal(await page.locator(".notice").count(), 0);
    },
  );

  test(
    "a slice that was made before a surface, and comes after it, is asked for again",
    onlyChromium("Playwright cannot send Firefox's requests itself"),
    async () => {
      const { page } = viewer;
      const radius = await drawBall("axial");
      await viewer.surfaceShown();
      await viewer.slicesShown();
      const revisionOf = (view: string) => page.evaluate((name) => document.querySelector<HTMLElement>(`[data-view=${name}]`)!.dataset["revisions"]!, view);
      const scroll = async (by: 1 | -1) => {
        const number = (await viewer.slice("sagittal")) + by;
        await page.mouse.move(...(await viewer.at("sagittal", 0, 0)));
        await page.mouse.wheel(0, by * 120);
        await page.waitForSelector(`[data-view=sagittal][data-slice="${number}"]`);
      };
      let made: Buffer | undefined; // the next slice with the first surface
      await page.route("**/api/slice", async (route) => {
        const response = await route.fetch();
        made = await response.body();
        return route.fulfill({ response });
      });
      await scroll(1);
      await viewer.slicesShown();
      await page.unroute("**/api/slice");
      await scroll(-1);
      await viewer.slicesShown();

      let comes = () => {};
      const isTime = new Promise<void>((resolve) => (comes = resolve));
      await page.route("**/api/slice", (route) => isTime.then(() => route.fulfill({ body: made! })), { times: 1 });
      const first = await revisionOf("sagittal");
      await scroll(1);
      await page.mouse.move(...(await viewer.at("axial", radius, 0)));
      await page.mouse.down();
      await page.mouse.move(...(await viewer.at("axial", radius + 8, 0)));
      await page.waitForFunction((old) => document.querySelector<HTMLElement>("[data-view=sagittal]")!.dataset["revisions"] !== old, first);
      await viewer.surfaceShown();
      comes();
      await viewer.slicesShown();
      await viewer.surfaceShown();
      assert.equal(await revisionOf("sagittal"), await revisionOf("coronal"));
      await page.mouse.up();
      await viewer.saved();
    },
  );

  test("zoom and shift one slice, or all that are linked", async () => {
    const { page } = viewer;
    const scales = () => Promise.all(["axial", "coronal", "oblique"].map(async (view) => Number(await viewer.pane(view).getAttribute("data-pixels-per-mm"))));
    const start = await scales();
    const zoom = async () => {
      await page.mouse.move(...(await viewer.at("axial", 20, 10)));
      await page.keyboard.down("Control");
      await page.mouse.wheel(0, -200);
      await page.keyboard.up("Control");
      await viewer.slicesShown();
    };
    await zoom();
    const alone = await scales();
    assert.ok(alone[0]! > 1.3 * start[0]! && alone[1] === start[1]);
    await page.keyboard.press("k");
    await page.waitForSelector("[data-test=link][aria-pressed=true]");
    await zoom();
    const linked = await scales();
    linked.forEach((scale, i) => near(scale / alone[i]!, linked[0]! / alone[0]!, 1e-6, "the same zoom"));
    assert.ok(linked[2]! > 1.3 * alone[2]!);
    await page.keyboard.press("Home");
    await viewer.slicesShown();
    assert.deepEqual(await scales(), start);
  });
});

describe("files", () => {
  test("a mask is traced into contours that give its surface again", async () => {
    await drawBall("axial");
    await drawBall("coronal", BALL_RADIUS_MM, 2);
    await viewer.surfaceShown();
    const drawn = await viewer.volume();
    const mask = join(visits.folder.path, "ball mask.nii.gz");
    writeFileSync(mask, (await viewer.export("mask.nii.gz")).bytes);
    await viewer.import(mask);
    await viewer.page.check("[data-test=import-as-contours]");
    await viewer.page.click("[data-test=import-mask]");
    await viewer.page.waitForFunction(() => document.querySelectorAll(".structure").length === 2);
    await viewer.page.waitForFunction(() => document.querySelectorAll(".contour-row").length > 15);
    await viewer.page.waitForSelector(".panel:not([data-structure='1'])");
    await viewer.surfaceShown();
    near(await viewer.volume(), drawn, 0.03 * drawn, "volume");
    await viewer.page.keyboard.press("Control+z");
    await viewer.waitForContours(2);
  });

  test("an export is cancelled", async () => {
    await drawBall("axial");
    await viewer.surfaceShown();
    const { page } = viewer;
    let letGo = () => {};
    const isCancelled = new Promise<void>((resolve) => (letGo = resolve));
    await page.route("**/api/export/**", async (route) => {
      await isCancelled; // however long the click takes
      await route.continue().catch(() => undefined); // it was cancelled meanwhile
    });
    await page.click("[data-test=export]");
    await page.click('[data-test="export-mask.nrrd"]');
    await page.click("[data-test=export-cancel]");
    await page.waitForFunction(() => document.querySelector(".dialog-status")!.textContent === "Cancelled.");
    letGo();
    await page.unroute("**/api/export/**");
    await page.keyboard.press("Escape");
    assert.equal((await viewer.export("mask.nrrd")).bytes.subarray(0, 4).toString(), "NRRD");
  });
});
