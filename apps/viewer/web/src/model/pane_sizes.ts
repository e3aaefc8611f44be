// SPDX-License-Identifier: Apache-2.0
import { Emitter } from "./emitter";

/** Between the slices' columns, their rows, slices and 3D view, the big pane and the others, the panes and the panel. */
export const DIVIDERS = ["columns", "rows", "surface", "big", "panel"] as const;
export type DividerName = (typeof DIVIDERS)[number];

/** Of what two neighbours have together, the share of the left or upper one; those that were never moved are missing. */
export type SavedSizes = Partial<Record<DividerName, number>>;

const USUAL: Readonly<Record<DividerName, number>> = { columns: 0.5, rows: 0.5, surface: 0.635, big: 0.773, panel: 0.8 };
export const LEAST = 0.12;
export const MOST = 0.88;

/** Where the dividers between panes stand. */
export class PaneSizes extends Emitter<"changed"> {
  private moved: SavedSizes = {};

  share(divider: DividerName): number {
    return this.moved[divider] ?? USUAL[divider];
  }

  isMoved(divider: DividerName): boolean {
    return this.moved[divider] !== undefined;
  }

  move(divider: DividerName, share: number): void {
    if (!Number.isFinite(share)) return;
    this.moved[divider] = Math.min(Math.max(share, LEAST), MOST);
    this.emit("changed");
  }

  reset(divider: DividerName): void {
    delete this.moved[divider];
    this.emit("changed");
  }

  /** What is no share is left out: it comes from a file. */
  restore(saved: SavedSizes | undefined): void {
    const given = DIVIDERS.flatMap((divider) => {
      const share: unknown = saved?.[divider];
      return typeof share === "number" && share >= LEAST && share <= MOST ? [[divider, share] as const] : [];
    });
    this.moved = Object.fromEntries(given);
    this.emit("changed");
  }

  saved(): SavedSizes {
    return { ...this.moved };
  }
}
