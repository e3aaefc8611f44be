// SPDX-License-Identifier: Apache-2.0
import { Emitter } from "./emitter";

export const LEAST_OPACITY = 0.1; // below, nobody finds the surface again

/** How much of what lies behind each structure's surface is seen in 3D; 1: nothing. */
export class Opacities extends Emitter<"changed"> {
  private readonly values = new Map<number, number>();

  of(structure: number): number {
    return this.values.get(structure) ?? 1;
  }

  set(structure: number, opacity: number): void {
    this.values.set(structure, Math.min(1, Math.max(LEAST_OPACITY, opacity)));
    this.emit("changed");
  }

  /** By the structures' ids, those that are not 1. */
  saved(): Record<string, number> {
    return Object.fromEntries([...this.values].filter(([, opacity]) => opacity !== 1));
  }

  restore(saved: Record<string, number>): void {
    for (const [id, opacity] of Object.entries(saved)) if (Number.isFinite(opacity)) this.set(Number(id), opacity);
  }
}
