// SPDX-License-Identifier: Apache-2.0
import type { Point2, Screen } from "../geometry/screen";
import { Emitter } from "../model/emitter";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { StretchKind, ViewName } from "../net/protocol";
import { ContourEdits } from "./contour_edits";
import { Drawing } from "./drawing";
import type { Gesture, Modifiers } from "./gesture";
import { hitContour, type ContourHit, type LineHit } from "./hit";
import { PlaneLines } from "./plane_lines";
import type { EditorServices } from "./services";

export type ToolName = "edit" | "freehand" | "spline" | "wire" | "redraw" | "move";

const KIND_OF_TOOL: Partial<Record<ToolName, StretchKind>> = { freehand: "line", spline: "spline", wire: "wire" };
const TOOL_OF_KIND: Record<StretchKind, ToolName> = { free: "freehand", line: "freehand", spline: "spline", wire: "wire" };

export type Hover = { contour: ContourHit; view: ViewName } | { line: LineHit; view: ViewName } | null;

/** The tools: hands presses and moves on a view to what draws, edits or looks around. */
export class Editor extends Emitter<"tool" | "hover"> {
  tool: ToolName = "edit";
  hover: Hover = null;
  readonly drawing: Drawing;
  readonly edits: ContourEdits;
  readonly planeLines: PlaneLines;

  constructor(
    private readonly navigation: Navigation,
    private readonly project: Project,
    services: EditorServices,
  ) {
    super();
    this.drawing = new Drawing(project, services);
    this.edits = new ContourEdits(navigation, project, this.drawing, services);
    this.planeLines = new PlaneLines(navigation, project, services.screenOf);
    this.drawing.on(["resumed"], () => this.takeToolOfSketch());
  }

  choose(tool: ToolName): void {
    if (tool === this.tool) return;
    this.tool = tool;
    const { drawing } = this;
    const kind = KIND_OF_TOOL[tool];
    if (kind) drawing.sketch?.setKind(kind);
    else if (!drawing.sketch?.isUnsaved) drawing.leave();
    this.setHover(null);
    this.emit("tool");
    drawing.changed();
  }

  private takeToolOfSketch(): void {
    const { redraws, kind } = this.drawing.sketch!;
    this.tool = redraws === undefined ? TOOL_OF_KIND[kind] : "redraw";
    this.emit("tool");
  }

  get draws(): boolean {
    return this.tool in KIND_OF_TOOL;
  }

  toggleLines(): void {
    this.planeLines.areShown = !this.planeLines.areShown;
    this.emit("hover");
  }

  press(view: ViewName, screen: Screen, pointer: Point2, modifiers: Modifiers): Gesture | null {
    const hit = this.contourAt(view, screen, pointer);
    const step_mm = this.navigation.step(view);
    const kind = KIND_OF_TOOL[this.tool];
    if (kind) return this.isEditable(hit) ? this.edits.press(screen, pointer, hit, modifiers) : this.drawing.press(screen, step_mm, pointer, kind);
    if (this.tool === "redraw") return this.edits.redraw(screen, step_mm, pointer, hit);
    if (this.tool === "move") return hit ? this.edits.move(screen, pointer, hit.contour) : null;
    if (hit) return this.edits.press(screen, pointer, hit, modifiers);
    return this.planeLines.press(view, screen, pointer);
  }

  moved(view: ViewName, screen: Screen, pointer: Point2): void {
    const contour = this.contourAt(view, screen, pointer);
    if (this.draws) {
      this.setHover(this.isEditable(contour) ? { contour, view } : null);
      return this.drawing.stretchRubber(screen, this.navigation.step(view), pointer);
    }
    if (contour) return this.setHover({ contour, view });
    if (this.tool !== "edit") return this.setHover(null);
    const line = this.planeLines.at(view, screen, pointer);
    this.setHover(line ? { line, view } : null);
  }

  left(): void {
    this.setHover(null);
    this.drawing.dropRubber();
  }

  doubleClick(): void {
    if (this.drawing.sketch) this.drawing.close();
  }

  cursor(): string {
    if (this.tool === "redraw" || (this.draws && !this.hover)) return "crosshair";
    if (!this.hover) return this.tool === "move" ? "default" : "crosshair";
    if ("contour" in this.hover) return this.tool === "move" ? "move" : this.hover.contour.on === "point" ? "grab" : "pointer";
    return this.hover.line.on === "turn" ? "alias" : "move";
  }

  private contourAt(view: ViewName, screen: Screen, pointer: Point2): ContourHit | null {
    const selected = this.project.selection?.contour ?? null;
    return hitContour(this.project.shownContours(), screen, this.navigation.step(view), pointer, selected);
  }

  /** With a drawing tool the contour that was drawn last can be mended at once, others are out of the way. */
  private isEditable(hit: ContourHit | null): hit is ContourHit {
    return hit !== null && !this.drawing.sketch && hit.contour === this.project.selection?.contour;
  }

  private setHover(hover: Hover): void {
    if (JSON.stringify(hover) === JSON.stringify(this.hover)) return;
    this.hover = hover;
    this.emit("hover");
  }
}
