// SPDX-License-Identifier: Apache-2.0
import type { PixelPlane } from "../geometry/plane";
import { gap, narrowWidth, planeOf, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";
import { Emitter } from "../model/emitter";
import type { Project } from "../model/project";
import { Latest } from "../net/latest";
import type { Contour, PathResult, SketchPoint, StretchKind } from "../net/protocol";
import { CLICK_PIXELS, type Gesture } from "./gesture";
import { Outbox, type Desk } from "./outbox";
import { withoutOvershoot } from "./overshoot";
import type { EditorServices } from "./services";
import { isHidden } from "./sight";
import { Sketch } from "./sketch";

const CLOSE_PIXELS = 11;
const SAME_PIXELS = 3; // of two clicks on one point
const HAND_STEP_PIXELS = 1.5;
const LEAST_WIDTH_PIXELS = 5; // of a contour drawn in one go: what is narrower is a slip of the hand

/** The contour that is being drawn, or a piece of one that is not saved: its points and lines, its own undo and redo, and its closing. */
export class Drawing extends Emitter<"sketch" | "points" | "resumed"> implements Desk {
  sketch: Sketch | null = null;
  /** The sketch's line as the server made it, and the line on to the pointer. */
  placedLine: Vec3[] = [];
  rubberLine: Vec3[] = [];
  /** Drawn by hand at this moment, or about to replace a stretch. */
  handLine: Vec3[] = [];
  /** Those of its points that a hand has moved, where these are not all. */
  movedPoints: readonly Vec3[] | null = null;
  pointerCloses = false;
  /** What Enter, a double click and a stroke by hand finish stays open, but for lines that come back to where they began. */
  endsOpen = false;
  readonly outbox: Outbox;
  /** The sketch that was left last, and by what: undo or redo brings it back, until something else is done. */
  private leftSketch: { sketch: Sketch; by: "leaving" | "undo" } | null = null;

  private readonly placed = new Latest<Sketch>((sketch) => this.askPlaced(sketch));
  private readonly rubber = new Latest<{ sketch: Sketch; pointer: Vec3; mm: number }>((request) => this.askRubber(request));
  private image = 0; // whose edges wires follow
  private mm_per_pixel = 1; // of the view in which the pointer was last

  constructor(
    private readonly project: Project,
    private readonly services: EditorServices,
  ) {
    super();
    this.outbox = new Outbox(this, project, services);
  }

  /** Wires follow this image from now on: what is placed of them stays. */
  setImage(image: number): void {
    this.image = image;
    this.sketch?.setImage(image);
  }

  changed(): void {
    this.emit("sketch", "points");
  }

  // Pointer

  /** `kind` is that of a line from a point that is clicked. */
  press(screen: Screen, step_mm: number, pointer: Point2, kind: StretchKind): Gesture | null {
    if (this.holdsUnsaved() || this.isOutOfSight()) return null;
    if (this.sketch && !this.sketch.liesIn(planeOf(screen), step_mm / 2)) {
      this.services.tell("The contour you began lies in another plane. Enter closes it, Esc leaves it.");
      return null;
    }
    const hand: Vec3[] = [toWorld(screen, pointer)];
    let last = pointer;
    let isDrag = false;
    return {
      isStroke: true,
      move: (at) => {
        isDrag ||= gap(at, pointer) > CLICK_PIXELS;
        if (gap(at, last) < HAND_STEP_PIXELS) return;
        last = at;
        hand.push(toWorld(screen, at));
        if (!isDrag) return;
        this.rubberLine = [];
        this.pointerCloses = this.isNearStart(screen, at);
        this.showHand(hand);
      },
      end: (at) => {
        this.handLine = [];
        this.mm_per_pixel = screen.mm_per_pixel;
        if (isDrag) this.endHand(screen, at, hand, kind);
        else this.click(screen, at, kind);
      },
      cancel: () => this.showHand([]),
    };
  }

  private isOutOfSight(): boolean {
    return isHidden(this.sketch?.structure ?? this.project.activeStructure?.id, this.project, this.services);
  }

  /** What is finished has to be saved or given up before the next is begun; says so. */
  holdsUnsaved(): boolean {
    if (!this.sketch?.isFinished) return false;
    this.services.tell(`${this.sketch.title} is not saved. Enter tries again, Esc gives it up.`);
    return true;
  }

  showHand(line: Vec3[], moved: readonly Vec3[] | null = null): void {
    this.handLine = line;
    this.movedPoints = moved;
    this.emit("sketch");
  }

  /** The line from the last point to the pointer. */
  stretchRubber(screen: Screen, step_mm: number, pointer: Point2): void {
    if (this.sketch?.last && !this.sketch.isFinished && this.sketch.liesIn(planeOf(screen), step_mm / 2)) {
      this.pointerCloses = this.isNearStart(screen, pointer) && this.sketch.canClose;
      const target = this.pointerCloses ? this.sketch.first! : toWorld(screen, pointer);
      this.rubber.send({ sketch: this.sketch, pointer: target, mm: screen.mm_per_pixel });
    }
    this.emit("sketch");
  }

  dropRubber(): void {
    this.rubber.drop();
    this.rubberLine = [];
    this.emit("sketch");
  }

  private endHand(screen: Screen, at: Point2, hand: Vec3[], kind: StretchKind): void {
    const closes = this.isNearStart(screen, at);
    if (!this.sketch && (kind === "line" || comesAround(screen, hand))) return this.endStroke(screen, hand);
    const sketch = this.begun(screen, kind);
    sketch.drawFree(hand);
    if (closes && sketch.canClose) {
      sketch.points.pop(); // the stretch ends at the first point instead
      return this.close();
    }
    this.pointsChanged();
  }

  /** All of it was drawn in one go. */
  private endStroke(screen: Screen, hand: readonly Vec3[]): void {
    const active = this.project.activeStructure;
    const structure = active?.id ?? 0;
    // A stroke across the outline of a mask replaces a piece of it.
    if ((this.endsOpen || active?.mask) && !comesAround(screen, hand)) return this.send(Sketch.openFree(planeOf(screen), structure, hand));
    const drawn = Sketch.closedFree(planeOf(screen), structure, withoutOvershoot(screen, hand));
    return this.isSlip(screen, hand) ? this.dropSlip(drawn) : this.send(drawn);
  }

  private isSlip(screen: Screen, hand: readonly Vec3[]): boolean {
    return narrowWidth(hand.map((p) => toScreen(screen, p))) < LEAST_WIDTH_PIXELS;
  }

  private dropSlip(drawn: Sketch): void {
    this.putAside(drawn);
    this.changed();
    const text = `That stroke is less than ${LEAST_WIDTH_PIXELS} pixels wide, so it was not taken for a contour. Zoom in (Ctrl + wheel) to draw small things.`;
    this.services.tell(text, { label: "Take it all the same", act: () => this.send(drawn) });
  }

  private click(screen: Screen, at: Point2, kind: StretchKind): void {
    const sketch = this.begun(screen, kind);
    const onLast = sketch.last && gap(toScreen(screen, sketch.last.at), at) < SAME_PIXELS * (screen.reach ?? 1);
    if (this.isNearStart(screen, at) && sketch.canClose) return this.close();
    if (onLast) return sketch.canClose || (this.endsOpen && sketch.canEnd) ? this.finish() : undefined;
    sketch.place(toWorld(screen, at));
    this.pointsChanged();
  }

  private begun(screen: Screen, kind: StretchKind): Sketch {
    const structure = this.project.activeStructure?.id ?? 0;
    this.sketch ??= new Sketch(planeOf(screen), structure, kind);
    if (this.sketch.time === undefined) this.sketch.time = this.project.timeOfNew;
    this.sketch.setImage(this.image);
    this.leftSketch = null;
    this.project.select(null);
    return this.sketch;
  }

  private isNearStart(screen: Screen, at: Point2): boolean {
    const first = this.sketch?.first;
    return first !== undefined && this.sketch!.points.length > 1 && gap(toScreen(screen, first), at) < CLOSE_PIXELS * (screen.reach ?? 1);
  }

  // Lines, which the server makes

  pixelPlane(sketch: Sketch): PixelPlane {
    return { ...sketch.plane, mm_per_pixel: this.mm_per_pixel };
  }

  path(sketch: Sketch, control: readonly SketchPoint[], closed = false): Promise<PathResult> {
    return this.services.call("path", { plane: this.pixelPlane(sketch), control, closed, ...(typeof sketch.time === "number" && { time: sketch.time }) });
  }

  private pointsChanged(): void {
    this.rubberLine = [];
    if (this.sketch) this.placed.send(this.sketch);
    this.changed();
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
    this.mm_per_pixel = mm;
    const count = sketch.points.length;
    const result = await this.path(sketch, sketch.rubberBand(pointer));
    if (this.sketch !== sketch || sketch.points.length !== count) return;
    this.rubberLine = result.points.slice(result.control.at(-2)?.index ?? 0);
    this.emit("sketch");
  }

  // Beginning and end

  /** Redraws a piece of a contour by this stroke. */
  redraw(contour: Contour, stroke: readonly Vec3[]): void {
    this.send(Sketch.redrawing(contour, stroke));
  }

  setEndsOpen(endsOpen: boolean): void {
    this.endsOpen = endsOpen;
    this.changed();
  }

  /** Makes what is drawn a contour or an open line, as the user wants it now or has ended it before. */
  finish(): void {
    const sketch = this.sketch;
    if (sketch && (sketch.isOpen || (this.endsOpen && !sketch.isClosed && !sketch.isUnsaved))) this.endOpen();
    else this.close();
  }

  /** Makes an open line of the sketch. */
  endOpen(): void {
    const sketch = this.sketch;
    if (!sketch || (!sketch.isOpen && this.holdsUnsaved())) return;
    if (!sketch.canEnd) return this.services.tell("An open line needs at least two points.");
    if (this.isOutOfSight()) return;
    const line = this.placedLine.length < 2 ? sketch.line() : this.placedLine;
    sketch.isOpen = true;
    this.clear();
    this.send(sketch, line);
  }

  /** Makes a contour of the sketch, or tries again to redraw the piece. */
  close(): void {
    const sketch = this.sketch;
    if (!sketch) return;
    if (!sketch.canClose) return this.services.tell("A contour needs at least three points.");
    if (this.isOutOfSight()) return;
    sketch.isOpen = false;
    const line = sketch.isClosed || this.placedLine.length < 2 ? sketch.finishedLine() : [...this.placedLine, sketch.first!];
    this.clear();
    this.send(sketch, line);
  }

  /** Gives what is finished to the server; it is seen as `line` meanwhile. */
  send(sketch: Sketch, line = sketch.finishedLine()): void {
    this.leftSketch = null;
    if (sketch.time === undefined) sketch.time = this.project.timeOfNew;
    this.outbox.add(sketch, line);
    this.changed();
  }

  /** Puts the sketch aside, from where undo brings it back. */
  leave(): void {
    if (this.sketch) this.putAside(this.sketch);
    this.clear();
    this.outbox.showNext();
  }

  putAside(sketch: Sketch): void {
    this.leftSketch = { sketch, by: "leaving" };
  }

  /** Something else was done: what was left does not come back. */
  forgetLeft(): void {
    this.leftSketch = null;
    this.emit("points");
  }

  clear(): void {
    this.sketch = null;
    this.placedLine = [];
    this.rubberLine = [];
    this.handLine = [];
    this.pointerCloses = false;
    this.placed.drop();
    this.rubber.drop();
    this.changed();
  }

  /** Goes on with a sketch from before, and with its tool. */
  resume(sketch: Sketch): void {
    this.leftSketch = null;
    this.take(sketch);
    this.emit("resumed");
  }

  take(sketch: Sketch): void {
    this.sketch = sketch;
    this.placedLine = sketch.line();
    this.project.select(null);
    this.pointsChanged();
  }

  // Undo and redo

  /** What undo and redo do to the sketch, or to the one that was left last; null: they are the project's. */
  get undoLabel(): string | null {
    if (this.sketch) return this.sketch.lastStep;
    if (this.leftSketch?.by !== "leaving") return null;
    return this.leftSketch.sketch.redraws === undefined ? "Leave the contour" : "Leave the piece";
  }

  get redoLabel(): string | null {
    if (this.sketch) return this.sketch.canRestore ? this.sketch.lastStep : null;
    return this.leftSketch?.by === "undo" ? this.leftSketch.sketch.lastStep : null;
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
    if (this.sketch) this.pointsChanged();
    else this.resume(sketch);
    return true;
  }

  removeLastPoint(): void {
    const sketch = this.sketch;
    if (!sketch) return;
    sketch.removeLast();
    if (!sketch.isEmpty) return this.pointsChanged();
    this.clear();
    this.leftSketch = { sketch, by: "undo" };
    this.emit("points");
    this.outbox.showNext();
  }
}

/** Whether a stroke ends where it began: then it is a whole contour, whatever the line between clicks would do. */
function comesAround(screen: Screen, hand: readonly Vec3[]): boolean {
  const line = hand.map((p) => toScreen(screen, p));
  return gap(line[0]!, line.at(-1)!) < CLOSE_PIXELS * (screen.reach ?? 1) && narrowWidth(line) >= 2 * CLOSE_PIXELS * (screen.reach ?? 1);
}
