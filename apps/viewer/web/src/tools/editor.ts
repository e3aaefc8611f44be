// SPDX-License-Identifier: Apache-2.0
import { gap, planeOf, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import { heightOver } from "../geometry/plane";
import { add, dot, scale, sub, type Vec3 } from "../geometry/vec";
import { Emitter } from "../model/emitter";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import { ServerError } from "../net/http";
import { Latest } from "../net/latest";
import type { Contour, PathResult, StretchKind, ViewName } from "../net/protocol";
import { hitContour, hitPlaneLines, inView, planeLine, type ContourHit, type LineHit, type PlaneLine } from "./hit";
import { Sketch, type SavedSketch } from "./sketch";
import { VIEW_NAMES } from "../net/protocol";

export type ToolName = "edit" | "freehand" | "spline" | "wire" | "redraw" | "move";

const KIND_OF_TOOL: Partial<Record<ToolName, StretchKind>> = { freehand: "line", spline: "spline", wire: "wire" };
const TOOL_OF_KIND: Record<StretchKind, ToolName> = { free: "freehand", line: "freehand", spline: "spline", wire: "wire" };
const CLOSE_PIXELS = 11;
const CLICK_PIXELS = 5; // a press that moves less is a click
const HAND_STEP_PIXELS = 1.5;

export interface Modifiers {
  ctrl: boolean;
  shift: boolean;
}

/** What follows a press of the left button until it is released. */
export interface Gesture {
  move(pointer: Point2): void;
  end(pointer: Point2): void;
  cancel?(): void;
}

export interface EditorServices {
  call<Result>(name: string, args?: Record<string, unknown>): Promise<Result>;
  screenOf(view: ViewName): Screen | null;
  failed(error: unknown): void;
  tell(text: string): void;
  /** A closed contour that the server did not take, which stays. */
  notSaved(why: string): void;
}

export type Hover = { contour: ContourHit; view: ViewName } | { line: LineHit; view: ViewName } | null;

/** The tools: turns presses, moves and keys on a view into calls that draw and edit. */
export class Editor extends Emitter<"tool" | "sketch" | "points" | "hover"> {
  tool: ToolName = "edit";
  sketch: Sketch | null = null;
  /** The sketch's line as the server made it, and the line on to the pointer. */
  placedLine: Vec3[] = [];
  rubberLine: Vec3[] = [];
  /** Drawn by hand at this moment, or about to replace a stretch. */
  handLine: Vec3[] = [];
  pointer: Vec3 | null = null;
  pointerCloses = false;
  hover: Hover = null;
  linesShown = true;
  /** The sketch that was left last, and by what: undo or redo brings it back, until something else is done. */
  private leftSketch: { sketch: Sketch; by: "leaving" | "undo" } | null = null;

  /** Closed sketches that the server has not acknowledged, and those that it did not take and that are not shown yet. */
  private readonly adding = new Map<Sketch, Vec3[]>(); // with their lines
  private readonly waiting: Sketch[] = [];
  private added: Promise<void> = Promise.resolve();

  private readonly placed = new Latest<Sketch>((sketch) => this.askPlaced(sketch));
  private readonly rubber = new Latest<{ sketch: Sketch; pointer: Vec3; mm: number }>((request) => this.askRubber(request));
  private readonly drafts = new Latest<{ name: string; args: Record<string, unknown> }>((edit) => this.askDraft(edit));
  private sketchScale = 1;

  constructor(
    private readonly navigation: Navigation,
    private readonly project: Project,
    private readonly services: EditorServices,
  ) {
    super();
    project.on(["contours"], () => this.forgetSaved());
  }

  // Tools

  choose(tool: ToolName): void {
    if (tool === this.tool) return;
    this.tool = tool;
    const kind = KIND_OF_TOOL[tool];
    if (kind) this.sketch?.setKind(kind);
    else if (!this.sketch?.isUnsaved) this.leaveSketch();
    this.setHover(null);
    this.emit("tool", "sketch", "points");
  }

  get draws(): boolean {
    return this.tool in KIND_OF_TOOL;
  }

  toggleLines(): void {
    this.linesShown = !this.linesShown;
    this.emit("hover");
  }

  /** The other views' planes as lines on this one. */
  lines(view: ViewName, screen: Screen): PlaneLine[] {
    if (!this.linesShown) return [];
    return VIEW_NAMES.filter((other) => other !== view)
      .map((other) => planeLine(screen, this.navigation.crosshair, other, this.navigation.cameras[other].axes))
      .filter((line): line is PlaneLine => line !== null);
  }

  // Pointer

  press(view: ViewName, screen: Screen, pointer: Point2, modifiers: Modifiers): Gesture | null {
    const hit = this.contourAt(view, screen, pointer);
    if (this.draws) return this.isEditable(hit) ? this.pressOnContour(screen, pointer, hit, modifiers) : this.pressToDraw(view, screen, pointer);
    if (this.tool === "redraw") return this.redrawGesture(screen, this.navigation.step(view), pointer, hit);
    if (this.tool === "move") return hit ? this.moveGesture(screen, pointer, hit.contour) : null;
    if (hit) return this.pressOnContour(screen, pointer, hit, modifiers);
    return this.pressOnLines(view, screen, pointer);
  }

  moved(view: ViewName, screen: Screen, pointer: Point2): void {
    this.pointer = toWorld(screen, pointer);
    const contour = this.contourAt(view, screen, pointer);
    if (this.draws) {
      this.setHover(this.isEditable(contour) ? { contour, view } : null);
      return this.stretchRubber(view, screen, pointer);
    }
    if (contour) return this.setHover({ contour, view });
    if (this.tool !== "edit") return this.setHover(null);
    const line = hitPlaneLines(this.lines(view, screen), toScreen(screen, this.navigation.crosshair), pointer);
    this.setHover(line ? { line, view } : null);
  }

  left(): void {
    this.pointer = null;
    this.rubber.drop();
    this.rubberLine = [];
    this.setHover(null);
    this.emit("sketch");
  }

  doubleClick(): void {
    if (this.sketch) this.close();
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
    return hit !== null && !this.sketch && hit.contour === this.project.selection?.contour;
  }

  private setHover(hover: Hover): void {
    if (JSON.stringify(hover) === JSON.stringify(this.hover)) return;
    this.hover = hover;
    this.emit("hover");
  }

  // Drawing

  private pressToDraw(view: ViewName, screen: Screen, pointer: Point2): Gesture | null {
    if (this.sketch?.isClosed) {
      this.services.tell("The contour that you drew is not saved. Enter tries again, Esc gives it up.");
      return null;
    }
    if (this.sketch && !this.sketch.liesIn(planeOf(screen), this.navigation.step(view) / 2)) {
      this.services.tell("The contour you began lies in another plane. Enter closes it, Esc leaves it.");
      return null;
    }
    const start = toWorld(screen, pointer);
    const hand: Vec3[] = [start];
    let last = pointer;
    let isDrag = false;
    return {
      move: (at) => {
        isDrag ||= gap(at, pointer) > CLICK_PIXELS;
        if (gap(at, last) < HAND_STEP_PIXELS) return;
        last = at;
        hand.push(toWorld(screen, at));
        if (!isDrag) return;
        this.handLine = hand;
        this.rubberLine = [];
        this.pointerCloses = this.isNearStart(screen, at);
        this.emit("sketch");
      },
      end: (at) => {
        this.handLine = [];
        this.sketchScale = screen.mm_per_pixel;
        if (isDrag) this.endHand(screen, at, hand);
        else this.click(screen, at);
      },
      cancel: () => {
        this.handLine = [];
        this.emit("sketch");
      },
    };
  }

  private endHand(screen: Screen, at: Point2, hand: Vec3[]): void {
    const closes = this.isNearStart(screen, at);
    if (!this.sketch && this.tool === "freehand") {
      const structure = this.project.activeStructure?.id ?? 0;
      return this.add(Sketch.closedFree(planeOf(screen), structure, hand));
    }
    const sketch = this.begun(screen);
    sketch.drawFree(hand);
    if (closes && sketch.canClose) {
      sketch.points.pop(); // the stretch ends at the first point instead
      return this.close();
    }
    this.sketchChanged();
  }

  private click(screen: Screen, at: Point2): void {
    const sketch = this.begun(screen);
    const onLast = sketch.last && gap(toScreen(screen, sketch.last.at), at) < 3;
    if ((this.isNearStart(screen, at) && sketch.canClose) || (onLast && sketch.canClose)) return this.close();
    if (onLast) return;
    sketch.place(toWorld(screen, at));
    this.sketchChanged();
  }

  private begun(screen: Screen): Sketch {
    const structure = this.project.activeStructure?.id ?? 0;
    this.sketch ??= new Sketch(planeOf(screen), structure, KIND_OF_TOOL[this.tool] ?? "line");
    this.leftSketch = null;
    this.project.select(null);
    return this.sketch;
  }

  private isNearStart(screen: Screen, at: Point2): boolean {
    const first = this.sketch?.first;
    return first !== undefined && this.sketch!.points.length > 1 && gap(toScreen(screen, first), at) < CLOSE_PIXELS;
  }

  private sketchChanged(): void {
    this.rubberLine = [];
    if (this.sketch) this.placed.send(this.sketch);
    this.emit("sketch", "points");
  }

  private stretchRubber(view: ViewName, screen: Screen, pointer: Point2): void {
    if (this.sketch?.last && !this.sketch.isClosed && this.sketch.liesIn(planeOf(screen), this.navigation.step(view) / 2)) {
      this.pointerCloses = this.isNearStart(screen, pointer) && this.sketch.canClose;
      const target = this.pointerCloses ? this.sketch.first! : toWorld(screen, pointer);
      this.rubber.send({ sketch: this.sketch, pointer: target, mm: screen.mm_per_pixel });
    }
    this.emit("sketch");
  }

  private async askPlaced(sketch: Sketch): Promise<void> {
    if (sketch.points.length < 2) {
      this.placedLine = sketch.line();
      if (sketch.last?.kind !== "wire") return;
    }
    const { points, isClosed } = sketch;
    const count = points.length;
    const result = await this.path(sketch, points, isClosed).catch(() => null);
    if (this.sketch !== sketch || sketch.points.length !== count || sketch.isClosed !== isClosed) return;
    if (result) sketch.adopt(result.control);
    this.placedLine = result ? [...result.points, ...(isClosed ? result.points.slice(0, 1) : [])] : sketch.line();
    this.emit("sketch");
  }

  private async askRubber({ sketch, pointer, mm }: { sketch: Sketch; pointer: Vec3; mm: number }): Promise<void> {
    if (this.sketch !== sketch) return;
    this.sketchScale = mm;
    const count = sketch.points.length;
    const result = await this.path(sketch, sketch.rubberBand(pointer));
    if (this.sketch !== sketch || sketch.points.length !== count) return;
    this.rubberLine = result.points.slice(result.control.at(-2)?.index ?? 0);
    this.emit("sketch");
  }

  private path(sketch: Sketch, control: unknown[], closed = false): Promise<PathResult> {
    const plane = { ...sketch.plane, mm_per_pixel: this.sketchScale };
    return this.services.call<PathResult>("path", { plane, control, closed });
  }

  /** Makes a contour of the sketch. */
  close(): void {
    const sketch = this.sketch;
    if (!sketch) return;
    if (!sketch.canClose) return this.services.tell("A contour needs at least three points.");
    const line = sketch.isClosed || this.placedLine.length < 2 ? sketch.closedLine() : [...this.placedLine, sketch.first!];
    this.clearSketch();
    this.add(sketch, line);
  }

  /** Puts the sketch aside, from where undo brings it back. */
  leaveSketch(): void {
    if (this.sketch) this.leftSketch = { sketch: this.sketch, by: "leaving" };
    this.clearSketch();
    this.showWaiting();
  }

  private clearSketch(): void {
    this.sketch = null;
    this.placedLine = [];
    this.rubberLine = [];
    this.handLine = [];
    this.pointerCloses = false;
    this.placed.drop();
    this.rubber.drop();
    this.emit("sketch", "points");
  }

  removeLastPoint(): void {
    const sketch = this.sketch;
    if (!sketch) return;
    sketch.removeLast();
    if (!sketch.isEmpty) return this.sketchChanged();
    this.clearSketch();
    this.leftSketch = { sketch, by: "undo" };
    this.emit("points");
    this.showWaiting();
  }

  /** Goes on with a sketch from before. */
  resume(sketch: Sketch): void {
    this.leftSketch = null;
    this.tool = TOOL_OF_KIND[sketch.kind];
    this.take(sketch);
    this.emit("tool");
  }

  private take(sketch: Sketch): void {
    this.sketch = sketch;
    this.placedLine = sketch.line();
    this.project.select(null);
    this.sketchChanged();
  }

  /** What undo and redo do to the sketch, or to the one that was left last; null: they are the project's. */
  get undoLabel(): string | null {
    if (this.sketch) return "Place a point";
    return this.leftSketch?.by === "leaving" ? "Leave the contour" : null;
  }

  get redoLabel(): string | null {
    if (this.sketch) return this.sketch.canRestore ? "Place a point" : null;
    return this.leftSketch?.by === "undo" ? "Place a point" : null;
  }

  /** False where there is nothing of this kind to undo. */
  undo(): boolean {
    if (this.sketch) this.removeLastPoint();
    else if (this.leftSketch?.by === "leaving") this.resume(this.leftSketch.sketch);
    else return false;
    return true;
  }

  redo(): boolean {
    if (!this.sketch && this.leftSketch?.by !== "undo") return false;
    const sketch = this.sketch ?? this.leftSketch!.sketch;
    if (!sketch.canRestore) return true; // a sketch has its own history, in which this was the end
    sketch.restoreLast();
    if (this.sketch) this.sketchChanged();
    else this.resume(sketch);
    return true;
  }

  // Closed sketches, until the server has them

  /** Whether a closed contour is not saved, and waits for the user to try again. */
  get hasUnsaved(): boolean {
    return this.sketch?.isUnsaved === true || this.waiting.length > 0;
  }

  get isAdding(): boolean {
    return this.adding.size > 0;
  }

  /** Carries out what belongs behind the closed contours that are on their way. */
  afterAdding(act: () => void): void {
    if (this.isAdding) void this.added.then(act);
    else act();
  }

  /** The lines of closed contours that are not there yet, for as long as that takes. */
  closedLines(): { sketch: Sketch; line: Vec3[] }[] {
    return [...this.adding, ...this.waiting.map((sketch): [Sketch, Vec3[]] => [sketch, sketch.closedLine()])].map(([sketch, line]) => ({ sketch, line }));
  }

  /** What a next visit has to bring back beside the sketch. */
  savedUnsaved(): SavedSketch[] {
    return [...this.adding.keys(), ...this.waiting].map((sketch) => ({ ...sketch.saved(), isUnsaved: true }));
  }

  /** Goes on where the last visit ended, but for what the project has got since it was told. */
  restore(sketch: SavedSketch | undefined, unsaved: SavedSketch[]): void {
    this.waiting.push(...unsaved.map((saved) => Sketch.from(saved)).filter((one) => !this.isSaved(one)));
    const current = sketch && Sketch.from(sketch);
    if (current && !this.isSaved(current)) this.resume(current);
    this.showWaiting();
    if (this.hasUnsaved) this.services.notSaved("Before this page was opened the connection to kontur was lost, or it could not save.");
  }

  private add(sketch: Sketch, line = sketch.closedLine()): void {
    this.leftSketch = null;
    this.adding.set(sketch, line);
    this.added = this.added.then(() => this.send(sketch));
    this.emit("sketch", "points");
  }

  private async send(sketch: Sketch): Promise<void> {
    try {
      if (!this.project.structures.has(sketch.structure)) sketch.structure = await this.addStructure();
      // Those placed a moment ago may not lie on the edge yet; those that do stay there.
      if (sketch.points.some((point) => point.kind === "wire")) sketch.adopt((await this.path(sketch, sketch.points)).control);
      const plane = { ...sketch.plane, mm_per_pixel: this.sketchScale };
      const { contour } = await this.services.call<{ contour: Contour }>("contour.add", { structure: sketch.structure, plane, control: sketch.points });
      this.adding.delete(sketch);
      if (!this.sketch) this.project.select({ contour: contour.id, point: null });
    } catch (error) {
      this.adding.delete(sketch);
      this.keep(sketch, error);
    }
    this.showWaiting();
    this.emit("sketch", "points");
  }

  /** Holds on to what the user has closed. A stroke that can never be a contour is only put aside. */
  private keep(sketch: Sketch, error: unknown): void {
    if (error instanceof ServerError && error.kind === "invalid_input" && sketch.isClosed && sketch.points.length === 1) {
      this.leftSketch = { sketch, by: "leaving" };
      return this.services.failed(error);
    }
    sketch.isUnsaved = true;
    this.waiting.unshift(sketch);
    this.forgetSaved();
    if (this.waiting.includes(sketch)) this.services.notSaved(error instanceof Error ? error.message : String(error));
  }

  private showWaiting(): void {
    if (!this.sketch && this.waiting.length > 0) this.take(this.waiting.shift()!);
  }

  private isSaved(sketch: Sketch): boolean {
    return [...this.project.contours.values()].some((contour) => sketch.became(contour));
  }

  /** The reply may be lost of a contour that was saved: then it must not be offered once more. */
  private forgetSaved(): void {
    const waiting = this.waiting.filter((sketch) => !this.isSaved(sketch));
    const isShownSaved = this.sketch?.isUnsaved === true && this.isSaved(this.sketch);
    if (!isShownSaved && waiting.length === this.waiting.length) return;
    this.waiting.splice(0, this.waiting.length, ...waiting);
    if (isShownSaved) this.clearSketch();
    this.showWaiting();
    this.emit("points");
    this.services.tell("The contour had been saved before the connection was lost.");
  }

  private async addStructure(): Promise<number> {
    const { structure } = await this.services.call<{ structure: { id: number } }>("structure.add");
    return structure.id;
  }

  // Editing

  private pressOnContour(screen: Screen, pointer: Point2, hit: ContourHit, modifiers: Modifiers): Gesture | null {
    if (modifiers.ctrl) {
      this.edit("contour.insert_point", { id: hit.contour, at: hit.at });
      this.project.select({ contour: hit.contour, point: null });
      return null;
    }
    this.project.select({ contour: hit.contour, point: hit.on === "point" ? hit.index : null });
    if (modifiers.shift) return this.moveGesture(screen, pointer, hit.contour);
    const mm_per_pixel = screen.mm_per_pixel;
    if (hit.on === "point")
      return this.draftGesture(pointer, (at) => ({
        name: "contour.move_point",
        args: { id: hit.contour, index: hit.index, to: toWorld(screen, at), mm_per_pixel },
      }));
    return this.draftGesture(pointer, (at) => ({
      name: "contour.pull",
      args: { id: hit.contour, from: hit.at, to: toWorld(screen, at) },
    }));
  }

  private moveGesture(screen: Screen, pointer: Point2, contour: number): Gesture {
    this.project.select({ contour, point: null });
    const start = toWorld(screen, pointer);
    return this.draftGesture(pointer, (at) => ({
      name: "contour.translate",
      args: { id: contour, by: sub(toWorld(screen, at), start) },
    }));
  }

  /** The surface follows the pointer by drafts; the release makes the edit. */
  private draftGesture(start: Point2, editAt: (pointer: Point2) => { name: string; args: Record<string, unknown> }): Gesture {
    let isDrag = false;
    return {
      move: (at) => {
        isDrag ||= gap(at, start) > 2;
        if (isDrag) this.drafts.send(editAt(at));
      },
      end: (at) => {
        this.drafts.drop();
        if (!isDrag) return;
        const { name, args } = editAt(at);
        this.edit(name, args);
      },
      cancel: () => this.dropDraft(),
    };
  }

  private async askDraft({ name, args }: { name: string; args: Record<string, unknown> }): Promise<void> {
    try {
      const { contour } = await this.services.call<{ contour: Contour }>(name, { ...args, draft: true });
      this.project.draft = contour;
    } catch (error) {
      this.services.failed(error);
    }
  }

  private dropDraft(): void {
    this.drafts.drop();
    void this.drafts.idle().then(() => {
      this.project.draft = null;
      this.services.call("draft.drop").catch(this.services.failed);
    });
  }

  private redrawGesture(screen: Screen, step_mm: number, pointer: Point2, hit: ContourHit | null): Gesture | null {
    const id = hit?.contour ?? this.project.selection?.contour;
    const contour = id === undefined ? undefined : this.project.contour(id);
    if (!contour || !inView(contour, screen, step_mm)) {
      this.services.tell("Begin on the line of the contour that you want to redraw.");
      return null;
    }
    this.project.select({ contour: contour.id, point: null });
    const hand: Vec3[] = [toWorld(screen, pointer)];
    return {
      move: (at) => {
        hand.push(toWorld(screen, at));
        this.handLine = hand;
        this.emit("sketch");
      },
      end: () => {
        this.handLine = [];
        this.emit("sketch");
        if (hand.length > 2) this.edit("contour.redraw", { id: contour.id, path: hand });
      },
      cancel: () => {
        this.handLine = [];
        this.emit("sketch");
      },
    };
  }

  edit(name: string, args: Record<string, unknown>): void {
    if (this.isAdding) return this.afterAdding(() => this.edit(name, args));
    this.leftSketch = null;
    this.emit("points");
    this.services.call(name, args).catch((error: unknown) => {
      this.project.refused();
      this.services.failed(error);
    });
  }

  /** The selected point, or else the selected contour. */
  deleteSelected(): void {
    const selection = this.project.selection;
    if (!selection) return;
    if (selection.point === null) return this.edit("contour.remove", { ids: [selection.contour] });
    this.edit("contour.delete_point", { id: selection.contour, index: selection.point });
    this.project.select({ contour: selection.contour, point: null });
  }

  /** Lays a copy of the selected contour `steps` slices further along its normal, and shows it. */
  async copySelected(view: ViewName, steps: number): Promise<void> {
    const contour = this.project.selectedContour;
    if (!contour) return this.services.tell("Select a contour first: click its line, or its row in the list.");
    try {
      const onward = Math.sign(dot(contour.plane.normal, this.navigation.direction(view))) || 1;
      const offset_mm = steps * onward * this.navigation.step(view);
      const copy = await this.services.call<{ contour: Contour }>("contour.copy", { id: contour.id, offset_mm });
      this.project.select({ contour: copy.contour.id, point: null });
      this.navigation.setCrosshair(sub(this.navigation.crosshair, scale(contour.plane.normal, heightOver(copy.contour.plane, this.navigation.crosshair))));
    } catch (error) {
      this.services.failed(error);
    }
  }

  // Crosshair and plane lines

  private pressOnLines(view: ViewName, screen: Screen, pointer: Point2): Gesture {
    const lines = this.lines(view, screen);
    const hit = hitPlaneLines(lines, toScreen(screen, this.navigation.crosshair), pointer);
    if (hit?.on === "turn") return this.turnGesture(view, hit.view, pointer);
    if (hit?.on === "move") return this.slideGesture(screen, hit.view, pointer);
    const go = (at: Point2) => this.navigation.setCrosshair(toWorld(screen, at));
    if (hit?.on !== "crosshair") this.project.select(null);
    go(pointer);
    return { move: go, end: () => undefined };
  }

  private turnGesture(view: ViewName, turned: ViewName, pointer: Point2): Gesture {
    const angleAt = (at: Point2): number => {
      const [x, y] = toScreen(this.services.screenOf(view)!, this.navigation.crosshair);
      return Math.atan2(at[1] - y, at[0] - x);
    };
    let last = angleAt(pointer);
    return {
      move: (at) => {
        const angle = angleAt(at);
        this.navigation.rotate(turned, view, angle - last);
        last = angle;
      },
      end: () => undefined,
    };
  }

  /** Moves the crosshair across the other plane's line, and not off the slice that is seen. */
  private slideGesture(screen: Screen, slid: ViewName, pointer: Point2): Gesture {
    const { normal } = this.navigation.cameras[slid].axes;
    const { u, v } = screen.axes;
    const across = add(scale(u, dot(normal, u)), scale(v, dot(normal, v)));
    let last = pointer;
    return {
      move: (at) => {
        const by = sub(toWorld(screen, at), toWorld(screen, last));
        last = at;
        this.navigation.setCrosshair(add(this.navigation.crosshair, scale(across, dot(by, normal) / dot(across, across))));
      },
      end: (at) => {
        if (gap(at, pointer) <= 2) this.navigation.setCrosshair(toWorld(screen, at)); // a click, not a drag
      },
    };
  }

}
