// SPDX-License-Identifier: Apache-2.0
import { coincide, projected, type Plane } from "../geometry/plane";
import { sub, length, type Vec3 } from "../geometry/vec";
import type { Contour, ControlPoint, Hand, Origin, SketchPoint, StretchKind } from "../net/protocol";

/** A sketch as it is kept with the project until the next visit. */
export interface SavedSketch {
  plane: Plane;
  structure: number;
  kind: StretchKind;
  points: SketchPoint[];
  isUnsaved?: boolean;
  redraws?: number;
  hole?: boolean;
  isOpen?: boolean;
  inside?: Hand;
  origin?: Origin;
  time?: number;
}

const SAVED_DIGITS = 9;
const SAME_PLACE_MM = 1e-5; // what is saved is rounded

const rounded = (p: Vec3): Vec3 => p.map((value) => Number(value.toPrecision(SAVED_DIGITS))) as unknown as Vec3;
const isSamePlace = (p: Vec3, q: Vec3): boolean => length(sub(p, q)) < SAME_PLACE_MM;

/**
 * A contour while it is drawn: control points, each with how the line from it goes on. Or a stroke that replaces a piece of
 * the contour `redraws`: one point, from which the hand went on to the stroke's other end.
 */
export class Sketch {
  points: SketchPoint[] = [];
  /** Finished by the user, but not taken by the server. */
  isUnsaved = false;
  /** Its inside does not belong to the structure. */
  hole = false;
  /** The user has ended it as an open line. */
  isOpen = false;
  /** Of an open line, where the structure lies; undefined: that is found out. */
  inside: Hand | undefined;
  origin: Origin = "drawn";
  /** Of the image's volumes the one that it is drawn in; null: the one that was opened; undefined: that is not said yet. */
  time: number | null | undefined;
  private image = 0; // whose edges wires follow from the last point on
  private undone: SketchPoint[][] = []; // what the points were before each removal, the latest last

  constructor(
    readonly plane: Plane,
    public structure: number,
    public kind: StretchKind,
    readonly redraws?: number,
  ) {}

  /** What a user knows it by. */
  get title(): string {
    if (this.redraws !== undefined) return "The piece that you redrew";
    return this.isOpen ? "The open line that you drew" : "The contour that you closed";
  }

  /** What removing the last point takes back. */
  get lastStep(): string {
    return this.redraws === undefined ? "Place a point" : "Redraw a part";
  }

  get isEmpty(): boolean {
    return this.points.length === 0;
  }

  /** Whether the hand has drawn the line back to the first point, or all of the stroke that redraws a piece. */
  get isClosed(): boolean {
    return this.last?.path !== undefined;
  }

  /** Whether the user has finished all of it, so that it takes no more points. */
  get isFinished(): boolean {
    return this.isClosed || (this.isOpen && this.isUnsaved);
  }

  /** Drawn by the hand in one go. */
  get isOneStroke(): boolean {
    return this.isClosed ? this.points.length === 1 : this.isOpen && this.points.length === 2 && this.points[0]!.path !== undefined;
  }

  /** An open line needs two points. */
  get canEnd(): boolean {
    return this.points.length >= 2;
  }

  /** A closed line needs three points, or one stretch drawn by hand. */
  get canClose(): boolean {
    return this.isClosed || this.points.length >= 3 || this.points.some((point) => (point.path?.length ?? 0) >= 8);
  }

  get first(): Vec3 | undefined {
    return this.points[0]?.at;
  }

  get last(): SketchPoint | undefined {
    return this.points.at(-1);
  }

  liesIn(plane: Plane, tolerance_mm: number): boolean {
    return coincide(this.plane, plane, tolerance_mm);
  }

  /** The kind of the stretch from the last point on, and of those after it. */
  setKind(kind: StretchKind): void {
    this.kind = kind;
    if (this.last && !this.last.path) this.last.kind = kind;
  }

  /** The image whose edges a wire from the last point on follows. */
  setImage(image: number): void {
    this.image = image;
    const { last } = this;
    if (!last || last.path) return;
    delete last.image;
    Object.assign(last, this.point(last.at, last.kind));
  }

  private point(at: Vec3, kind: StretchKind): SketchPoint {
    return { at, kind, ...(this.image > 0 && { image: this.image }) };
  }

  place(at: Vec3): void {
    this.undone = [];
    this.points.push(this.point(at, this.kind));
  }

  /** A stretch drawn by hand: from the last point, or where the hand began, to where it ended. */
  drawFree(path: readonly Vec3[]): void {
    const start = path[0];
    const end = path.at(-1);
    if (!start || !end || path.length < 2) return;
    if (this.isEmpty) this.place(start);
    const from = this.last!;
    from.kind = "free";
    from.path = path.slice(1, -1);
    this.place(end);
  }

  /** A hand-drawn contour as a whole: one stretch from its first point around to it. */
  static closedFree(plane: Plane, structure: number, path: readonly Vec3[], { hole = false, origin = "drawn" as Origin } = {}): Sketch {
    const sketch = new Sketch(plane, structure, "free");
    sketch.hole = hole;
    sketch.origin = origin;
    sketch.points = [{ at: path[0]!, kind: "free", path: path.slice(1) }];
    return sketch;
  }

  /** A hand-drawn open line as a whole, from end to end. */
  static openFree(
    plane: Plane,
    structure: number,
    path: readonly Vec3[],
    { inside, origin = "drawn" }: { inside?: Hand | undefined; origin?: Origin } = {},
  ): Sketch {
    const sketch = new Sketch(plane, structure, "free");
    sketch.drawFree(path);
    sketch.isOpen = true;
    sketch.inside = inside;
    sketch.origin = origin;
    return sketch;
  }

  /** The stroke by which the hand redrew a piece of this contour. */
  static redrawing({ id, plane, structure }: Contour, path: readonly Vec3[]): Sketch {
    const sketch = new Sketch(plane, structure, "free", id);
    const [at, ...rest] = path.map((p) => projected(plane, p)); // as the server will: the view may lie half a slice beside it
    sketch.points = [{ at: at!, kind: "free", path: rest }];
    return sketch;
  }

  get canRestore(): boolean {
    return this.undone.length > 0;
  }

  /** Takes the latest removal back. */
  restoreLast(): void {
    this.points = this.undone.pop() ?? this.points;
  }

  removeLast(): void {
    this.undone.push(this.points.map((point) => ({ ...point })));
    this.isOpen = false;
    if (!this.isClosed || this.redraws !== undefined) this.points.pop();
    const last = this.last;
    if (!last) return;
    delete last.path;
    last.kind = this.kind;
  }

  saved(): SavedSketch {
    const { plane, structure, kind, isUnsaved, redraws, hole, isOpen, inside, origin, time } = this;
    const points = this.points.map((point) => ({ ...point, at: rounded(point.at), ...(point.path && { path: point.path.map(rounded) }) }));
    return {
      plane,
      structure,
      kind,
      points,
      ...(isUnsaved && { isUnsaved }),
      ...(redraws !== undefined && { redraws }),
      ...(hole && { hole }),
      ...(isOpen && { isOpen }),
      ...(inside && { inside }),
      ...(origin !== "drawn" && { origin }),
      ...(typeof time === "number" && { time }),
    };
  }

  static from({
    plane,
    structure,
    kind,
    points,
    isUnsaved = false,
    redraws,
    hole = false,
    isOpen = false,
    inside,
    origin = "drawn",
    time,
  }: SavedSketch): Sketch {
    const sketch = new Sketch(plane, structure, kind, redraws);
    sketch.points = points;
    sketch.isUnsaved = isUnsaved;
    sketch.hole = hole;
    sketch.isOpen = isOpen;
    sketch.inside = inside;
    sketch.origin = origin;
    sketch.time = time ?? null;
    return sketch;
  }

  /** The line as far as it is known without the server: straight where splines and wires would run. */
  line(): Vec3[] {
    const line = this.points.flatMap(({ at, path = [] }) => [at, ...path]);
    return this.isClosed && this.redraws === undefined ? [...line, this.first!] : line;
  }

  /** The whole line of what the user has finished. */
  finishedLine(): Vec3[] {
    return this.isClosed || this.isOpen || this.isEmpty ? this.line() : [...this.line(), this.first!];
  }

  /** Whether the server made this contour of the sketch: the same control points, and between them points of the same hand. */
  became(contour: Contour): boolean {
    if (this.redraws !== undefined) return this.isPieceOf(contour);
    const { control, points, closed } = contour;
    if (closed === this.isOpen || control.length !== this.points.length) return false;
    return this.points.every(({ at, kind, path }, i) => {
      const { at: place, kind: kindThere, index } = control[i]!;
      if (kind !== kindThere || !isSamePlace(at, place)) return false;
      return !path || points.slice(index + 1, control[i + 1]?.index).every((p) => path.some((q) => isSamePlace(p, q)));
    });
  }

  /** Whether one of the contour's stretches is this stroke, of which the server keeps the ends and some points between them. */
  private isPieceOf({ id, control, points, closed }: Contour): boolean {
    if (id !== this.redraws) return false;
    const stroke = this.line();
    const isIn = (line: readonly Vec3[], p: Vec3) => line.some((q) => isSamePlace(p, q));
    return control.some(({ index }, i) => {
      const end = control[i + 1]?.index ?? points.length;
      if (!closed && i === control.length - 1) return false; // nothing leads on from there
      const stretch = [...points.slice(index, end), points[end % points.length]!];
      return isIn(stretch, stroke[0]!) && isIn(stretch, stroke.at(-1)!) && stretch.slice(1, -1).every((p) => isIn(stroke, p));
    });
  }

  /** Takes over where the server has moved points to the edge. */
  adopt(control: readonly ControlPoint[]): void {
    if (control.length !== this.points.length) return;
    control.forEach((point, i) => void (this.points[i]!.at = point.at));
  }

  /** What to ask the path for between the last point and the pointer: a spline bends with its neighbours. */
  rubberBand(pointer: Vec3): SketchPoint[] {
    const count = this.last?.kind === "spline" ? 3 : 1;
    return [...this.points.slice(-count), this.point(pointer, this.last?.kind ?? this.kind)];
  }
}
