// SPDX-License-Identifier: Apache-2.0
import { Emitter } from "./emitter";

/** How what is drawn and fitted looks on the slices; kept with the project. */
export interface SavedAppearance {
  /** Opacity of the inside of computed outlines, from 0 to 1. */
  fill: number;
  /** Of lines, as a multiple of the usual width. */
  width: number;
}

export const FILL_RANGE: readonly [number, number] = [0, 0.6];
export const WIDTH_RANGE: readonly [number, number] = [0.5, 3];

const within = ([least, most]: readonly [number, number], value: unknown, usual: number): number =>
  typeof value === "number" && Number.isFinite(value) ? Math.min(Math.max(value, least), most) : usual;

export class Appearance extends Emitter<"changed"> implements SavedAppearance {
  fill = 0.13;
  width = 1;

  set({ fill, width }: Partial<SavedAppearance>): void {
    this.fill = within(FILL_RANGE, fill, this.fill);
    this.width = within(WIDTH_RANGE, width, this.width);
    this.emit("changed");
  }

  saved(): SavedAppearance {
    return { fill: this.fill, width: this.width };
  }
}
