// SPDX-License-Identifier: Apache-2.0
// A new user's first structure, at the pace of a hand: opens the phantom, finds the metastasis in the liver, drags around
// it in two views, accepts the outline that kontur expects where a third contour tells most, and exports the mask.
// Prints how long that took and how good it is. Run by bench/viewer walk.
import { join } from "node:path";
import { launch } from "../e2e/browsers";
import { run, Server, temporaryFolder, Viewer } from "../e2e/support";
import { Truth } from "./truth";
import { CHOOSE_MS, READ_HINT_MS, User } from "./user";

const folder = temporaryFolder();
const browser = await launch();
try {
  run("phantom", folder.path, "--scan", "abdomen", "--quiet");
  const path = join(folder.path, "abdomen_truth_metastasis.nii.gz");
  const truth = new Truth(path);
  const target = truth.center();
  const server = await Server.start(folder.path, "phantom");
  const viewer = await Viewer.open(browser, server.address);
  await viewer.page.setViewportSize({ width: 1600, height: 900 });
  const user = new User(viewer, truth);
  await user.waits(READ_HINT_MS);
  await viewer.closeHint(); // which takes live-wire
  await user.waits(CHOOSE_MS);
  await viewer.page.selectOption("[data-test=presets]", { label: "Liver" });
  await user.waits(CHOOSE_MS);
  await user.scrollsTo("axial", target);
  await user.jumpsTo("axial", target);
  user.says("found");
  for (const view of ["axial", "coronal"]) {
    await user.zooms(view, 3, target);
    const { outlines } = await user.sees(view);
    await user.strokesAround(view, outlines[0]!);
    user.says(`drawn in the ${view} view`);
  }
  await user.acceptsProposal();
  user.says("proposal accepted");
  await user.photographs("walk");
  await user.exports(folder.path, path);
  await server.end();
} finally {
  await browser.close();
  folder.remove();
}
