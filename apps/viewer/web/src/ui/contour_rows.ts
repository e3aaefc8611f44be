// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import { between, groupsOf, isGrouped } from "../model/contour_list";
import type { Navigation } from "../model/navigation";
import type { Opacities } from "../model/opacities";
import type { Project } from "../model/project";
import type { Maker } from "../net/calls";
import type { Contour, Structure, ViewName } from "../net/protocol";
import type { SinglePoints } from "../tools/single_points";
import { PLANE_COLORS } from "../model/palette";
import { placeOf, type InPlane } from "./contour_names";
import { buttonPiece, eye } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, type Piece } from "../dom/pieces";

export interface RowServices {
  navigation: Navigation;
  project: Project;
  call: Maker;
  points: SinglePoints;
  opacities: Opacities;
  goTo(p: Vec3): void;
  /** Shows the contour's plane in the view that looks its way, or else in the oblique one. */
  show(contour: InPlane): void;
}

const KIND_LABELS: Record<Contour["kind"], string> = { freehand: "freehand", spline: "spline", livewire: "live-wire", mixed: "mixed" };

/** Whether somebody placed its control points: a stroke by hand has but its beginning, or its two ends. */
const hasOwnPoints = ({ control, closed }: Contour): boolean => control.length > (closed ? 1 : 2);

/** The contours of structures as rows: many under headings, by the view that they were drawn in and in the order of slices. */
export class ContourRows {
  private readonly folded = new Set<string>();
  private anchor = 0; // of a range

  constructor(
    private readonly services: RowServices,
    /** Where the rows are, in their order. */
    private readonly list: HTMLElement,
    private readonly refresh: () => void,
  ) {
    list.addEventListener("keydown", (event) => this.key(event));
  }

  rowsOf(structure: Structure, contours: readonly Contour[]): Piece[] {
    const row = (contour: Contour) => this.row(contour, structure);
    if (!isGrouped(contours.length)) return contours.map(row);
    return groupsOf(contours, this.services.navigation).flatMap(({ view, contours: members }) => {
      const key = `${structure.id}:${view}`;
      const heading = this.heading(key, view, members);
      return this.folded.has(key) ? [heading] : [heading, ...members.map(row)];
    });
  }

  private heading(key: string, view: ViewName | null, members: readonly Contour[]): Piece {
    const isFolded = this.folded.has(key);
    const fold = () => {
      if (!this.folded.delete(key)) this.folded.add(key);
      this.refresh();
    };
    const title = view ? this.services.navigation.title(view) : "Other planes";
    const heading = buttonPiece({
      label: title,
      title: isFolded ? "List these contours" : "Hide these contours",
      class: "group-title",
      part: `group-${key}`,
      click: fold,
      more: { "aria-expanded": !isFolded },
    });
    const all = buttonPiece({
      label: String(members.length),
      title: `Mark the ${members.length} contours of ${title}`,
      class: "count",
      part: `mark-${key}`,
      click: () => this.services.project.mark(members.map(({ id }) => id)),
    });
    return piece("div", { key, class: "contour-group" }, heading, all);
  }

  private row(contour: Contour, structure: Structure): Piece {
    const { project, call, show } = this.services;
    const { view: name, slice, position } = placeOf(contour, this.services.navigation);
    const isSelected = project.marked.has(contour.id);
    const points = hasOwnPoints(contour) ? `${contour.control.length} pts` : `${contour.points.length} pts`;
    const frame = project.isOfTime(contour) ? "" : `frame ${project.timeOf(contour) + 1}`;
    const kind = KIND_LABELS[contour.kind];
    const choose = (event: MouseEvent) => {
      if ((event.target as HTMLElement).closest(".icon-button")) return;
      if (event.shiftKey) return this.extendTo(contour.id);
      this.anchor = contour.id;
      if (event.ctrlKey || event.metaKey) return project.toggleMark(contour.id);
      project.select({ contour: contour.id, point: null });
      show(contour);
    };
    return piece(
      "div",
      {
        class: "contour-row" + (isSelected ? " selected" : "") + (contour.visible && structure.visible ? "" : " off"),
        key: contour.id,
        "data-contour": contour.id,
        "data-kind": contour.kind,
        title: `${contour.closed ? kind : `open line, ${kind}`}; click to show it, Ctrl + click or Shift + click to mark several`,
        on: { click: choose },
      },
      piece("span", { class: "plane-dot", style: { background: PLANE_COLORS[name ?? "oblique"] } }),
      piece(
        "button",
        { key: "show", type: "button", class: "contour-plane", "data-part": "show", "aria-pressed": isSelected, title: "Show this contour" },
        piece("span", { class: "contour-view" }, name ? this.services.navigation.title(name) : "Oblique"),
        " ",
        piece("span", { class: "contour-slice", title: "Slice" }, slice),
        " ",
        piece("span", { class: "contour-position" }, position),
      ),
      contour.closed ? null : piece("span", { class: "flag", "data-test": "open", title: "An open line: a stretch of the border" }, "open"),
      contour.hole ? piece("span", { class: "flag", title: "A hole" }, "hole") : null,
      contour.self_crossings.length > 0
        ? piece("span", { class: "flag", "data-test": "crosses-itself", title: "It crosses itself: rings mark the places" }, "crosses itself")
        : null,
      frame ? piece("span", { class: "flag", "data-test": "frame", title: "Drawn in another frame than the one that is seen" }, frame) : null,
      piece("span", { class: "contour-points" }, points),
      eye(contour.visible, () => call("contour.set", { id: contour.id, visible: !contour.visible })),
      buttonPiece({
        icon: ICONS.remove,
        title: "Delete this contour",
        class: "icon-button small",
        test: "delete-contour",
        part: "remove",
        click: () => call("contour.remove", { ids: [contour.id] }),
      }),
    );
  }

  private listed(): number[] {
    return [...this.list.querySelectorAll<HTMLElement>("[data-contour]")].map((row) => Number(row.dataset["contour"]));
  }

  private extendTo(contour: number): void {
    const { project } = this.services;
    const listed = this.listed();
    if (!listed.includes(this.anchor)) this.anchor = project.selection?.contour ?? contour;
    project.mark(between(listed, this.anchor, contour));
  }

  /** Arrows go from row to row, with Shift they mark on the way; Ctrl + A marks all that is listed. */
  private key(event: KeyboardEvent): void {
    const row = (event.target as HTMLElement).closest<HTMLElement>("[data-contour]");
    if (!row) return;
    const listed = this.listed();
    const isAll = event.key.toLowerCase() === "a" && (event.ctrlKey || event.metaKey);
    const step = { ArrowDown: 1, ArrowUp: -1 }[event.key] ?? 0;
    if (!isAll && step === 0) return;
    event.preventDefault();
    event.stopPropagation(); // which scrolls the slices
    if (isAll) return this.services.project.mark(listed);
    const here = Number(row.dataset["contour"]);
    const next = listed[listed.indexOf(here) + step];
    if (next === undefined) return;
    this.list.querySelector<HTMLElement>(`[data-contour="${next}"] [data-part=show]`)?.focus();
    if (event.shiftKey) return this.extendTo(next);
    this.anchor = next;
    this.services.project.select({ contour: next, point: null });
    this.services.show(this.services.project.contour(next)!);
  }
}
