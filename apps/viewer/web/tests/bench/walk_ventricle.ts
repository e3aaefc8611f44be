// SPDX-License-Identifier: Apache-2.0
// Segments the left ventricle of a real cine MR (10_cine_mr_SC-HF-I-1 in the folder that KONTUR_TEST_DATA names) by strokes at the
// pace of a hand: every second slice of the short axis, and two planes along it. Prints how long that took and how well it agrees
// with the reader who drew all slices. Run by bench/viewer walk_ventricle.
import { existsSync } from "node:fs";
import { join } from "node:path";
import { launch } from "../e2e/browsers";
import { Server, temporaryFolder, Viewer } from "../e2e/support";
import { Truth } from "./truth";
import { User } from "./user";

const data = join(process.env["KONTUR_TEST_DATA"] ?? "../shared/data", "10_cine_mr_SC-HF-I-1");
if (!existsSync(data)) {
  console.log(`skipped: there is no ${data}`);
  process.exit(0);
}
const END_DIASTOLE = "2"; // frame
const folder = temporaryFolder();
const browser = await launch();
try {
  const mask = join(data, "mask_ED_endo.nii.gz");
  const truth = new Truth(mask);
  const server = await Server.start(folder.path, join(data, "cine4d_crop.nii.gz"), "--frame", END_DIASTOLE);
  const viewer = await Viewer.open(browser, server.address);
  const user = new User(viewer, truth);
  await user.takesFreehand();
  const [acquisition, row, column] = await viewer.page
    .locator(".pane.slice")
    .evaluateAll((panes) => ["1", "2", "3"].map((place) => panes.find((pane) => (pane as HTMLElement).dataset["place"] === place)!.getAttribute("data-view")!));
  const target = truth.center();
  await user.scrollsTo(acquisition!, target);
  await user.jumpsTo(acquisition!, target);
  user.says("found");
  await user.zooms(acquisition!, 1, target);
  for (const k of truth.slices().filter((_, n) => n % 2 === 0)) {
    const [i, j] = truth.indexOf(target);
    await user.scrollsTo(acquisition!, truth.at([i, j, k]));
    const { outlines } = await user.sees(acquisition!);
    await user.strokesAround(acquisition!, outlines[0]!);
    user.says(`drawn on slice ${k + 1}`);
  }
  for (const view of [row!, column!]) {
    await user.jumpsTo(acquisition!, target);
    const { outlines } = await user.sees(view);
    await user.strokesAround(view, outlines[0]!);
    user.says(`drawn in the ${view === row ? "row" : "column"} view`);
  }
  await user.photographs("walk_ventricle");
  await user.exports(folder.path, mask);
  await server.end();
} finally {
  await browser.close();
  folder.remove();
}
