// SPDX-License-Identifier: Apache-2.0
import { heightOver } from "../geometry/plane";
import { dot } from "../geometry/vec";
import type { Vec3 } from "../geometry/vec";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { Contour, Structure, Surface, ViewName } from "../net/protocol";
import { VIEW_NAMES } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { PLANE_COLORS, VIEW_TITLES } from "../view/palette";
import { button, el } from "./dom";
import { ICONS } from "./icons";

export interface PanelServices {
  navigation: Navigation;
  project: Project;
  editor: Editor;
  call(name: string, args?: Record<string, unknown>): void;
  addStructure(): void;
  goTo(p: Vec3): void;
  /** Shows the contour's plane in the view that looks its way, or else in the oblique one. */
  show(contour: Contour): void;
  copySelected(steps: number): void;
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
    const add = button({ icon: ICONS.add, title: "Add a structure", class: "icon-button small", test: "add-structure", onclick: services.addStructure });
    this.element.append(
      el("div", { class: "panel-title" }, el("span", {}, "Structures"), add),
      this.list,
      this.actions,
      el("div", { class: "panel-title" }, el("span", {}, "Surface")),
      this.quality,
    );
    project.on(["structures", "contours", "selection", "surfaces", "stages"], () => this.update());
  }

  private update(): void {
    if (this.queued) return;
    this.queued = true;
    requestAnimationFrame(() => {
      this.queued = false;
      // A name that is being typed must not be taken away.
      if (!this.list.contains(document.activeElement) || document.activeElement?.tagName !== "INPUT") this.updateList();
      this.updateActions();
      this.updateQuality();
    });
  }

  private updateList(): void {
    const { project } = this.services;
    const entries = [...project.structures.values()].map((structure) => this.structureEntry(structure));
    this.list.replaceChildren(...entries);
    if (project.contours.size === 0)
      this.list.append(el("p", { class: "empty" }, "No contours yet. Choose Live-wire or Freehand and draw around the structure in any slice."));
    this.list.querySelector(".contour-row.selected")?.scrollIntoView({ block: "nearest" });
  }

  private structureEntry(structure: Structure): HTMLElement {
    const { project, call } = this.services;
    const contours = project.contoursOf(structure.id);
    const isActive = project.activeStructure?.id === structure.id;
    const isOpen = !this.collapsed.has(structure.id);
    const color = el("input", { type: "color", value: structure.color, title: "Colour", class: "color" });
    color.onchange = () => {
      color.blur(); // the list is not made anew around a field that has the keyboard
      call("structure.set", { id: structure.id, color: color.value });
    };
    const name = el("input", { type: "text", value: structure.name, class: "name", title: "Name", spellcheck: false, maxLength: 64 });
    name.onchange = () => name.value.trim() && call("structure.set", { id: structure.id, name: name.value.trim() });
    name.onkeydown = (event) => event.key === "Enter" && name.blur();
    name.onblur = () => this.update();
    const count = button({
      label: String(contours.length),
      title: isOpen ? "Hide the list of contours" : "List the contours",
      class: "count",
      onclick: () => this.toggle(structure.id),
    });
    const row = el(
      "div",
      { class: "structure-row" + (isActive ? " active" : ""), title: isActive ? "New contours go into this structure" : "Click: new contours go into this structure" },
      color,
      name,
      count,
      eye(structure.visible, () => call("structure.set", { id: structure.id, visible: !structure.visible })),
      button({ icon: ICONS.remove, title: "Delete the structure with its contours", class: "icon-button small", onclick: () => call("structure.remove", { id: structure.id }) }),
    );
    row.onclick = (event) => event.target === row && project.activate(structure.id);
    name.onfocus = () => project.activeStructure?.id !== structure.id && project.activate(structure.id);
    return el("div", { class: "structure", "data-structure": structure.id }, row, ...(isOpen ? contours.map((contour) => this.contourRow(contour, structure)) : []));
  }

  private toggle(structure: number): void {
    if (!this.collapsed.delete(structure)) this.collapsed.add(structure);
    this.update();
  }

  private contourRow(contour: Contour, structure: Structure): HTMLElement {
    const { project, call, show } = this.services;
    const { name, position } = this.planeOf(contour);
    const dot = el("span", { class: "plane-dot" });
    dot.style.background = name ? PLANE_COLORS[name] : PLANE_COLORS.oblique;
    const isSelected = project.selection?.contour === contour.id;
    const points = contour.control.length > 1 ? `${contour.control.length} pts` : `${contour.points.length} pts`;
    const kind = KIND_LABELS[contour.kind];
    const row = el(
      "div",
      { class: "contour-row" + (isSelected ? " selected" : "") + (contour.visible && structure.visible ? "" : " off"), "data-contour": contour.id, "data-kind": contour.kind, title: `${kind}; click to show it` },
      dot,
      el("span", { class: "contour-plane" }, `${name ? VIEW_TITLES[name] : "Oblique"} ${position}`),
      contour.hole ? el("span", { class: "hole-flag", title: "A hole" }, "hole") : null,
      el("span", { class: "contour-points" }, points),
      eye(contour.visible, () => call("contour.set", { id: contour.id, visible: !contour.visible })),
      button({ icon: ICONS.remove, title: "Delete this contour", class: "icon-button small", test: "delete-contour", onclick: () => call("contour.remove", { ids: [contour.id] }) }),
    );
    row.onclick = (event) => {
      if ((event.target as HTMLElement).closest("button")) return;
      project.select({ contour: contour.id, point: null });
      show(contour);
    };
    return row;
  }

  /** The view whose unturned planes the contour is parallel to, and where along them it lies. */
  private planeOf(contour: Contour): { name: ViewName | null; position: string } {
    const { normal, origin } = contour.plane;
    const name = this.services.navigation.unturnedViewAlong(normal);
    const axis = [0, 1, 2].find((i) => Math.abs(normal[i]!) > 0.9999);
    if (axis === undefined) return { name, position: dot(origin, normal).toFixed(1) };
    const letter = (["RL", "AP", "IS"] as const)[axis]![origin[axis]! >= 0 ? 1 : 0]!;
    return { name, position: `${letter} ${Math.abs(origin[axis]!).toFixed(1)}` };
  }

  private updateActions(): void {
    const { project, call, editor, copySelected } = this.services;
    const contour = project.selectedContour;
    this.actions.hidden = !contour;
    if (!contour) return;
    const hole = el("input", { type: "checkbox", checked: contour.hole });
    hole.onchange = () => call("contour.set", { id: contour.id, hole: hole.checked });
    const structure = el("select", { title: "The structure that this contour belongs to" });
    structure.append(...[...project.structures.values()].map((entry) => el("option", { value: String(entry.id), selected: entry.id === contour.structure }, entry.name)));
    structure.onchange = () => call("contour.set", { id: contour.id, structure: Number(structure.value) });
    this.actions.replaceChildren(
      el("span", {}, "Copy to"),
      button({ icon: ICONS.copyDown, label: "next", title: "Copy to the next slice (C)", class: "tool", test: "copy-next", onclick: () => copySelected(1) }),
      button({ icon: ICONS.copyUp, label: "previous", title: "Copy to the previous slice (Shift+C)", class: "tool", onclick: () => copySelected(-1) }),
      button({ icon: ICONS.remove, label: "Delete", title: "Delete the contour, or its selected point (Del)", class: "tool", onclick: () => editor.edits.deleteSelected() }),
      el("label", { class: "check", title: "The inside of this contour does not belong to the structure" }, hole, "Hole"),
      structure,
    );
  }

  private updateQuality(): void {
    const { project } = this.services;
    const structure = project.activeStructure;
    const surface = structure && project.surfaces.get(structure.id);
    this.quality.replaceChildren(...this.qualityEntries(surface));
    this.element.dataset["revision"] = String(surface?.revision ?? 0);
    this.element.dataset["stage"] = surface?.stage ?? "none";
    this.element.dataset["structure"] = String(structure?.id ?? 0);
  }

  private qualityEntries(surface: Surface | undefined): HTMLElement[] {
    if (!surface || surface.stage === "none") {
      const troubles = surface ? this.troubles(surface) : [];
      return troubles.length > 0 ? troubles : [el("p", { class: "empty" }, "No surface yet.")];
    }
    const entries: HTMLElement[] = [];
    if (surface.volume_ml !== undefined) entries.push(figure("Volume", `${volume(surface.volume_ml)} ml`));
    const { residual } = surface;
    if (residual) {
      entries.push(figure("Residual (rms)", `${residual.rms_mm.toFixed(2)} mm`));
      entries.push(this.place(`largest residual ${residual.max_mm.toFixed(2)} mm`, residual.at, "Go to where the surface is farthest from a contour", "residual"));
    }
    return [...entries, ...this.troubles(surface)];
  }

  private troubles({ conflicts = [], warnings = [] }: Surface): HTMLElement[] {
    const title = "Go to where two contours contradict each other";
    return [
      ...warnings.map((text) => el("p", { class: "warning-text" }, text)),
      ...conflicts.map(({ at, distance_mm }) => this.place(`contours disagree by ${distance_mm.toFixed(1)} mm`, at, title, "conflict")),
    ];
  }

  private place(label: string, at: Vec3, title: string, kind: "residual" | "conflict"): HTMLElement {
    return button({ label, icon: kind === "conflict" ? ICONS.warning : ICONS.lines, title, class: `place ${kind}`, test: kind, onclick: () => this.services.goTo(at) });
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

const volume = (ml: number): string => (ml >= 100 ? ml.toFixed(0) : ml.toPrecision(3));

const figure = (label: string, value: string): HTMLElement => el("div", { class: "figure" }, el("span", {}, label), el("strong", {}, value));

function eye(visible: boolean, onclick: () => void): HTMLButtonElement {
  return button({ icon: visible ? ICONS.eye : ICONS.eyeOff, title: visible ? "Hide" : "Show", class: "icon-button small" + (visible ? "" : " dimmed"), onclick });
}
