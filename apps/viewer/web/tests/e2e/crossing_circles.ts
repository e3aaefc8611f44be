// SPDX-License-Identifier: Apache-2.0
import { BALL_RADIUS_MM, circle, type Viewer } from "./support";

/** Draws a large circle on the axial slice and a smaller one across: they contradict each other at two places. */
export async function drawCrossingCircles(viewer: Viewer): Promise<void> {
  await viewer.page.keyboard.press("f");
  for (const [i, [view, mm]] of (
    [
      ["axial", BALL_RADIUS_MM],
      ["coronal", BALL_RADIUS_MM - 7],
    ] as const
  ).entries()) {
    await viewer.drag(view, circle(await viewer.pixels(view, mm), 48));
    await viewer.waitForContours(i + 1);
  }
}
