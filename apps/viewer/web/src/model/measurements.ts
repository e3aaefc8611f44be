// SPDX-License-Identifier: Apache-2.0
import { coincide, type Plane } from "../geometry/plane";
import { distance, dot, normalized, sub, type Vec3 } from "../geometry/vec";
import { Emitter } from "./emitter";
import { lengthText } from "./lengths";

/** Two points: a distance. Three: the angle at the second one. They lie on the plane. */
export interface Measurement {
  plane: Plane;
  points: Vec3[];
}

const MOST_KEPT = 60; // with the project, of whose page state the server keeps 64 KiB

export function measured({ points }: Measurement): string {
  const [a, b, c] = points;
  if (!a || !b) return "";
  if (!c) return lengthText(distance(a, b));
  if (distance(a, b) === 0 || distance(c, b) === 0) return "";
  const cosine = dot(normalized(sub(a, b)), normalized(sub(c, b)));
  return `${((Math.acos(Math.min(Math.max(cosine, -1), 1)) * 180) / Math.PI).toFixed(1)}°`;
}

/** Distances and angles on slices; kept with the project, but no part of it. */
export class Measurements extends Emitter<"changed"> {
  readonly all: Measurement[] = [];
  selected: Measurement | null = null;

  lyingIn(plane: Plane, step_mm: number): Measurement[] {
    return this.all.filter((one) => coincide(one.plane, plane, step_mm / 2));
  }

  add(measurement: Measurement): void {
    this.all.push(measurement);
    this.selected = measurement;
    this.emit("changed");
  }

  movePoint(measurement: Measurement, index: number, to: Vec3): void {
    measurement.points[index] = to;
    this.selected = measurement;
    this.emit("changed");
  }

  /** The selected one, or else the latest; false where there is none. */
  remove(): boolean {
    const gone = this.selected ?? this.all.at(-1);
    if (!gone) return false;
    this.all.splice(this.all.indexOf(gone), 1);
    this.selected = null;
    this.emit("changed");
    return true;
  }

  saved(): Measurement[] {
    return this.all.slice(-MOST_KEPT);
  }

  restore(saved: readonly Measurement[]): void {
    this.all.splice(0, this.all.length, ...saved);
    this.selected = null;
    this.emit("changed");
  }
}
