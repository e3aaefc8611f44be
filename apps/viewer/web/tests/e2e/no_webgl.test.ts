// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { join } from "node:path";
import { test } from "node:test";
import { launch, NO_WEBGL } from "./browsers";
import { BALL_RADIUS_MM, circle, Server, temporaryFolder, Viewer, writeBallImage } from "./support";

test("without WebGL slices and drawing work, and the 3D view says why it is missing", async () => {
  const folder = temporaryFolder();
  const image = join(folder.path, "ball.nii");
  writeBallImage(image);
  const server = await Server.start(folder.path, image);
  const browser = await launch(NO_WEBGL);
  try {
    const viewer = await Viewer.open(browser, server.address);
    await viewer.page.waitForSelector("[data-view=surface][data-webgl=no]");
    assert.match((await viewer.pane("surface").textContent())!, /no WebGL/);
    await viewer.closeHint();
    await viewer.page.keyboard.press("f");
    await viewer.drag("axial", circle(await viewer.pixels("axial", BALL_RADIUS_MM)));
    await viewer.waitForContours(1);
    await viewer.surfaceShown();
    assert.deepEqual(viewer.complaints, []);
  } finally {
    await browser.close();
    await server.end();
    folder.remove();
  }
});
