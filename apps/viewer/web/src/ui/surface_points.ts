// SPDX-License-Identifier: Apache-2.0
import type { Structure } from "../net/protocol";
import type { RowServices } from "./contour_rows";
import { button, el } from "./dom";
import { ICONS } from "./icons";
import { placeText } from "./values";

/** The single points that the structure's surface passes: a row for each, to go there, and to remove it. */
export function surfacePointRows({ id, color, surface_points = [] }: Structure, { points, goTo }: RowServices): HTMLElement[] {
  return surface_points.map(({ at }, i) => {
    const point = { structure: id, at };
    const dot = el("span", { class: "plane-dot square" });
    dot.style.background = color;
    const show = () => {
      points.select(point);
      goTo(at);
    };
    const isSelected = points.isSelected(point);
    const go = button({ label: placeText(at), title: "Show this point, which the surface passes", class: "contour-plane", part: `point-${i}`, click: show });
    go.setAttribute("aria-pressed", String(isSelected));
    const remove = button({
      icon: ICONS.remove,
      title: "Remove this point",
      class: "icon-button small",
      part: `remove-point-${i}`,
      click: () => points.remove(point),
    });
    return el(
      "div",
      { class: "contour-row" + (isSelected ? " selected" : ""), "data-test": "surface-point" },
      dot,
      go,
      el("span", { class: "contour-points" }, "point"),
      remove,
    );
  });
}
