// SPDX-License-Identifier: Apache-2.0
import type { Point2 } from "../geometry/screen";

export const CLICK_PIXELS = 5; // a press that moves less is a click
export const DRAG_PIXELS = 2; // on a line or a handle, where little counts

export interface Modifiers {
  ctrl: boolean;
  shift: boolean;
}

/** What follows a press of the left button until it is released. */
export interface Gesture {
  /** Every place on the way counts, not the latest one alone: a line is drawn. */
  readonly isStroke?: boolean;
  move(pointer: Point2): void;
  end(pointer: Point2): void;
  cancel?(): void;
}
