// SPDX-License-Identifier: Apache-2.0
import type { PixelPlane } from "../geometry/plane";
import type { Vec3 } from "../geometry/vec";
import type { Project } from "../model/project";
import { ServerError } from "../net/http";
import type { Contour, PathResult, SketchPoint } from "../net/protocol";
import type { EditorServices } from "./services";
import { Sketch, type SavedSketch } from "./sketch";

/** Where a sketch is drawn, and what was not taken comes back to. */
export interface Desk {
  readonly sketch: Sketch | null;
  changed(): void;
  clear(): void;
  /** Shows the sketch again, as it was. */
  take(sketch: Sketch): void;
  /** The same, and its tool. */
  resume(sketch: Sketch): void;
  putAside(sketch: Sketch): void;
  pixelPlane(sketch: Sketch): PixelPlane;
  path(sketch: Sketch, control: readonly SketchPoint[]): Promise<PathResult>;
}

/** Sketches that are finished (contours, open lines, redrawn pieces) until the server has them. What it does not take goes back to the drawing, one after the other. */
export class Outbox {
  private readonly sending = new Map<Sketch, Vec3[]>(); // with their lines
  private readonly waiting: Sketch[] = []; // not taken by the server, and not shown yet
  private sent: Promise<void> = Promise.resolve();

  constructor(
    private readonly drawing: Desk,
    private readonly project: Project,
    private readonly services: EditorServices,
  ) {
    project.on(["contours"], () => this.forgetSaved());
  }

  /** Whether something finished is not saved, and waits for the user to try again. */
  get hasUnsaved(): boolean {
    return this.drawing.sketch?.isUnsaved === true || this.waiting.length > 0;
  }

  get isSending(): boolean {
    return this.sending.size > 0;
  }

  /** Carries out what belongs behind the sketches that are on their way. */
  afterSending(act: () => void): void {
    if (this.isSending) void this.sent.then(act);
    else act();
  }

  /** The lines of sketches that the project does not have yet, for as long as that takes. */
  lines(): { sketch: Sketch; line: Vec3[] }[] {
    return [...this.sending, ...this.waiting.map((sketch): [Sketch, Vec3[]] => [sketch, sketch.finishedLine()])].map(([sketch, line]) => ({ sketch, line }));
  }

  /** What a next visit has to bring back beside the sketch. */
  saved(): SavedSketch[] {
    return [...this.sending.keys(), ...this.waiting].map((sketch) => ({ ...sketch.saved(), isUnsaved: true }));
  }

  /** Goes on where the last visit ended, but for what the project has got since it was told. */
  restore(sketch: SavedSketch | undefined, unsaved: SavedSketch[]): void {
    this.waiting.push(...unsaved.map((saved) => Sketch.from(saved)).filter((one) => !this.isSaved(one)));
    const current = sketch && Sketch.from(sketch);
    if (current && !this.isSaved(current)) this.drawing.resume(current);
    this.showNext();
    if (this.hasUnsaved)
      this.services.notSaved(this.drawing.sketch ?? this.waiting[0]!, "Before this page was opened the connection to kontur was lost, or it could not save.");
  }

  /** `line` is what is seen of the sketch meanwhile. */
  add(sketch: Sketch, line: Vec3[]): void {
    this.sending.set(sketch, line);
    this.sent = this.sent.then(() => this.send(sketch));
  }

  /** Gives the first of those that wait back to the drawing, if it has none. */
  showNext(): void {
    if (!this.drawing.sketch && this.waiting.length > 0) this.drawing.take(this.waiting.shift()!);
  }

  private async send(sketch: Sketch): Promise<void> {
    try {
      const contour = await (sketch.redraws === undefined ? this.addContour(sketch) : this.redraw(sketch, sketch.redraws));
      this.sending.delete(sketch);
      this.services.made(contour);
      if (!this.drawing.sketch) this.project.select({ contour: contour.id, point: null });
    } catch (error) {
      this.sending.delete(sketch);
      this.keep(sketch, error);
    }
    this.showNext();
    this.drawing.changed();
  }

  private async addContour(sketch: Sketch): Promise<Contour> {
    if (!this.project.structures.has(sketch.structure)) sketch.structure = await this.addStructure();
    // Those placed a moment ago may not lie on the edge yet; those that do stay there.
    if (sketch.points.some((point) => point.kind === "wire")) sketch.adopt((await this.drawing.path(sketch, sketch.points)).control);
    const { contour } = await this.services.call("contour.add", {
      structure: sketch.structure,
      plane: this.drawing.pixelPlane(sketch),
      control: sketch.points,
      ...(sketch.hole && { hole: true }),
      ...(sketch.isOpen && { closed: false }),
      ...(sketch.inside && { inside: sketch.inside }),
      ...(sketch.origin !== "drawn" && { origin: sketch.origin }),
      ...(typeof sketch.time === "number" && { time: sketch.time }),
    });
    return contour;
  }

  private async redraw(sketch: Sketch, id: number): Promise<Contour> {
    return (await this.services.call("contour.redraw", { id, path: sketch.line() })).contour;
  }

  private async addStructure(): Promise<number> {
    const { structure } = await this.services.call("structure.add", {});
    return structure.id;
  }

  /** Holds on to what the user has finished. A stroke that can never be a contour, or a piece of this one, is only put aside. */
  private keep(sketch: Sketch, error: unknown): void {
    if (error instanceof ServerError && error.kind === "invalid_input" && sketch.isOneStroke) {
      this.drawing.putAside(sketch);
      return this.services.failed(error);
    }
    sketch.isUnsaved = true;
    this.waiting.unshift(sketch);
    this.forgetSaved();
    if (this.waiting.includes(sketch)) this.services.notSaved(sketch, error instanceof Error ? error.message : String(error));
  }

  private isSaved(sketch: Sketch): boolean {
    return [...this.project.contours.values()].some((contour) => sketch.became(contour));
  }

  /** The reply may be lost of a sketch that was saved: then it must not be offered once more. */
  private forgetSaved(): void {
    const waiting = this.waiting.filter((sketch) => !this.isSaved(sketch));
    const shown = this.drawing.sketch;
    const isShownSaved = shown?.isUnsaved === true && this.isSaved(shown);
    if (!isShownSaved && waiting.length === this.waiting.length) return;
    this.waiting.splice(0, this.waiting.length, ...waiting);
    if (isShownSaved) this.drawing.clear();
    this.showNext();
    this.drawing.changed();
    this.services.tell("What you drew last had been saved before the connection was lost.");
  }
}
