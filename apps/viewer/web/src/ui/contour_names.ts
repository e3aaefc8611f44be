// SPDX-License-Identifier: Apache-2.0
import type { Plane } from "../geometry/plane";
import { dot } from "../geometry/vec";
import { coordinateText } from "../model/lengths";
import type { Navigation } from "../model/navigation";
import type { ViewName } from "../net/protocol";

/** A contour, or whatever else lies in a plane. */
export interface InPlane {
  plane: Plane;
  /** Of the image; absent: the one that was opened. */
  time?: number;
}

/** The view whose unturned planes the contour is parallel to, on which of its slices and where along them it lies. */
export interface ContourPlace {
  view: ViewName | null;
  slice: string;
  position: string;
}

export function placeOf({ plane: { normal, origin } }: InPlane, navigation: Navigation): ContourPlace {
  const view = navigation.unturnedViewAlong(normal);
  const slice = view ? String(navigation.unturnedSliceOf(view, origin)) : "";
  const step_mm = navigation.step(view ?? "axial");
  const axis = [0, 1, 2].find((i) => Math.abs(normal[i]!) > 0.9999);
  if (axis === undefined) return { view, slice, position: coordinateText(dot(origin, normal), step_mm) };
  const letter = (["RL", "AP", "IS"] as const)[axis]![origin[axis]! >= 0 ? 1 : 0]!;
  return { view, slice, position: `${letter} ${coordinateText(Math.abs(origin[axis]!), step_mm)}` };
}

/** "Axial 51", as the list and the view's title have it; "Oblique 12.3" for planes of no view. With the frame where another one is seen. */
export function contourName(contour: InPlane, navigation: Navigation): string {
  const { view, slice, position } = placeOf(contour, navigation);
  const time = contour.time ?? navigation.ownTime;
  const frame = time === navigation.time ? "" : `, frame ${time + 1}`;
  return (view ? `${navigation.title(view)} ${slice}` : `Oblique ${position}`) + frame;
}
