// SPDX-License-Identifier: Apache-2.0
import type { Structure } from "../net/protocol";
import { PLANE_COLORS } from "../model/palette";
import { contourName, placeOf } from "./contour_names";
import type { RowServices } from "./contour_rows";
import { buttonPiece } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, type Piece } from "../dom/pieces";

/** The planes in which nothing of the structure is: a row for each, to go there, and to take that back. */
export function emptyPlaneRows({ id, empty_planes = [] }: Structure, { navigation, call, show }: RowServices): Piece[] {
  return empty_planes.map((plane, i) => {
    const dot = piece("span", { class: "plane-dot", style: { background: PLANE_COLORS[placeOf({ plane }, navigation).view ?? "oblique"] } });
    const go = buttonPiece({
      label: contourName({ plane }, navigation),
      title: "Go to this plane, which shows nothing of the structure",
      class: "contour-plane",
      part: `empty-${i}`,
      click: () => show({ plane }),
    });
    const forget = () => call("structure.set", { id, empty_planes: empty_planes.filter((other) => other !== plane) });
    const remove = buttonPiece({ icon: ICONS.remove, title: "Forget that nothing is here", class: "icon-button small", part: `forget-${i}`, click: forget });
    return piece(
      "div",
      { key: `empty-${i}`, class: "contour-row", "data-test": "empty-plane" },
      dot,
      go,
      piece("span", { class: "contour-points" }, "nothing here"),
      remove,
    );
  });
}
