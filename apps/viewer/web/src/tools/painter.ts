// SPDX-License-Identifier: Apache-2.0
import type { Point2 } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";

/** What a tool can draw on a view beside contours and sketch; whoever shows the view hands it in. */
export interface ToolPainter {
  /** A computed outline that the pointer would take. */
  outlineToTake(points: readonly Vec3[], color: string): void;
  /** A circle, in pixels of the screen. */
  brush(at: Point2, radius: number): void;
}
