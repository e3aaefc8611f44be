// SPDX-License-Identifier: Apache-2.0
import type { Project } from "./project";

/** A time of the image at which something was drawn. */
export interface DrawnTime {
  time: number;
  contours: number;
  /** Of them those of the active structure. */
  ofActive: number;
}

export function drawnTimes(project: Project): DrawnTime[] {
  const found = new Map<number, DrawnTime>();
  const active = project.activeStructure?.id;
  for (const contour of project.contours.values()) {
    const time = project.timeOf(contour);
    const at = found.get(time) ?? { time, contours: 0, ofActive: 0 };
    ++at.contours;
    if (contour.structure === active) ++at.ofActive;
    found.set(time, at);
  }
  return [...found.values()].sort((a, b) => a.time - b.time);
}
