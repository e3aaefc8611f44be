// SPDX-License-Identifier: Apache-2.0
import { areParallel } from "../geometry/plane";
import type { ViewName } from "../net/protocol";
import type { Navigation } from "./navigation";
import type { Project } from "./project";

/** A slice of a view on which contours lie. */
export interface DrawnSlice {
  /** As in `Navigation.depth`. */
  depth_mm: number;
  structures: readonly number[];
}

/** The slices of the view on which something is drawn that is not hidden, in the order in which they are scrolled. */
export function drawnSlices(view: ViewName, navigation: Navigation, project: Project): DrawnSlice[] {
  const { axes } = navigation.cameras[view];
  const structuresAt = new Map<number, Set<number>>();
  for (const { plane, structure } of project.shownContours()) {
    if (!areParallel(plane, axes)) continue;
    const depth_mm = Number(navigation.depthOf(view, plane.origin).toFixed(3)); // those of one plane differ by rounding
    structuresAt.set(depth_mm, (structuresAt.get(depth_mm) ?? new Set()).add(structure));
  }
  return [...structuresAt].map(([depth_mm, structures]) => ({ depth_mm, structures: [...structures] })).sort((a, b) => a.depth_mm - b.depth_mm);
}

/** The nearest drawn slice ahead (1) or behind (-1) of what the view shows; what lies within half a slice it shows already. */
export function nextDrawnSlice(view: ViewName, direction: 1 | -1, navigation: Navigation, project: Project): DrawnSlice | undefined {
  const { from, to, at } = navigation.depth(view);
  const half = navigation.step(view) / 2;
  const ahead = drawnSlices(view, navigation, project).filter(
    ({ depth_mm }) => depth_mm > from - half && depth_mm < to + half && (depth_mm - at) * direction >= half,
  );
  return direction > 0 ? ahead[0] : ahead.at(-1);
}
