// SPDX-License-Identifier: Apache-2.0
import type { Point2, Screen } from "../geometry/screen";
import type { ViewName } from "../net/protocol";
import type { ContourHit } from "./hit";

/** Where the pointer is, and the contour that it is on. */
export interface Place {
  view: ViewName;
  screen: Screen;
  step_mm: number; // from slice to slice
  pointer: Point2;
  hit: ContourHit | null;
}
