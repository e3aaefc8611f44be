// SPDX-License-Identifier: Apache-2.0
import type { Project } from "../model/project";
import type { Maker } from "../net/calls";
import type { Contour, ContourEnd } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { buttonPiece, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, render, type Piece } from "../dom/pieces";

export interface ActionServices {
  project: Project;
  editor: Editor;
  call: Maker;
  /** Proposes the outline that many slices further on. */
  propose(steps: number): void;
}

const USUAL_WEIGHT = 1;
const weightEntry = (weight: number): readonly [number, string] => [weight, `Counts ${weight} ×`];
const WEIGHTS = [10, USUAL_WEIGHT, 0.1, 0.01].map(weightEntry);
const ENDS: readonly (readonly [ContourEnd, string])[] = [
  ["automatic", "No end here"],
  ["flat", "Flat end"],
  ["round", "Round end"],
];

function choice(part: string, title: string, value: string, entries: readonly (readonly [string | number, string])[], chosen: (value: string) => void): Piece {
  return piece(
    "select",
    { key: part, title, "aria-label": title, "data-test": part, value, on: { change: ({ currentTarget }) => chosen(currentTarget.value) } },
    ...entries.map(([key, label]) => piece("option", { key, value: String(key) }, label)),
  );
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
    render(this.element, marked.length === 1 ? this.ofOne(marked[0]!) : this.ofMany(marked));
  }

  private ofOne(contour: Contour): Piece[] {
    const { call, editor, project, propose } = this.services;
    const isCorrection = Boolean(project.structures.get(contour.structure)?.mask); // which has neither sides nor ends, and all count alike
    const hole = piece("input", {
      type: "checkbox",
      checked: contour.hole,
      on: { change: ({ currentTarget }) => call("contour.set", { id: contour.id, hole: currentTarget.checked }) },
    });
    return [
      piece("span", {}, "Propose on"),
      buttonPiece({
        icon: ICONS.copyDown,
        label: "next",
        title: "Propose the outline on the next slice (C)",
        class: "tool",
        test: "propose-next",
        click: () => propose(1),
      }),
      buttonPiece({
        icon: ICONS.copyUp,
        label: "previous",
        title: "Propose the outline on the previous slice (Shift+C)",
        class: "tool",
        test: "propose-previous",
        click: () => propose(-1),
      }),
      buttonPiece({
        icon: ICONS.remove,
        label: "Delete",
        title: "Delete the contour, or its selected point (Del)",
        class: "tool",
        part: "delete",
        click: () => void (editor.isAnotherTime() || editor.edits.deleteSelected()),
      }),
      ...(contour.closed ? [this.opener()] : this.ofOpen(contour, isCorrection)),
      contour.closed && !isCorrection
        ? piece("label", { class: "check", title: "The inside of this contour does not belong to the structure" }, hole, "Hole")
        : null,
      this.owner([contour], "The structure that this contour belongs to"),
      isCorrection ? null : this.weight(contour),
      contour.closed && !contour.hole && !isCorrection ? this.end(contour) : null,
    ].filter((one) => one !== null);
  }

  private weight({ id, weight = USUAL_WEIGHT }: Contour): Piece {
    const title = "How far this contour is trusted: where contours contradict each other, the one that counts more yields less";
    const known = WEIGHTS.some(([value]) => value === weight);
    const options = known ? WEIGHTS : [...WEIGHTS, weightEntry(weight)];
    const set = (chosen: string) => this.services.call("contour.set", { id, weight: Number(chosen) });
    return choice("weight", title, String(weight), options, set);
  }

  private end({ id, end = "automatic" }: Contour): Piece {
    const title = "How the structure ends at this contour, where no other one carries it on";
    return choice("end", title, end, ENDS, (chosen) => this.services.call("contour.set", { id, end: chosen as ContourEnd }));
  }

  private opener(): Piece {
    return buttonPiece({
      icon: ICONS.openLine,
      label: "Open",
      title: "Make it an open line: without the stretch behind the selected point, or else the last one; U: without the one under the pointer",
      class: "tool",
      test: "open-contour",
      click: () => this.openOrClose(),
    });
  }

  private ofOpen(contour: Contour, isCorrection: boolean): Piece[] {
    const { editor } = this.services;
    const turn = (side: "other" | "auto") => () => void (editor.isAnotherTime() || editor.edits.turnSide(contour, side));
    const close = buttonPiece({
      icon: ICONS.closedLine,
      label: "Close",
      title: "Lead the open line on to its beginning (U)",
      class: "tool",
      test: "close-line",
      click: () => this.openOrClose(),
    });
    if (isCorrection) return [close];
    const other = buttonPiece({
      icon: ICONS.otherSide,
      label: "Other side",
      title: "The structure lies on the other side of this line than its ticks show",
      class: "tool",
      test: "other-side",
      click: turn("other"),
    });
    const find = buttonPiece({
      label: "Find side",
      title: "Find out again on which side the structure lies, from all that is drawn",
      class: "tool",
      test: "find-side",
      click: turn("auto"),
    });
    return contour.inside ? [close, other, find] : [close, other];
  }

  private openOrClose(): void {
    const { editor } = this.services;
    if (!editor.isAnotherTime()) editor.edits.openOrClose(null);
  }

  private ofMany(marked: readonly Contour[]): Piece[] {
    const { call } = this.services;
    const ids = marked.map(({ id }) => id);
    const isAnyShown = marked.some(({ visible }) => visible);
    return [
      piece("span", { "data-test": "marked" }, `${marked.length} contours`),
      buttonPiece({
        icon: isAnyShown ? ICONS.eyeOff : ICONS.eye,
        label: isAnyShown ? "Hide" : "Show",
        title: isAnyShown ? "Hide these contours" : "Show these contours",
        class: "tool",
        test: "marked-visible",
        click: () => call("contour.set", { ids, visible: !isAnyShown }),
      }),
      buttonPiece({
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
  private owner(contours: readonly Contour[], title: string): Piece {
    const { project, call } = this.services;
    const [first] = contours;
    const common = contours.every(({ structure }) => structure === first!.structure) ? first!.structure : null;
    const move = (chosen: string) => {
      const structure = Number(chosen);
      if (contours.length === 1) call("contour.set", { id: first!.id, structure });
      else call("contour.set", { ids: contours.map(({ id }) => id), structure });
    };
    const options = [...project.structures.values()].map(({ id, name }) => piece("option", { key: id, value: String(id) }, name));
    if (common === null) options.unshift(piece("option", { value: "", disabled: true }, "Move to…"));
    return piece(
      "select",
      {
        key: "owner",
        title,
        "aria-label": title,
        "data-test": "owner",
        value: common ?? "",
        on: { change: ({ currentTarget }) => move(currentTarget.value) },
      },
      ...options,
    );
  }
}
