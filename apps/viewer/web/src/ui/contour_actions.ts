// SPDX-License-Identifier: Apache-2.0
import type { Project } from "../model/project";
import type { Maker } from "../net/calls";
import type { Contour } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { button, el } from "./dom";
import { ICONS } from "./icons";

export interface ActionServices {
  project: Project;
  editor: Editor;
  call: Maker;
  /** Proposes the outline that many slices further on. */
  propose(steps: number): void;
}

/** What can be done with the selected contour, or with all that are marked. */
export class ContourActions {
  readonly element = el("div", { class: "contour-actions", "data-test": "contour-actions" });

  constructor(private readonly services: ActionServices) {}

  update(): void {
    const { project } = this.services;
    const marked = [...project.marked].map((id) => project.contour(id)).filter((contour) => contour !== undefined);
    this.element.hidden = marked.length === 0;
    if (marked.length === 0) return;
    this.element.replaceChildren(...(marked.length === 1 ? this.ofOne(marked[0]!) : this.ofMany(marked)));
  }

  private ofOne(contour: Contour): HTMLElement[] {
    const { call, editor, propose } = this.services;
    const hole = el("input", { type: "checkbox", checked: contour.hole, on: { change: () => call("contour.set", { id: contour.id, hole: hole.checked }) } });
    return [
      el("span", {}, "Propose on"),
      button({
        icon: ICONS.copyDown,
        label: "next",
        title: "Propose the outline on the next slice (C)",
        class: "tool",
        test: "propose-next",
        click: () => propose(1),
      }),
      button({
        icon: ICONS.copyUp,
        label: "previous",
        title: "Propose the outline on the previous slice (Shift+C)",
        class: "tool",
        test: "propose-previous",
        click: () => propose(-1),
      }),
      button({
        icon: ICONS.remove,
        label: "Delete",
        title: "Delete the contour, or its selected point (Del)",
        class: "tool",
        click: () => editor.edits.deleteSelected(),
      }),
      el("label", { class: "check", title: "The inside of this contour does not belong to the structure" }, hole, "Hole"),
      this.owner([contour], "The structure that this contour belongs to"),
    ];
  }

  private ofMany(marked: readonly Contour[]): HTMLElement[] {
    const { call } = this.services;
    const ids = marked.map(({ id }) => id);
    const isAnyShown = marked.some(({ visible }) => visible);
    return [
      el("span", { "data-test": "marked" }, `${marked.length} contours`),
      button({
        icon: isAnyShown ? ICONS.eyeOff : ICONS.eye,
        label: isAnyShown ? "Hide" : "Show",
        title: isAnyShown ? "Hide these contours" : "Show these contours",
        class: "tool",
        test: "marked-visible",
        click: () => call("contour.set", { ids, visible: !isAnyShown }),
      }),
      button({
        icon: ICONS.remove,
        label: "Delete",
        title: "Delete these contours (Del)",
        class: "tool",
        test: "marked-delete",
        click: () => call("contour.remove", { ids }),
      }),
      this.owner(marked, "Move these contours to a structure"),
    ];
  }

  /** A choice of the structure that contours belong to; of several structures none is chosen yet. */
  private owner(contours: readonly Contour[], title: string): HTMLElement {
    const { project, call } = this.services;
    const [first] = contours;
    const common = contours.every(({ structure }) => structure === first!.structure) ? first!.structure : null;
    const move = () => {
      const structure = Number(choice.value);
      if (contours.length === 1) call("contour.set", { id: first!.id, structure });
      else call("contour.set", { ids: contours.map(({ id }) => id), structure });
    };
    const choice = el("select", { title, "aria-label": title, "data-test": "owner", on: { change: move } });
    if (common === null) choice.append(el("option", { value: "", selected: true, disabled: true }, "Move to…"));
    choice.append(...[...project.structures.values()].map(({ id, name }) => el("option", { value: String(id), selected: id === common }, name)));
    return choice;
  }
}
