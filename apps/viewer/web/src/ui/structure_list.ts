// SPDX-License-Identifier: Apache-2.0
import { isOpenByItself } from "../model/contour_list";
import { LEAST_OPACITY } from "../model/opacities";
import type { Contour, Structure } from "../net/protocol";
import { contourName } from "./contour_names";
import { ContourRows, type RowServices } from "./contour_rows";
import { buttonPiece, el, eye } from "../dom/dom";
import { confirmedPlaneRows } from "./corrections";
import { emptyPlaneRows } from "./empty_planes";
import { ICONS } from "../dom/icons";
import { piece, render, type Piece } from "../dom/pieces";
import { reviewMarks, reviewRows } from "./reviews";
import { ruleFlag, ruleRow, type RuleRowServices } from "./rule_rows";
import { keepSliderKeys } from "./second_image_card";
import { singlePointRows } from "./single_points";

const MOST_UNFILTERED = 24; // rows that are found by eye

/** Structures with their contours. */
export class StructureList {
  readonly element = el("div", { class: "structures" });
  readonly filter = el("input", {
    type: "text",
    class: "list-filter",
    placeholder: "Filter: liver, axial 51",
    "aria-label": "Filter structures and contours",
    spellcheck: false,
    autocomplete: "off",
    "data-test": "list-filter",
    hidden: true,
    on: { input: () => this.refresh() },
  });
  /** What the user wants otherwise than `isOpenByItself` has it. */
  private readonly opened = new Map<number, boolean>();
  private readonly rows: ContourRows;
  private renamed: number | null = null;
  private clicked: number | null = null; // whose name the last click was on
  private followed: Element | null = null;
  private inSight: { active: number; newest: number; selected: number | undefined } = { active: 0, newest: 0, selected: undefined };

  constructor(
    private readonly services: RowServices & RuleRowServices,
    /** Has `update` called soon. */
    private readonly refresh: () => void,
  ) {
    this.rows = new ContourRows(services, this.element, refresh);
    new ResizeObserver(() => this.keepInSight()).observe(this.element);
    this.element.addEventListener("wheel", () => void (this.followed = null), { passive: true }); // the user looks elsewhere
    for (const kind of ["mousedown", "click"] as const) this.element.addEventListener(kind, (event) => this.hearClick(event), { capture: true });
  }

  /** A click on a name moves the rows beneath the pointer, so a second one at that place is for the same name, whatever lies there now. */
  private hearClick(event: MouseEvent): void {
    if (event.detail === 2 && this.clicked !== null) {
      event.preventDefault();
      event.stopPropagation();
      if (event.type === "click") this.rename(this.clicked);
    } else if (event.type === "click") {
      const name = (event.target as HTMLElement).closest("button.name");
      this.clicked = name ? Number(name.closest<HTMLElement>(".structure")!.dataset["structure"]) : null;
    }
  }

  update(): void {
    const { project } = this.services;
    this.filter.hidden = project.structures.size + project.contours.size <= MOST_UNFILTERED && this.filter.value === "";
    const entries = [...project.structures.values()].filter((structure) => this.isWanted(structure)).map((structure) => this.entry(structure));
    render(this.element, [...entries, ...this.nothing(entries.length)]);
    this.follow();
  }

  private nothing(entries: number): Piece[] {
    const { project } = this.services;
    if (![...project.structures.values()].some((one) => project.hasContent(one)))
      return [piece("p", { class: "empty" }, "No contours yet. Choose Live-wire or Freehand and draw around the structure in any slice.")];
    return entries === 0 ? [piece("p", { class: "empty" }, "No structure and no contour is called so.")] : [];
  }

  /** Brings into sight what has been drawn or selected, or else the structure that is drawn in, when that becomes another. */
  private follow(): void {
    const { project } = this.services;
    const active = project.activeStructure?.id ?? 0;
    const newest = Math.max(0, ...project.contoursOf(active).map(({ id }) => id));
    const selected = project.selection?.contour;
    const before = this.inSight;
    this.inSight = { active, newest, selected };
    const isSame = before.active === active && before.newest === newest && before.selected === selected;
    if (isSame) return;
    const contour = selected !== undefined && selected !== before.selected ? selected : newest > before.newest ? newest : undefined;
    const row = contour === undefined ? null : this.element.querySelector(`.contour-row[data-contour="${contour}"]`);
    const target = row ?? this.element.querySelector(`.structure[data-structure="${active}"] > .structure-row`);
    this.followed = target;
    target?.scrollIntoView({ block: "nearest" });
  }

  /** What was brought into sight stays there when the figures below grow; nothing moves beneath the pointer. */
  private keepInSight(): void {
    if (!this.element.matches(":hover")) this.followed?.scrollIntoView({ block: "nearest" });
  }

  private get wanted(): string {
    return this.filter.value.trim().toLowerCase();
  }

  /** One that is being renamed stays, whatever the filter says. */
  private isWanted(structure: Structure): boolean {
    return structure.id === this.renamed || this.contoursOf(structure).length > 0 || structure.name.toLowerCase().includes(this.wanted);
  }

  /** Of a structure whose name is wanted all of them. */
  private contoursOf(structure: Structure): Contour[] {
    const contours = this.services.project.contoursOf(structure.id);
    if (structure.name.toLowerCase().includes(this.wanted)) return contours;
    return contours.filter((contour) => contourName(contour, this.services.navigation).toLowerCase().startsWith(this.wanted));
  }

  private isOpen(structure: Structure): boolean {
    const isNamed = structure.name.toLowerCase().includes(this.wanted);
    if (this.wanted !== "" && !isNamed) return true;
    return this.opened.get(structure.id) ?? isOpenByItself(structure.id, this.services.project);
  }

  private entry(structure: Structure): Piece {
    const { project } = this.services;
    const isActive = project.activeStructure?.id === structure.id;
    const row = piece(
      "div",
      {
        class: `structure-row${isActive ? " active" : ""}`,
        title: isActive ? "New contours go into this structure" : "Click: new contours go into this structure",
        on: {
          click: ({ target, currentTarget }) => {
            if (target === currentTarget || (target as HTMLElement).closest(".name")) project.activate(structure.id);
          },
        },
      },
      this.colorField(structure),
      structure.id === this.renamed ? this.nameField(structure) : this.nameLabel(structure, isActive),
      ...this.buttons(structure),
    );
    return piece(
      "div",
      { key: structure.id, class: "structure", "data-structure": structure.id },
      row,
      ...(isActive ? [this.look(structure), ...reviewRows(structure, this.services)] : []),
      ...ruleRow(structure, this.services),
      ...this.listOf(structure),
    );
  }

  /** How the active one is seen among the others. */
  private look({ id, name }: Structure): Piece {
    const { project, opacities, call } = this.services;
    const isOne = project.structures.size < 2;
    const isAlone = !isOne && [...project.structures.values()].every((one) => one.visible === (one.id === id));
    const only = buttonPiece({
      label: isAlone ? "Show all" : "Show only this",
      title: isAlone ? "Show all structures again" : `Hide all structures but ${name}`,
      class: "choice",
      test: "show-only",
      more: { disabled: isOne },
      click: () => call("structure.show_only", { id }),
    });
    const opacity = piece("input", {
      key: "opacity",
      type: "range",
      min: String(LEAST_OPACITY),
      max: "1",
      step: "0.05",
      value: String(opacities.of(id)),
      title: `Opacity of ${name} in 3D`,
      "aria-label": `Opacity of ${name} in 3D`,
      "data-test": "structure-opacity",
      on: { input: ({ currentTarget }) => opacities.set(id, currentTarget.valueAsNumber), keydown: keepSliderKeys },
    });
    return piece("div", { key: "look", class: "structure-look" }, only, opacity);
  }

  private listOf(structure: Structure): Piece[] {
    if (!this.isOpen(structure)) return [];
    return [
      ...this.rows.rowsOf(structure, this.contoursOf(structure)),
      ...emptyPlaneRows(structure, this.services),
      ...confirmedPlaneRows(structure, this.services),
      ...singlePointRows(structure, this.services),
    ];
  }

  private colorField({ id, name, color }: Structure): Piece {
    return piece("input", {
      key: "color",
      type: "color",
      value: color,
      title: `Colour of ${name}`,
      class: "color",
      on: {
        change: ({ currentTarget }) => {
          this.services.call("structure.set", { id, color: currentTarget.value });
          currentTarget.blur(); // the tools have the keys again, and what is refused is shown as it is
        },
        blur: () => this.refresh(),
      },
    });
  }

  private nameLabel({ id, name }: Structure, isActive: boolean): Piece {
    return buttonPiece({
      label: name,
      title: `${name} (double click or F2: rename)`,
      class: "name",
      part: "name",
      click: () => undefined, // its row's
      more: {
        "aria-label": name,
        "aria-current": isActive,
        on: {
          keydown: (event) => {
            if (event.key !== "F2") return;
            event.stopPropagation(); // which renames the active one
            this.rename(id);
          },
        },
      },
    });
  }

  private nameField({ name }: Structure): Piece {
    return piece("input", {
      key: "name",
      type: "text",
      value: name,
      class: "name",
      title: "Name",
      spellcheck: false,
      maxLength: 64,
      on: {
        blur: ({ currentTarget }) => {
          // It stays the active one while another window has the keyboard, and goes on when that comes back.
          if (document.activeElement !== currentTarget) this.renameTo(currentTarget.value.trim());
        },
        keydown: ({ key, currentTarget }) => {
          if (key === "Escape") this.renamed = null;
          if (key === "Enter" || key === "Escape") currentTarget.blur();
        },
      },
    });
  }

  /** Lets the user type another name. */
  rename(structure: number | undefined): void {
    if (structure === undefined) return;
    this.renamed = structure;
    this.update();
    const field = this.element.querySelector<HTMLInputElement>("input.name");
    field?.select();
    field?.focus();
  }

  private renameTo(name: string): void {
    const known = this.renamed === null ? undefined : this.services.project.structures.get(this.renamed);
    this.renamed = null;
    if (known && name && name !== known.name) this.services.call("structure.set", { id: known.id, name });
    this.refresh();
  }

  private buttons(structure: Structure): Piece[] {
    const { project, call } = this.services;
    const { id, visible } = structure;
    const isOpen = this.isOpen(structure);
    const toggle = () => {
      this.opened.set(id, !isOpen);
      this.refresh();
    };
    return [
      ...reviewMarks(structure),
      ...(structure.mask ? [piece("span", { class: "flag", "data-test": "is-mask", title: "A mask: what is drawn into it corrects it" }, "mask")] : []),
      structure.rule === undefined
        ? buttonPiece({
            label: String(project.contoursOf(id).length),
            title: isOpen ? "Hide the list of contours" : "List the contours",
            class: "count",
            part: "count",
            click: toggle,
            more: { "aria-expanded": isOpen },
          })
        : ruleFlag(structure.rule),
      eye(visible, () => call("structure.set", { id, visible: !visible })),
      buttonPiece({
        icon: ICONS.remove,
        title: "Delete the structure with its contours",
        class: "icon-button small",
        part: "remove",
        click: () => call("structure.remove", { id }),
      }),
    ];
  }
}
