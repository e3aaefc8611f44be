// SPDX-License-Identifier: Apache-2.0
import type { Contour } from "../net/protocol";
import { BorderPanel } from "./borders";
import { ContourActions, type ActionServices } from "./contour_actions";
import type { RowServices } from "./contour_rows";
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { render } from "../dom/pieces";
import { qualityOf } from "./quality";
import { RuleLine, type RuleServices } from "./rule_line";
import { SmoothingSlider } from "./smoothing";
import { StructureList } from "./structure_list";
import { UseImageSwitch } from "./use_image";

export interface PanelServices extends RowServices, ActionServices, Omit<RuleServices, "preview"> {
  /** Whose image it is. */
  identity: HTMLElement;
  /** What others have drawn on it. */
  near: HTMLElement;
  secondImage: HTMLElement;
  /** Of two structures that are compared. */
  differences: HTMLElement;
  openStatistics(): void;
  /** Shows where to draw next. */
  suggest(): void;
  addStructure(): void;
}

/** Structures with their contours, and how well the surface fits them. */
export class Panel {
  readonly element = el("aside", { class: "panel", "aria-label": "Structures and contours" });
  private readonly list: StructureList;
  private readonly actions: ContourActions;
  private readonly quality = el("div", { class: "quality" });
  private queued = false;

  constructor(private readonly services: PanelServices) {
    const { project } = services;
    const rule = new RuleLine({ ...services, preview: services.editor.rulePreview });
    this.list = new StructureList({ ...services, editRule: (line) => rule.open(line) }, () => this.update());
    this.actions = new ContourActions(services);
    const add = button({ icon: ICONS.add, title: "Add a structure", class: "icon-button small", test: "add-structure", click: services.addStructure });
    const addRule = button({
      icon: ICONS.rule,
      title: "Add a structure that follows others by a rule, as PTV = CTV + 5 mm",
      class: "icon-button small",
      test: "add-rule",
      click: () => rule.open(),
    });
    const measure = button({
      icon: ICONS.statistics,
      title: "Statistics: volume, surface, diameters, values of all structures",
      class: "icon-button small",
      test: "statistics-open",
      click: services.openStatistics,
    });
    this.element.append(
      services.identity,
      services.near,
      services.secondImage,
      services.differences,
      el("div", { class: "panel-title" }, el("span", {}, "Structures"), el("span", { class: "panel-buttons" }, addRule, add)),
      rule.element,
      this.list.filter,
      this.list.element,
      new BorderPanel(services).element,
      this.actions.element,
      el("div", { class: "panel-title" }, el("span", {}, "Surface"), measure),
      new UseImageSwitch(services).element,
      new SmoothingSlider(services).element,
      this.quality,
    );
    project.on(["structures", "contours", "selection", "surfaces", "stages", "refused", "time", "motions"], () => this.update());
    services.points.on(["points"], () => this.update());
    services.editor.proposals.on(["proposal"], () => this.update());
  }

  /** Lets the user type another name. */
  rename(structure: number | undefined): void {
    this.list.rename(structure);
  }

  /** Once in a frame, however much has changed. */
  private update(): void {
    if (this.queued) return;
    this.queued = true;
    requestAnimationFrame(() => {
      this.queued = false;
      this.list.update();
      this.actions.update();
      this.updateQuality();
    });
  }

  private updateQuality(): void {
    const { project } = this.services;
    const structure = project.activeStructure;
    const surface = structure && project.seenSurface(structure.id);
    const { proposals } = this.services.editor;
    const nothingHere =
      structure && proposals.shown?.structure === structure.id ? () => void (this.services.editor.isAnotherTime() || proposals.nothingHere()) : null;
    const isProposed = structure !== undefined && proposals.shown?.structure === structure.id;
    const otherProposal = isProposed && proposals.shown?.others?.length ? () => void (this.services.editor.isAnotherTime() || proposals.other()) : null;
    const actions = { nothingHere, otherProposal, show: (contour: Contour) => this.show(contour) };
    render(this.quality, qualityOf(surface, structure ? project.contoursOf(structure.id) : [], { ...this.services, ...actions }, structure));
    this.element.dataset["revision"] = String(structure ? project.revisionAt(structure.id) : 0);
    this.element.dataset["stage"] = surface?.stage ?? "none";
    this.element.dataset["image"] = surface?.image?.verdict ?? "none";
    this.element.dataset["structure"] = String(structure?.id ?? 0);
  }

  private show(contour: Contour): void {
    this.services.project.select({ contour: contour.id, point: null });
    this.services.show(contour);
  }
}
