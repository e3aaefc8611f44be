// SPDX-License-Identifier: Apache-2.0
import type { Point2, Screen } from "../geometry/screen";
import { Emitter } from "../model/emitter";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import { changesDrawing, type Maker } from "../net/calls";
import type { ViewName } from "../net/protocol";
import { ContourEdits } from "./contour_edits";
import { Drafts } from "./drafts";
import { Drawing } from "./drawing";
import type { Gesture, Modifiers } from "./gesture";
import { hitContour } from "./hit";
import { Measuring } from "./measuring";
import { OutlineEdits } from "./outline_edits";
import type { ToolPainter } from "./painter";
import type { Place } from "./place";
import { PlaneLines } from "./plane_lines";
import { PlanesOfMask } from "./planes_of_mask";
import { Proposals } from "./proposals";
import { Pushing } from "./pushing";
import { TOOLS, toolNamed, type ToolName } from "./registry";
import type { EditorServices } from "./services";
import { RulePreview } from "./rule_preview";
import { SinglePoints } from "./single_points";
import type { Hover, Tool, ToolContext } from "./tool";

/** Hands presses and moves on a view to the tool that the user has chosen. */
export class Editor extends Emitter<"tool" | "hover"> implements ToolContext {
  tool: Tool<ToolName> = toolNamed("edit");
  hover: Hover = null;
  /** All that is drawn and fitted is out of sight, so that the image can be looked at; what is not seen is not edited. */
  isBare = false;
  private pointer: { view: ViewName; at: Point2 } | null = null; // where it was moved last, until it left the view
  readonly drawing: Drawing;
  readonly edits: ContourEdits;
  readonly outlines: OutlineEdits;
  readonly planeLines: PlaneLines;
  readonly pushing: Pushing;
  readonly proposals: Proposals;
  readonly points: SinglePoints;
  readonly planesOfMask: PlanesOfMask;
  readonly measuring = new Measuring();
  readonly rulePreview = new RulePreview();

  constructor(
    readonly navigation: Navigation,
    readonly project: Project,
    private readonly services: EditorServices,
  ) {
    super();
    this.drawing = new Drawing(project, services);
    const drafts = new Drafts(project, services);
    this.edits = new ContourEdits(navigation, project, this.drawing, drafts, services);
    this.outlines = new OutlineEdits(navigation, project, this.drawing, drafts, services);
    this.pushing = new Pushing(project, this.drawing, { edits: this.edits, outlines: this.outlines, drafts }, services);
    this.points = new SinglePoints(project, this.edits, services);
    this.planesOfMask = new PlanesOfMask(navigation, project, services);
    this.proposals = new Proposals(navigation, project, this.drawing, services);
    this.planeLines = new PlaneLines(navigation, project, services.screenOf);
    this.drawing.on(["resumed"], () => this.takeToolOfSketch());
  }

  choose(id: ToolName): void {
    if (id === this.tool.id) return;
    this.tool.leave?.(this);
    this.tool = toolNamed(id);
    const { drawing } = this;
    if (this.tool.stretch) drawing.sketch?.setKind(this.tool.stretch);
    else if (!drawing.sketch?.isUnsaved) drawing.leave();
    this.setHover(null);
    this.emit("tool");
    drawing.changed();
    this.hoverAgain();
  }

  /** The pointer has not moved, but what it would do may be something else. */
  private hoverAgain(): void {
    const screen = this.pointer && this.services.screenOf(this.pointer.view);
    if (screen) this.moved(this.pointer!.view, screen, this.pointer!.at);
  }

  private takeToolOfSketch(): void {
    const sketch = this.drawing.sketch!;
    this.tool = TOOLS.find((tool) => tool.resumes?.(sketch)) ?? this.tool;
    this.emit("tool");
  }

  toggleLines(): void {
    this.planeLines.areShown = !this.planeLines.areShown;
    this.emit("hover");
  }

  showBare(isBare: boolean): void {
    this.isBare = isBare;
    this.emit("hover");
  }

  press(view: ViewName, screen: Screen, pointer: Point2, modifiers: Modifiers): Gesture | null {
    if (this.isBare || this.mayNotEdit() || this.isMadeByRule() || this.isLocked()) return null;
    return this.tool.press(this, this.place(view, screen, pointer), modifiers);
  }

  /** Whether the tool would edit what belongs to another time than the one that is seen. Says so. */
  mayNotEdit(): boolean {
    return !this.tool.looksAround && this.isAnotherTime();
  }

  /** Whether a line would be drawn into a structure that a rule makes. Says so. */
  private isMadeByRule(): boolean {
    const active = this.project.activeStructure;
    if (active?.rule === undefined || !this.tool.stretch || this.drawing.sketch) return false;
    this.services.tell(`${active.name} is made by the rule ${active.rule}. Freeze it to draw in it, or choose another structure.`);
    return true;
  }

  /** Whether what is active is not to be changed: nothing is drawn in it. Says so. */
  private isLocked(): boolean {
    const active = this.project.activeStructure;
    if (active?.review?.locked !== true || this.tool.looksAround) return false;
    this.services.tell(`${active.name} is locked. Unlock it in the list to change it, or choose another structure.`);
    return true;
  }

  /** What a button asks for: as keys do, it changes nothing that belongs to another time than the one that is seen. */
  readonly make: Maker = (name, args) => {
    if (changesDrawing(name, args) && this.isAnotherTime()) return this.project.refused();
    this.edits.make(name, args);
  };

  /** Whether what is worked on belongs to another time than the one that is seen: what is being drawn, or a mask, which has one. */
  get isOutOfTime(): boolean {
    const { navigation, project, drawing } = this;
    if (drawing.sketch) return project.timeOf(drawing.sketch) !== navigation.time;
    return navigation.isAway && project.activeStructure?.mask !== undefined;
  }

  /** The same. Says so, and offers to go there. */
  isAnotherTime(): boolean {
    if (!this.isOutOfTime) return false;
    const { navigation, project, drawing } = this;
    const own = drawing.sketch ? project.timeOf(drawing.sketch) : navigation.ownTime;
    const what = drawing.sketch ? "What you are drawing" : project.activeStructure!.name;
    const now = drawing.sketch ? `this is frame ${navigation.time + 1}` : `in frame ${navigation.time + 1} it is only to be looked at`;
    this.services.tell(`${what} belongs to frame ${own + 1}; ${now}.`, {
      label: `Go to frame ${own + 1}`,
      act: () => navigation.setTime(own),
    });
    return true;
  }

  moved(view: ViewName, screen: Screen, pointer: Point2): void {
    this.pointer = { view, at: pointer };
    const isIdle = this.isOutOfTime && !this.tool.looksAround;
    this.setHover(isIdle ? null : this.tool.hover(this, this.place(view, screen, pointer)));
  }

  left(): void {
    this.pointer = null;
    this.tool.left?.(this);
    this.setHover(null);
    this.drawing.dropRubber();
  }

  /** Makes a contour of the outline of the slice under the pointer, or else of the one that the keyboard is in. */
  adoptOutline(focused: ViewName): void {
    const view = this.pointer?.view ?? focused;
    if (this.project.activeStructure?.mask) return this.planesOfMask.confirm(view);
    this.outlines.adopt(this.pointer?.view ?? focused, this.pointer?.at ?? null);
  }

  /** What is proposed is empty, or else the slice of a mask under the pointer. False where neither can be meant. */
  nothingHere(focused: ViewName): boolean {
    if (this.proposals.nothingHere()) return true;
    if (!this.project.activeStructure?.mask) return false;
    this.planesOfMask.empty(this.pointer?.view ?? focused);
    return true;
  }

  /** Ends what is drawn as an open line, or else opens the selected contour, at the stretch under the pointer, or closes it if it is open. */
  openOrClose(): void {
    if (this.drawing.sketch) return this.drawing.endOpen();
    const { hover } = this;
    this.edits.openOrClose(hover && "contour" in hover ? hover.contour : null);
  }

  /** False where the wheel with Ctrl means nothing to the tool. */
  wheel(factor: number): boolean {
    if (!this.tool.wheel) return false;
    this.tool.wheel(this, factor);
    this.emit("hover");
    return true;
  }

  /** Del. */
  remove(): void {
    if (this.mayNotEdit()) return;
    if (!this.tool.remove?.(this) && !this.isAnotherTime()) this.edits.deleteSelected();
    this.emit("hover");
  }

  /** Backspace: of what is being drawn the last point. */
  removeLast(): void {
    if (!this.drawing.sketch) this.remove();
    else if (!this.isAnotherTime()) this.drawing.removeLastPoint();
  }

  /** Esc while nothing is drawn: what the tool has begun; false where that is nothing. */
  leaveBegun(): boolean {
    const left = this.tool.leave?.(this) ?? false;
    if (left) this.emit("hover");
    return left;
  }

  doubleClick(): void {
    if (this.drawing.sketch && !this.mayNotEdit()) this.drawing.finish();
  }

  cursor(): string {
    return this.tool.cursor(this.hover);
  }

  paint(painter: ToolPainter, view: ViewName): void {
    this.tool.paint?.(painter, this, view, this.hover);
  }

  private place(view: ViewName, screen: Screen, pointer: Point2): Place {
    const step_mm = this.navigation.step(view);
    const selected = this.project.selection?.contour ?? null;
    return { view, screen, step_mm, pointer, hit: hitContour(this.project.shownContours(), screen, step_mm, pointer, selected) };
  }

  private setHover(hover: Hover): void {
    if (JSON.stringify(hover) === JSON.stringify(this.hover)) return;
    this.hover = hover;
    this.emit("hover");
  }
}
