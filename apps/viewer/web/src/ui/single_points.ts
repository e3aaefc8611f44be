// SPDX-License-Identifier: Apache-2.0
import { POINT_KINDS, type PointKind, type Structure } from "../net/protocol";
import { pointsOf } from "../tools/single_points";
import type { RowServices } from "./contour_rows";
import { buttonPiece } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, type Piece } from "../dom/pieces";
import { placeText } from "./values";

const LABELS: Record<PointKind, string> = { surface: "surface", interior: "inside", exterior: "outside" };
/** As warnings of the surface call them, by their numbers. */
const NAMES: Record<PointKind, string> = { surface: "Surface", interior: "Interior", exterior: "Exterior" };

/** The structure's single points: a row for each, to go there, to say where the point lies, and to remove it. */
export function singlePointRows(structure: Structure, { call, points, goTo }: RowServices): Piece[] {
  const counts: Record<PointKind, number> = { surface: 0, interior: 0, exterior: 0 };
  return pointsOf(structure).map((point, i) => {
    const { at, kind } = point;
    const name = `${NAMES[kind]} point ${++counts[kind]}`;
    const isSelected = points.isSelected(point);
    const show = () => {
      points.select(point);
      goTo(at);
    };
    const go = buttonPiece({
      label: placeText(at),
      title: `Show ${name.toLowerCase()}: ${placeText(at)}`,
      class: "contour-plane point-place",
      part: `point-${i}`,
      click: show,
      more: { "aria-pressed": isSelected },
    });
    const choice = piece(
      "select",
      {
        class: "point-kind",
        title: "Whether the surface passes this point, or it lies inside or outside of the structure",
        "aria-label": `Where ${name.toLowerCase()} lies`,
        "data-test": "point-kind",
        value: kind,
        on: { change: ({ currentTarget }) => call("point.set", { structure: structure.id, at, kind: currentTarget.value as PointKind }) },
      },
      ...POINT_KINDS.filter((one) => one !== "surface" || !structure.mask).map((one) => piece("option", { value: one }, LABELS[one])),
    );
    const remove = buttonPiece({
      icon: ICONS.remove,
      title: "Remove this point",
      class: "icon-button small",
      part: `remove-point-${i}`,
      click: () => call("point.remove", { structure: structure.id, at }),
    });
    return piece(
      "div",
      { key: `point-${i}`, class: "contour-row" + (isSelected ? " selected" : ""), "data-test": "single-point", "data-kind": kind },
      piece("span", { class: `plane-dot ${kind}`, style: { background: structure.color } }),
      go,
      choice,
      remove,
    );
  });
}
