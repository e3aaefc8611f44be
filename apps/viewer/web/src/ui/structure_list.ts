// SPDX-License-Identifier: Apache-2.0
import { isOpenByItself } from "../model/contour_list";
import type { Contour, Structure } from "../net/protocol";
import { contourName } from "./contour_names";
import { ContourRows, type RowServices } from "./contour_rows";
import { button, el, eye, listen } from "./dom";
import { emptyPlaneRows } from "./empty_planes";
import { ICONS } from "./icons";
import { surfacePointRows } from "./surface_points";

const MOST_UNFILTERED = 24; // rows that are found by eye
const DOUBLE_CLICK_MS = 500; // what desktops begin with

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
  private clicked = { structure: 0, at: -Infinity };

  constructor(
    private readonly services: RowServices,
    /** Has `update` called soon: at once it would take away what the keyboard is just going to. */
    private readonly refresh: () => void,
  ) {
    this.rows = new ContourRows(services, this.element, refresh);
  }

  /** The field in which a name is typed or a colour chosen stays where it is: taken away, it would lose the keyboard. */
  update(): void {
    const { project } = this.services;
    this.filter.hidden = project.structures.size + project.contours.size <= MOST_UNFILTERED && this.filter.value === "";
    const field = document.activeElement instanceof HTMLInputElement ? document.activeElement.closest<HTMLElement>(".structures .structure") : null;
    const kept = field && project.structures.has(Number(field.dataset["structure"])) ? field : null;
    const keyboard = this.keyboardPlace();
    const scrolled = this.element.scrollTop;
    for (const child of [...this.element.children]) if (child !== kept) child.remove();
    let isBehind = false;
    for (const structure of project.structures.values()) {
      const isKept = kept?.dataset["structure"] === String(structure.id);
      isBehind ||= isKept;
      if (isKept) this.renew(kept!, structure);
      else if (!this.isWanted(structure)) continue;
      else if (kept && !isBehind) kept.before(this.entry(structure));
      else this.element.append(this.entry(structure));
    }
    if (project.contours.size === 0)
      this.element.append(el("p", { class: "empty" }, "No contours yet. Choose Live-wire or Freehand and draw around the structure in any slice."));
    else if (this.element.children.length === 0) this.element.append(el("p", { class: "empty" }, "No structure and no contour is called so."));
    this.element.scrollTop = scrolled;
    if (keyboard) this.element.querySelector<HTMLElement>(keyboard)?.focus({ preventScroll: true });
    this.element.querySelector(`.contour-row[data-contour="${project.selection?.contour}"]`)?.scrollIntoView({ block: "nearest" });
  }

  private get wanted(): string {
    return this.filter.value.trim().toLowerCase();
  }

  private isWanted(structure: Structure): boolean {
    return this.contoursOf(structure).length > 0 || structure.name.toLowerCase().includes(this.wanted);
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

  /** Selects the button that the keyboard is on, to find it in the list that is made anew. */
  private keyboardPlace(): string | null {
    const active = document.activeElement;
    if (!(active instanceof HTMLButtonElement) || !this.element.contains(active)) return null;
    const contour = active.closest<HTMLElement>("[data-contour]")?.dataset["contour"];
    const structure = active.closest<HTMLElement>("[data-structure]")?.dataset["structure"];
    const row = contour ? `[data-contour="${contour}"]` : `[data-structure="${structure}"]`;
    return `${row} [data-part="${active.dataset["part"]}"]`;
  }

  private entry(structure: Structure): HTMLElement {
    const row = el("div", { class: "structure-row" }, this.colorField(structure), this.nameLabel(structure), ...this.buttons(structure));
    const choose = (event: MouseEvent) => {
      if (event.target === row || (event.target as HTMLElement).closest(".name")) this.services.project.activate(structure.id);
    };
    listen(row, { click: choose });
    const entry = el("div", { class: "structure", "data-structure": structure.id }, row);
    this.renew(entry, structure);
    return entry;
  }

  /** All of an entry but its row's fields and buttons. */
  private renew(entry: HTMLElement, structure: Structure): void {
    const [row, ...contours] = entry.children;
    const isActive = this.services.project.activeStructure?.id === structure.id;
    row!.classList.toggle("active", isActive);
    row!.setAttribute("title", isActive ? "New contours go into this structure" : "Click: new contours go into this structure");
    row!.querySelector(".name")!.setAttribute("aria-current", String(isActive));
    for (const old of contours) old.remove();
    if (this.isOpen(structure))
      entry.append(
        ...this.rows.rowsOf(structure, this.contoursOf(structure)),
        ...emptyPlaneRows(structure, this.services),
        ...surfacePointRows(structure, this.services),
      );
  }

  private colorField(structure: Structure): HTMLInputElement {
    const change = () => {
      field.blur(); // the list is not made anew around a field that has the keyboard
      this.services.call("structure.set", { id: structure.id, color: field.value });
    };
    const field = el("input", {
      type: "color",
      value: structure.color,
      title: `Colour of ${structure.name}`,
      class: "color",
      on: { change, blur: () => this.refresh() },
    });
    return field;
  }

  private nameLabel(structure: Structure): HTMLButtonElement {
    const label = button({
      label: structure.name,
      title: "Double click or F2: rename",
      class: "name",
      part: "name",
      click: (event) => {
        if (this.isDouble(event, structure.id)) this.rename(structure.id);
      },
    });
    label.setAttribute("aria-label", structure.name);
    listen(label, {
      keydown: (event) => {
        if (event.key !== "F2") return;
        event.stopPropagation(); // which renames the active one
        this.rename(structure.id);
      },
    });
    return label;
  }

  /** The list is made anew between the clicks of a double click: no element gets a "dblclick", and Firefox counts only those on one element. */
  private isDouble({ detail, timeStamp }: MouseEvent, structure: number): boolean {
    const isSoon = this.clicked.structure === structure && timeStamp - this.clicked.at < DOUBLE_CLICK_MS;
    this.clicked = { structure, at: timeStamp };
    return isSoon || detail >= 2;
  }

  /** Lets the user type another name. */
  rename(structure: number | undefined): void {
    const known = structure === undefined ? undefined : this.services.project.structures.get(structure);
    const label = this.element.querySelector(`[data-structure="${structure}"] > .structure-row > button.name`);
    if (!known || !label) return;
    const field = el("input", { type: "text", value: known.name, class: "name", title: "Name", spellcheck: false, maxLength: 64 });
    const end = () => {
      const name = field.value.trim();
      if (name && name !== known.name) this.services.call("structure.set", { id: known.id, name });
      this.refresh();
    };
    const keys: Record<string, () => void> = {
      Enter: () => field.blur(),
      Escape: () => {
        field.value = known.name;
        field.blur();
      },
    };
    listen(field, { blur: end, keydown: (event) => keys[event.key]?.() });
    label.replaceWith(field);
    field.select();
    field.focus();
  }

  private buttons(structure: Structure): HTMLElement[] {
    const { project, call } = this.services;
    const isOpen = this.isOpen(structure);
    const toggle = () => {
      this.opened.set(structure.id, !isOpen);
      this.refresh();
    };
    const count = button({
      label: String(project.contoursOf(structure.id).length),
      title: isOpen ? "Hide the list of contours" : "List the contours",
      class: "count",
      part: "count",
      click: toggle,
    });
    count.setAttribute("aria-expanded", String(isOpen));
    return [
      count,
      eye(structure.visible, () => call("structure.set", { id: structure.id, visible: !structure.visible })),
      button({
        icon: ICONS.remove,
        title: "Delete the structure with its contours",
        class: "icon-button small",
        part: "remove",
        click: () => call("structure.remove", { id: structure.id }),
      }),
    ];
  }
}
