// SPDX-License-Identifier: Apache-2.0
// What is measured, and what leaves the page for all structures at once.
import assert from "node:assert/strict";
import { beforeEach, describe, test } from "node:test";
import { gunzipSync } from "node:zlib";
import { downloaded, onlyChromium } from "./browsers";
import { BALL_ML, BALL_RADIUS_MM, BallVisits, circle, Viewer } from "./support";

const visits = new BallVisits();
let viewer: Viewer;
const SMALL_MM = 15;

/** The ball, and a smaller one of a structure of its own in its middle. */
async function draw(empty: Viewer): Promise<void> {
  await empty.page.keyboard.press("f");
  let contours = 0;
  for (const radius of [BALL_RADIUS_MM, SMALL_MM]) {
    if (radius === SMALL_MM) await empty.addStructure();
    for (const view of ["axial", "coronal"]) {
      await empty.drag(view, circle(await empty.pixels(view, radius), 36));
      await empty.waitForContours(++contours);
    }
  }
}

beforeEach(async () => {
  viewer = await visits.nextDrawn(draw);
});

describe("all structures", () => {
  test("are measured: volume, surface, diameter, values; the table is saved as CSV", async () => {
    const { page } = viewer;
    await page.click("[data-test=statistics-open]");
    const row = async (head: string) =>
      (
        await page
          .locator("[data-test=statistics] tr", { has: page.locator(`th:text-is("${head}")`) })
          .locator("td")
          .allInnerTexts()
      ).map(Number);
    await page.locator("[data-test=statistics]").waitFor();
    const [large, small] = await row("Volume, ml");
    const ball = (mm: number) => BALL_ML * (mm / BALL_RADIUS_MM) ** 3;
    assert.ok(Math.abs(large! / ball(40) - 1) < 0.05 && Math.abs(small! / ball(SMALL_MM) - 1) < 0.1, `${large} and ${small} ml`);
    const [diameter] = await row("Largest diameter, mm");
    assert.ok(Math.abs(diameter! - 80) < 4, `${diameter} mm`);
    const [area] = await row("Surface, cm²");
    assert.ok(Math.abs(area! / (4 * Math.PI * 16) - 1) < 0.05, `${area} cm²`);
    const [, mean] = await row("Mean"); // inside of the ball: 100 and a noise of 0 to 20
    assert.ok(Math.abs(mean! - 110) < 1, `mean ${mean}`);
    const [, deviation] = await row("Deviation");
    assert.ok(Math.abs(deviation! - Math.sqrt((21 ** 2 - 1) / 12)) < 0.5, `deviation ${deviation}`);
    const table = await downloaded(page, () => page.click("[data-test=statistics-csv]"));
    const csv = table.bytes.toString().split("\r\n");
    assert.equal(csv.length, 4);
    assert.match(csv[0]!, /^Structure,Contours,"Volume, ml",/);
    assert.match(csv[2]!, /^Structure 2,2,/);
  });

  test("are compared two by two, as two readers' drawings of one are", async () => {
    const { page } = viewer;
    await page.click("[data-test=statistics-open]");
    await page.click("[data-test=compare]");
    const row = async (head: string) =>
      Number.parseFloat(
        await page
          .locator("[data-test=comparison] tr", { has: page.locator(`th:text-is("${head}")`) })
          .locator("td")
          .innerText(),
      );
    await page.locator("[data-test=comparison] tr").first().waitFor();
    const [large, small] = [BALL_RADIUS_MM ** 3, SMALL_MM ** 3];
    assert.ok(Math.abs((await row("Dice")) - (2 * small) / (large + small)) < 0.02, `Dice ${await row("Dice")}`);
    const apart = BALL_RADIUS_MM - SMALL_MM;
    assert.ok(Math.abs((await row("Mean distance of the surfaces")) - apart) < 3, `mean ${await row("Mean distance of the surfaces")} mm`);
    assert.ok(Math.abs((await row("95 % of the distances are within")) - apart) < 5, `95 % ${await row("95 % of the distances are within")} mm`);
    assert.ok(Math.abs((await row("Volume of Structure 1")) / BALL_ML - 1) < 0.06);
    await page.locator("[data-test=compare-second]").selectOption({ label: "Structure 1" });
    await page.click("[data-test=compare]");
    await page.locator(".comparison .dialog-status", { hasText: "Structure 1 would be compared with itself; 2 structures are needed" }).waitFor();
  });

  test("that another window removes meanwhile are neither compared nor exported, and that is said", async () => {
    const { page } = viewer;
    const other = await Viewer.open(visits.browser, visits.server.address);
    const remove = async (name: string) => {
      const row = other.page.locator(".structure-row", { hasText: name });
      await row.hover();
      await row.locator("[data-part=remove]").click();
      await row.waitFor({ state: "detached" });
    };
    await page.click("[data-test=statistics-open]");
    await page.locator("[data-test=compare]").waitFor();
    await remove("Structure 2");
    await page.click("[data-test=compare]");
    await page.locator(".comparison .dialog-status", { hasText: "One of the two has been removed meanwhile: they cannot be compared." }).waitFor();
    await page.keyboard.press("Escape");
    await page.click("[data-test=export]");
    await remove("Structure 1");
    await page.click("[data-test='export-mask.nii.gz']");
    await page.locator(".dialog-status", { hasText: "The structure has been removed meanwhile: there is nothing to export." }).waitFor();
    await other.page.close();
    assert.deepEqual(viewer.complaints, []);
  });

  test("are coloured in 3D by how far one is from another", async () => {
    const { page } = viewer;
    const isBlue = (r: number, _: number, b: number) => b - r > 30; // the ground stays below, the small ball above
    const before = await viewer.countPixelsAtRest("surface", isBlue);
    await page.click("[data-test=statistics-open]");
    await page.locator("[data-test=compare-first]").selectOption({ label: "Structure 2" });
    assert.equal(await page.locator("[data-test=compare-map]").isDisabled(), true, "with itself");
    await page.locator("[data-test=compare-second]").selectOption({ label: "Structure 1" });
    await page.click("[data-test=compare-map]");
    const scale = page.locator("[data-test=band-scale]");
    await scale.filter({ hasText: "50 mm inside Structure 1" }).waitFor(); // 25 mm; scales end at 1, 2 or 5 times a power of ten
    assert.match((await scale.textContent())!, /50 mm outside$/);
    await viewer.waitForPixels("surface", isBlue, (count) => count > before + 5000);
    await page.click("[data-test=scale-end]");
    await scale.waitFor({ state: "hidden" });
    await viewer.waitForPixels("surface", isBlue, (count) => count < before + 200);
    assert.deepEqual(viewer.complaints, []);
  });

  test("go into one label map, where the smaller one keeps its voxels, and that is said", async () => {
    const { bytes } = await viewer.export("labels.nii.gz");
    await viewer.page.locator(".notice", { hasText: "belong to Structure 2, the smaller one" }).waitFor();
    const file = gunzipSync(bytes);
    const voxels = file.subarray(Math.round(file.readFloatLE(108)));
    const ml = [1, 2].map((label) => (voxels.filter((value) => value === label).length * 2 * 2 * 4) / 1000);
    const inner = BALL_ML * (SMALL_MM / BALL_RADIUS_MM) ** 3;
    assert.ok(Math.abs(ml[1]! / inner - 1) < 0.15 && Math.abs((ml[0]! + ml[1]!) / BALL_ML - 1) < 0.06, `${ml}`);
  });

  test("go into one archive of surfaces, named as they are", async () => {
    await viewer.rename(0, "Liver/left");
    await viewer.saved();
    const { name, bytes } = await viewer.export("meshes.stl.zip");
    assert.match(name, /_meshes\.stl\.zip$/);
    const names = [...bytes.toString("latin1").matchAll(/PK\x01\x02[^]{42}([\w.-]+?\.stl)/g)].map(([, file]) => file);
    assert.deepEqual(names, ["Liver_left.stl", "Structure_2.stl"]);
  });

  test("of an image that is no DICOM are not offered as DICOM", async () => {
    await viewer.page.click("[data-test=export]");
    await viewer.page.locator('[data-test="export-labels.nii.gz"]').waitFor();
    assert.equal(await viewer.page.locator('[data-test="export-rtstruct.dcm"]').count(), 0);
  });
});

describe("the measuring tool", () => {
  const shows = (wanted: RegExp) =>
    viewer.page.waitForFunction(
      (pattern) => new RegExp(pattern).test(document.querySelector<HTMLElement>("[data-view=axial]")!.dataset["measured"] ?? ""),
      wanted.source,
    );

  test("tells distances and angles, which come back with the project; Del takes the last away", async () => {
    const { page } = viewer;
    await page.keyboard.press("d");
    const far = await viewer.pixels("axial", 30);
    await viewer.drag("axial", [
      [-far, 20],
      [-far / 2, 20],
      [0, 20],
    ]);
    await shows(/^(29|30)\.\d mm$/);
    for (const [x, y] of [
      [60, -60],
      [20, -60],
      [20, -20],
    ] as const)
      await viewer.click("axial", x, y);
    await shows(/mm; 90\.0°$/);
    await page.waitForTimeout(1000); // the page keeps it a moment after
    await page.reload();
    await viewer.ready();
    await shows(/mm; 90\.0°$/);
    await page.keyboard.press("d");
    await page.keyboard.press("Delete");
    await shows(/^(29|30)\.\d mm$/);
    assert.equal(await viewer.contours(), 4);
  });
});

describe("the window", () => {
  test(
    "is dragged without a picture from the server: the image's values are there, or come once for each slice",
    onlyChromium("Playwright is not told what Firefox's requests hold"),
    async () => {
      const { page } = viewer;
      await viewer.slicesShown();
      const asked: string[] = [];
      page.on(
        "request",
        (request) => void (request.url().endsWith("/api/slice") && asked.push((JSON.parse(request.postData()!) as { pixels: string }).pixels)),
      );
      const bright = () => viewer.countPixels("coronal", (r, g, b) => r > 60 && r === g && g === b);
      const path = (to: number): [number, number][] => Array.from({ length: 31 }, (_, i) => [(to * i) / 30, (-to * i) / 30]);
      const typed = await page.locator(".toolbar .number").evaluateAll((fields) => fields.map((field) => (field as HTMLInputElement).value));
      const takeBack = async () => {
        await viewer.drag("coronal", path(-90), "right");
        for (const [i, value] of typed.entries()) {
          await viewer.type(page.locator(".toolbar .number").nth(i), value);
          await page.keyboard.press("Enter");
        }
        await viewer.slicesShown();
      };
      const seen = await bright();
      await viewer.drag("coronal", path(90), "right");
      assert.notEqual(await bright(), seen);
      await takeBack();
      assert.deepEqual(asked, [], "a screen that is finer than the image has its values");

      await viewer.zoomOut("coronal");
      const before = await bright();
      asked.length = 0;
      await viewer.drag("coronal", path(90), "right");
      await viewer.slicesShown();
      const values = asked.filter((pixels) => pixels === "values").length;
      assert.ok(values >= 2 && asked.length <= 8, asked.join()); // axial and oblique: along the other slices' columns voxels are too far apart
      assert.notEqual(await bright(), before);
      asked.length = 0;
      await takeBack();
      assert.deepEqual(asked, []);
      assert.ok(Math.abs((await bright()) - before) <= 0.02 * before + 5, "and back as it was");
    },
  );
});
