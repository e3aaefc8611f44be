// SPDX-License-Identifier: Apache-2.0
import type { Plane } from "../geometry/plane";
import type { Vec3 } from "../geometry/vec";
import { Emitter } from "../model/emitter";

/** Where what a rule would make meets a plane. */
export interface RuleLines {
  plane: Plane;
  lines: readonly (readonly Vec3[])[];
}

/** What a rule that is being typed would make, before it is taken. */
export class RulePreview extends Emitter<"preview"> {
  shown: readonly RuleLines[] = [];

  show(lines: readonly RuleLines[]): void {
    if (lines.length === 0 && this.shown.length === 0) return;
    this.shown = lines;
    this.emit("preview");
  }
}
