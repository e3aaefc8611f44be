// SPDX-License-Identifier: Apache-2.0
import { dot } from "../geometry/vec";
import type { Contour, ViewName } from "../net/protocol";
import { VIEW_NAMES } from "../net/protocol";
import type { Navigation } from "./navigation";
import type { Project } from "./project";

/** Contours of a structure whose planes one view looks along; the rest lies across all views. */
export interface ContourGroup {
  view: ViewName | null;
  contours: Contour[];
}

const MOST_UNGROUPED = 12; // that a list shows without headings
const MOST_OPEN = 24; // contours in all, up to which every structure's list is open

/** In the order of the views and, in each, of the slices: as one scrolls. */
export function groupsOf(contours: readonly Contour[], navigation: Navigation): ContourGroup[] {
  const groups = new Map<ViewName | null, Contour[]>();
  for (const contour of contours) {
    const view = navigation.unturnedViewAlong(contour.plane.normal);
    groups.set(view, [...(groups.get(view) ?? []), contour]);
  }
  const depth = ({ plane }: Contour, view: ViewName | null) => (view ? navigation.unturnedSliceOf(view, plane.origin) : dot(plane.origin, plane.normal));
  return [...VIEW_NAMES, null].flatMap((view): ContourGroup[] => {
    const members = groups.get(view);
    return members ? [{ view, contours: members.sort((a, b) => depth(a, view) - depth(b, view) || a.id - b.id) }] : [];
  });
}

/** Whether a list of so many contours has headings that fold. */
export const isGrouped = (count: number): boolean => count > MOST_UNGROUPED;

/** Whether a structure's contours are listed before the user says what he wants: all while they are few, else the active one's. */
export function isOpenByItself(structure: number, project: Project): boolean {
  return project.contours.size <= MOST_OPEN || project.activeStructure?.id === structure;
}

/** Those from one row to another, as they are listed, both included. */
export function between(listed: readonly number[], from: number, to: number): number[] {
  const [first, last] = [listed.indexOf(from), listed.indexOf(to)];
  if (first < 0 || last < 0) return [to];
  return first <= last ? listed.slice(first, last + 1) : listed.slice(last, first + 1).reverse();
}
