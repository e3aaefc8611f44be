// SPDX-License-Identifier: Apache-2.0
import type { Structure } from "../net/protocol";
import type { RowServices } from "./contour_rows";
import { buttonPiece } from "./dom";
import { ICONS } from "./icons";
import { piece, type Piece } from "./pieces";
import { placeText } from "./values";

/** The single points that the structure's surface passes: a row for each, to go there, and to remove it. */
export function surfacePointRows({ id, color, surface_points = [] }: Structure, { points, goTo }: RowServices): Piece[] {
  return surface_points.map(({ at }, i) => {
    const point = { structure: id, at };
    const dot = piece("span", { class: "plane-dot square", style: { background: color } });
    const show = () => {
      points.select(point);
      goTo(at);
    };
    const isSelected = points.isSelected(point);
    const go = buttonPiece({
      label: placeText(at),
      title: "Show this point, which the surface passes",
      class: "contour-plane",
      part: `point-${i}`,
      click: show,
      more: { "aria-pressed": isSelected },
    });
    const remove = buttonPiece({
      icon: ICONS.remove,
      title: "Remove this point",
      class: "icon-button small",
      part: `remove-point-${i}`,
      click: () => points.remove(point),
    });
    return piece(
      "div",
      { key: `point-${i}`, class: "contour-row" + (isSelected ? " selected" : ""), "data-test": "surface-point" },
      dot,
      go,
      piece("span", { class: "contour-points" }, "point"),
      remove,
    );
  });
}
