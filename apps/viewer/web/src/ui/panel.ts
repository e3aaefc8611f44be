// SPDX-License-Identifier: Apache-2.0
import { heightOver } from "../geometry/plane";
import { dot } from "../geometry/vec";
import type { Vec3 } from "../geometry/vec";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { Contour, Structure, ViewName } from "../net/protocol";
import { VIEW_NAMES } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { PLANE_COLORS, VIEW_TITLES } from "../view/palette";
import { placeOf } from "./contour_names";
import { button, el, listen } from "./dom";
import { ICONS } from "./icons";
import { qualityOf } from "./quality";

export interface PanelServices {
  navigation: Navigation;
  project: Project;
  editor: Editor;
  call(name: string, args?: Record<string, unknown>): void;
  /** Whose image it is. */
  identity: HTMLElement;
  openStatistics(): void;
  /** Shows where to draw next. */
  suggest(): void;
  addStructure(): void;
  goTo(p: Vec3): void;
  /** Shows the contour's plane in the view that looks its way, or else in the oblique one. */
  show(contour: Contour): void;
  /** Proposes the outline that many slices further on. */
  propose(steps: number): void;
}

const KIND_LABELS: Record<Contour["kind"], string> = { freehand: "freehand", spline: "spline", livewire: "live-wire", mixed: "mixed" };

/** Structures with their contours, and how well the surface fits them. */
export class Panel {
  readonly element = el("aside", { class: "panel", "aria-label": "Structures and contours" });
  private readonly list = el("div", { class: "structures" });
  private readonly actions = el("div", { class: "contour-actions" });
  private readonly quality = el("div", { class: "quality" });
  private readonly collapsed = new Set<number>();
  private queued = false;

  constructor(private readonly services: PanelServices) {
    const { project } = services;
    const add = button({ icon: ICONS.add, title: "Add a structure", class: "icon-button small", test: "add-structure", click: services.addStructure });
    const measure = button({ icon: ICONS.statistics, title: "Statistics: volume, surface, diameters, values of all structures", class: "icon-button small", test: "statistics-open", click: services.openStatistics });
    this.element.append(
      services.identity,
      el("div", { class: "panel-title" }, el("span", {}, "Structures"), add),
      this.list,
      this.actions,
      el("div", { class: "panel-title" }, el("span", {}, "Surface"), measure),
      this.quality,
    );
    project.on(["structures", "contours", "selection", "surfaces", "stages"], () => this.update());
  }

  private update(): void {
    if (this.queued) return;
    this.queued = true;
    requestAnimationFrame(() => {
      this.queued = false;
      this.updateList();
      this.updateActions();
      this.updateQuality();
    });
  }

  /** The field in which a name is typed or a colour chosen stays where it is: taken away, it would lose the keyboard. */
  private updateList(): void {
    const { project } = this.services;
    const field = document.activeElement instanceof HTMLInputElement ? document.activeElement.closest<HTMLElement>(".structures .structure") : null;
    const kept = field && project.structures.has(Number(field.dataset["structure"])) ? field : null;
    const keyboard = this.keyboardPlace();
    for (const child of [...this.list.children]) if (child !== kept) child.remove();
    let isBehind = false;
    for (const structure of project.structures.values()) {
      const isKept = kept?.dataset["structure"] === String(structure.id);
      isBehind ||= isKept;
      if (isKept) this.renew(kept!, structure);
      else if (kept && !isBehind) kept.before(this.structureEntry(structure));
      else this.list.append(this.structureEntry(structure));
    }
    if (project.contours.size === 0)
      this.list.append(el("p", { class: "empty" }, "No contours yet. Choose Live-wire or Freehand and draw around the structure in any slice."));
    if (keyboard) this.list.querySelector<HTMLElement>(keyboard)?.focus({ preventScroll: true });
    this.list.querySelector(".contour-row.selected")?.scrollIntoView({ block: "nearest" });
  }

  /** Selects the button that the keyboard is on, to find it in the list that is made anew. */
  private keyboardPlace(): string | null {
    const active = document.activeElement;
    if (!(active instanceof HTMLButtonElement) || !this.list.contains(active)) return null;
    const contour = active.closest<HTMLElement>("[data-contour]")?.dataset["contour"];
    const structure = active.closest<HTMLElement>("[data-structure]")?.dataset["structure"];
    const row = contour ? `[data-contour="${contour}"]` : `[data-structure="${structure}"] > .structure-row`;
    return `${row} [data-part="${active.dataset["part"]}"]`;
  }

  private structureEntry(structure: Structure): HTMLElement {
    const row = el("div", { class: "structure-row" }, this.colorField(structure), this.nameLabel(structure), ...this.structureButtons(structure));
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
    const { project } = this.services;
    const [row, ...contours] = entry.children;
    const isActive = project.activeStructure?.id === structure.id;
    row!.classList.toggle("active", isActive);
    row!.setAttribute("title", isActive ? "New contours go into this structure" : "Click: new contours go into this structure");
    row!.querySelector(".name")!.setAttribute("aria-current", String(isActive));
    for (const old of contours) old.remove();
    if (!this.collapsed.has(structure.id)) entry.append(...project.contoursOf(structure.id).map((contour) => this.contourRow(contour, structure)));
  }

  private colorField(structure: Structure): HTMLInputElement {
    const change = () => {
      field.blur(); // the list is not made anew around a field that has the keyboard
      this.services.call("structure.set", { id: structure.id, color: field.value });
    };
    const field = el("input", { type: "color", value: structure.color, title: `Colour of ${structure.name}`, class: "color", on: { change, blur: () => this.update() } });
    return field;
  }

  private nameLabel(structure: Structure): HTMLButtonElement {
    const label = button({
      label: structure.name,
      title: "Double click or F2: rename",
      class: "name",
      part: "name",
      // The list is made anew between the clicks of a double click, so no element gets a "dblclick".
      click: ({ detail }) => {
        if (detail >= 2) this.rename(structure.id);
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

  /** Lets the user type another name. */
  rename(structure: number | undefined): void {
    const known = structure === undefined ? undefined : this.services.project.structures.get(structure);
    const label = this.list.querySelector(`[data-structure="${structure}"] > .structure-row > button.name`);
    if (!known || !label) return;
    const field = el("input", { type: "text", value: known.name, class: "name", title: "Name", spellcheck: false, maxLength: 64 });
    const end = () => {
      const name = field.value.trim();
      if (name && name !== known.name) this.services.call("structure.set", { id: known.id, name });
      this.update();
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

  private structureButtons(structure: Structure): HTMLElement[] {
    const { project, call } = this.services;
    const isOpen = !this.collapsed.has(structure.id);
    return [
      button({
        label: String(project.contoursOf(structure.id).length),
        title: isOpen ? "Hide the list of contours" : "List the contours",
        class: "count",
        part: "count",
        click: () => this.toggle(structure.id),
      }),
      eye(structure.visible, () => call("structure.set", { id: structure.id, visible: !structure.visible })),
      button({ icon: ICONS.remove, title: "Delete the structure with its contours", class: "icon-button small", part: "remove", click: () => call("structure.remove", { id: structure.id }) }),
    ];
  }

  private toggle(structure: number): void {
    if (!this.collapsed.delete(structure)) this.collapsed.add(structure);
    this.update();
  }

  private contourRow(contour: Contour, structure: Structure): HTMLElement {
    const { project, call, show } = this.services;
    const { view: name, slice, position } = placeOf(contour, this.services.navigation);
    const dot = el("span", { class: "plane-dot" });
    dot.style.background = name ? PLANE_COLORS[name] : PLANE_COLORS.oblique;
    const isSelected = project.selection?.contour === contour.id;
    const points = contour.control.length > 1 ? `${contour.control.length} pts` : `${contour.points.length} pts`;
    const kind = KIND_LABELS[contour.kind];
    const choose = (event: MouseEvent) => {
      if ((event.target as HTMLElement).closest(".icon-button")) return;
      project.select({ contour: contour.id, point: null });
      show(contour);
    };
    return el(
      "div",
      { class: "contour-row" + (isSelected ? " selected" : "") + (contour.visible && structure.visible ? "" : " off"), "data-contour": contour.id, "data-kind": contour.kind, title: `${kind}; click to show it`, on: { click: choose } },
      dot,
      el("button", { type: "button", class: "contour-plane", "data-part": "show", title: "Show this contour" }, el("span", { class: "contour-view" }, name ? VIEW_TITLES[name] : "Oblique"), " ", el("span", { class: "contour-slice", title: "Slice" }, slice), " ", el("span", { class: "contour-position" }, position)),
      contour.hole ? el("span", { class: "flag", title: "A hole" }, "hole") : null,
      contour.self_crossings.length > 0 ? el("span", { class: "flag", "data-test": "crosses-itself", title: "It crosses itself: rings mark the places" }, "crosses itself") : null,
      el("span", { class: "contour-points" }, points),
      eye(contour.visible, () => call("contour.set", { id: contour.id, visible: !contour.visible })),
      button({ icon: ICONS.remove, title: "Delete this contour", class: "icon-button small", test: "delete-contour", part: "remove", click: () => call("contour.remove", { ids: [contour.id] }) }),
    );
  }

  private updateActions(): void {
    const { project, call, editor, propose } = this.services;
    const contour = project.selectedContour;
    this.actions.hidden = !contour;
    if (!contour) return;
    const hole = el("input", { type: "checkbox", checked: contour.hole, on: { change: () => call("contour.set", { id: contour.id, hole: hole.checked }) } });
    const goOver = () => call("contour.set", { id: contour.id, structure: Number(structure.value) });
    const structure = el("select", { title: "The structure that this contour belongs to", on: { change: goOver } });
    structure.append(...[...project.structures.values()].map((entry) => el("option", { value: String(entry.id), selected: entry.id === contour.structure }, entry.name)));
    this.actions.replaceChildren(
      el("span", {}, "Propose on"),
      button({ icon: ICONS.copyDown, label: "next", title: "Propose the outline on the next slice (C)", class: "tool", test: "propose-next", click: () => propose(1) }),
      button({ icon: ICONS.copyUp, label: "previous", title: "Propose the outline on the previous slice (Shift+C)", class: "tool", test: "propose-previous", click: () => propose(-1) }),
      button({ icon: ICONS.remove, label: "Delete", title: "Delete the contour, or its selected point (Del)", class: "tool", click: () => editor.edits.deleteSelected() }),
      el("label", { class: "check", title: "The inside of this contour does not belong to the structure" }, hole, "Hole"),
      structure,
    );
  }

  private updateQuality(): void {
    const { project } = this.services;
    const structure = project.activeStructure;
    const surface = structure && project.surfaces.get(structure.id);
    this.quality.replaceChildren(...qualityOf(surface, structure ? project.contoursOf(structure.id) : [], this.services));
    this.element.dataset["revision"] = String(surface?.revision ?? 0);
    this.element.dataset["stage"] = surface?.stage ?? "none";
    this.element.dataset["structure"] = String(structure?.id ?? 0);
  }
}

/** The view whose plane is parallel to the contour's, if there is one. */
export function viewAlong(contour: Contour, navigation: Navigation): ViewName | null {
  const normal = contour.plane.normal;
  return VIEW_NAMES.find((view) => Math.abs(dot(navigation.cameras[view].axes.normal, normal)) > 1 - 1e-6) ?? null;
}

/** Where the crosshair must go so that planes along the contour's contain it: straight along its normal. */
export function crosshairOnto(contour: Contour, crosshair: Vec3): Vec3 {
  const height = heightOver(contour.plane, crosshair);
  return crosshair.map((value, i) => value - height * contour.plane.normal[i]!) as unknown as Vec3;
}

function eye(visible: boolean, click: () => void): HTMLButtonElement {
  return button({ icon: visible ? ICONS.eye : ICONS.eyeOff, title: visible ? "Hide" : "Show", class: "icon-button small" + (visible ? "" : " dimmed"), part: "eye", click });
}
