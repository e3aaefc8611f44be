// SPDX-License-Identifier: Apache-2.0
// Segments a made aortic arch by strokes at the pace of a hand: along it in the oblique view, then across both of its legs in axial
// slices. Prints how long that took and how good it is. Run by bench/viewer walk_arch.
import { join } from "node:path";
import { launch } from "../e2e/browsers";
import { Server, temporaryFolder, Viewer } from "../e2e/support";
import { writeArch } from "./arch";
import { along, Truth, type Vec3 } from "./truth";
import { User } from "./user";

const folder = temporaryFolder();
const browser = await launch();
try {
  const [image, mask] = [join(folder.path, "arch.nii"), join(folder.path, "arch_truth.nii")];
  writeArch(image, mask);
  const truth = new Truth(mask);
  const server = await Server.start(folder.path, image);
  const viewer = await Viewer.open(browser, server.address);
  const user = new User(viewer, truth);
  await user.takesFreehand();
  const oblique = await user.sees("oblique");
  await user.strokesAround("oblique", oblique.outlines[0]!);
  user.says("drawn along the arch");
  const middle: Vec3 = [0, 0, 0];
  for (const z of [5, -30]) {
    await user.scrollsTo("axial", along(middle, [0, 0, 1], z));
    const { outlines } = await user.sees("axial");
    for (const line of outlines.slice(0, 2)) await user.strokesAround("axial", line);
    user.says(`drawn across its legs at ${z} mm`);
  }
  await user.photographs("walk_arch");
  await user.exports(folder.path, mask);
  await server.end();
} finally {
  await browser.close();
  folder.remove();
}
