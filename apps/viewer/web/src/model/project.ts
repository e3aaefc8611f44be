// SPDX-License-Identifier: Apache-2.0
import type { BorderPair, Borders, Changed, Contour, CycleFrames, Hand, History, Motion, Session, Structure, Surface, UseImage } from "../net/protocol";
import { Emitter } from "./emitter";

type Topic = "contours" | "structures" | "surfaces" | "stages" | "history" | "selection" | "draft" | "borders" | "image" | "refused" | "time" | "motions";

/** Something of one of the image's volumes in time; without a time of the one that was opened. */
export interface InTime {
  readonly time?: number | null | undefined;
}

export interface Selection {
  contour: number;
  /** Index of a control point. */
  point: number | null;
}

/** What the server holds, as its events told it, and what the user has selected in it. */
export class Project extends Emitter<Topic> {
  readonly structures = new Map<number, Structure>();
  readonly contours = new Map<number, Contour>();
  readonly surfaces = new Map<number, Surface>();
  /** Of structures that were drawn at several times of the image. */
  readonly motions = new Map<number, Motion>();
  cycleFrames: CycleFrames = null;
  private seenTime = 0;
  private ownTime = 0;
  history: History = { undo: null, redo: null };
  borders: Borders = { shared: false, rules: [] };
  /** Of structures that touch. */
  borderPairs: BorderPair[] = [];
  useImage: UseImage = null;
  selection: Selection | null = null;
  /** Contours that are deleted, moved or hidden together; the selected one is among them. */
  readonly marked = new Set<number>();
  private draftContour: Contour | null = null;
  private carried: readonly Contour[] = [];
  private active = 0;

  start(session: Session): void {
    this.structures.clear();
    this.contours.clear();
    this.surfaces.clear();
    this.motions.clear();
    for (const motion of session.motions) this.motions.set(motion.structure, motion);
    this.cycleFrames = session.cycle_frames;
    for (const structure of session.structures) this.structures.set(structure.id, structure);
    for (const contour of session.contours) this.contours.set(contour.id, contour);
    for (const surface of session.surfaces) this.surfaces.set(surface.structure, surface);
    this.history = session.history;
    this.borders = session.borders;
    this.borderPairs = session.border_pairs;
    this.useImage = session.use_image;
    this.draftContour = null;
    this.keepReferencesValid();
    this.emit("contours", "structures", "surfaces", "history", "selection", "draft", "borders", "image", "motions");
  }

  setBorderPairs(pairs: BorderPair[]): void {
    this.borderPairs = pairs;
    this.emit("borders");
  }

  apply({ structures, contours, history, borders, use_image, cycle_frames }: Changed): void {
    for (const structure of structures?.set ?? []) this.setStructure(structure);
    for (const id of structures?.removed ?? []) {
      this.structures.delete(id);
      this.surfaces.delete(id);
      this.motions.delete(id);
    }
    for (const contour of contours?.set ?? []) {
      const goesOver = this.contours.has(contour.id) && this.contours.get(contour.id)!.structure !== contour.structure;
      if (goesOver && contour.id === this.selection?.contour) this.active = contour.structure;
      this.contours.set(contour.id, contour);
    }
    for (const id of contours?.removed ?? []) this.contours.delete(id);
    this.history = history;
    this.borders = borders ?? this.borders;
    this.useImage = use_image ?? this.useImage;
    if (cycle_frames !== undefined) this.cycleFrames = cycle_frames;
    this.draftContour = null;
    this.keepReferencesValid();
    this.emit("contours", "structures", "surfaces", "history", "selection", "draft", "borders", "image", "motions");
  }

  /** In the order of their making, whatever was deleted and taken back. */
  private setStructure(structure: Structure): void {
    const isKnown = this.structures.has(structure.id);
    this.structures.set(structure.id, structure);
    if (isKnown) return;
    const later = [...this.structures.values()].filter(({ id }) => id > structure.id);
    for (const one of later) {
      this.structures.delete(one.id);
      this.structures.set(one.id, one);
    }
  }

  setSurface(surface: Surface): void {
    if (!this.structures.has(surface.structure)) return;
    const before = this.surfaces.get(surface.structure);
    // While the hand moves only previews come; the figures of the last finished surface stay until there are new ones.
    const keepsFigures = surface.stage === "preview" || surface.stage === "outdated";
    this.surfaces.set(surface.structure, keepsFigures ? { ...before, ...surface } : surface);
    this.emit(surface.revision === before?.revision ? "stages" : "surfaces");
  }

  setMotion(motion: Motion): void {
    if (!this.structures.has(motion.structure)) return;
    const before = this.motions.get(motion.structure);
    if (motion.revisions.length === 0) this.motions.delete(motion.structure);
    else this.motions.set(motion.structure, motion);
    const isSeenAnew = before?.revisions[this.seenTime] !== motion.revisions[this.seenTime];
    this.emit("motions", ...(isSeenAnew ? (["surfaces"] as const) : []));
  }

  /** Which of the image's volumes in time is seen, and which one was opened. */
  setTime(time: number, ownTime: number): void {
    if (time === this.seenTime && ownTime === this.ownTime) return;
    [this.seenTime, this.ownTime] = [time, ownTime];
    this.emit("time");
  }

  get time(): number {
    return this.seenTime;
  }

  /** As calls have it: what is made now is made for the time that is seen; null for the one that was opened. */
  get timeOfNew(): number | null {
    return this.seenTime === this.ownTime ? null : this.seenTime;
  }

  timeOf({ time }: InTime): number {
    return time ?? this.ownTime;
  }

  /** Whether it is of the time that is seen. */
  isOfTime(contour: InTime): boolean {
    return this.timeOf(contour) === this.seenTime;
  }

  /** Of the surface that is seen of a structure at a time. */
  revisionAt(structure: number, time = this.seenTime): number {
    const surface = this.surfaces.get(structure);
    const made = this.motions.get(structure)?.revisions[time] ?? 0;
    const own = surface?.revision ?? 0;
    return made === 0 || (surface?.time === time && own > made) ? own : made;
  }

  /** The surface with its figures, those of the time that is seen where the structure moves. */
  seenSurface(structure: number): Surface | undefined {
    const surface = this.surfaces.get(structure);
    const motion = this.motions.get(structure);
    if (!surface || (!motion && surface.time === undefined)) return surface;
    const { conflicts, faults, residual, edges_beside, volume_ml, ...rest } = surface;
    const isSeen = surface.time === this.seenTime;
    const volume = motion?.curve?.volumes_ml[this.seenTime] ?? (isSeen ? volume_ml : undefined);
    return {
      ...rest,
      ...(isSeen && conflicts && { conflicts }),
      ...(isSeen && faults && { faults }),
      ...(isSeen && residual && { residual }),
      ...(volume !== undefined && { volume_ml: volume }),
      warnings: [...(isSeen ? (surface.warnings ?? []) : []), ...(motion?.warnings ?? [])],
    };
  }

  seenSurfaces(): Surface[] {
    return [...this.surfaces.keys()].map((structure) => this.seenSurface(structure)!);
  }

  /** The contour as the pointer holds it just now, instead of the stored one. */
  get draft(): Contour | null {
    return this.draftContour;
  }

  set draft(contour: Contour | null) {
    this.setDraft(contour);
  }

  /** With neighbours' contours that go with it. */
  setDraft(contour: Contour | null, carried: readonly Contour[] = []): void {
    this.draftContour = contour;
    this.carried = carried;
    this.emit("draft");
  }

  /** An edit was not carried out: what shows it already has to show again what is. */
  refused(): void {
    this.draftContour = null;
    this.emit("draft", "refused");
  }

  contour(id: number): Contour | undefined {
    if (this.draftContour?.id === id) return this.draftContour;
    return (this.draftContour && this.carried.find((contour) => contour.id === id)) ?? this.contours.get(id);
  }

  /** On which hand of an open line the structure lies, as it is told or was found; undefined before that. */
  sideOf({ id, structure, inside }: Contour): Hand | undefined {
    return inside ?? this.surfaces.get(structure)?.sides?.find(({ contour }) => contour === id)?.inside;
  }

  isShown(contour: Contour): boolean {
    return contour.visible && (this.structures.get(contour.structure)?.visible ?? false);
  }

  /** Those of the time that is seen. */
  shownContours(): Contour[] {
    return this.allShown().filter((contour) => this.isOfTime(contour));
  }

  /** Those of other times, which are seen faintly and are not edited. */
  faintContours(): Contour[] {
    return this.allShown().filter((contour) => !this.isOfTime(contour));
  }

  private allShown(): Contour[] {
    return [...this.contours.keys()].map((id) => this.contour(id)!).filter((contour) => this.isShown(contour));
  }

  contoursOf(structure: number): Contour[] {
    return [...this.contours.values()].filter((contour) => contour.structure === structure);
  }

  /** Whether there is anything of it: contours, a mask, or a rule. */
  hasContent({ id, mask, rule }: Structure): boolean {
    return mask !== undefined || rule !== undefined || this.contoursOf(id).length > 0;
  }

  /** The structure that new contours belong to; undefined when there is none. */
  get activeStructure(): Structure | undefined {
    return this.structures.get(this.active) ?? this.structures.values().next().value;
  }

  activate(structure: number): void {
    this.active = structure;
    this.emit("structures");
  }

  select(selection: Selection | null): void {
    const isMarkedAlone = this.marked.size <= (selection ? 1 : 0);
    const same = isMarkedAlone && selection?.contour === this.selection?.contour && selection?.point === this.selection?.point;
    if (same) return;
    this.selection = selection;
    this.marked.clear();
    if (selection) this.marked.add(selection.contour);
    const structure = selection && this.contours.get(selection.contour)?.structure;
    if (structure) this.active = structure;
    this.emit("selection", "structures");
  }

  /** Adds the contour to those that are marked, or takes it away. */
  toggleMark(contour: number): void {
    if (!this.marked.delete(contour)) this.marked.add(contour);
    this.selectAmongMarked(contour);
  }

  /** These alone are marked; the last one is selected. */
  mark(contours: readonly number[]): void {
    this.marked.clear();
    for (const contour of contours) this.marked.add(contour);
    this.selectAmongMarked(contours.at(-1) ?? 0);
  }

  private selectAmongMarked(preferred: number): void {
    const contour = this.marked.has(preferred) ? preferred : [...this.marked].at(-1);
    this.selection = contour === undefined ? null : { contour, point: null };
    const structure = contour !== undefined && this.contours.get(contour)?.structure;
    if (structure) this.active = structure;
    this.emit("selection", "structures");
  }

  get selectedContour(): Contour | undefined {
    return this.selection ? this.contour(this.selection.contour) : undefined;
  }

  private keepReferencesValid(): void {
    for (const id of [...this.marked]) if (!this.contours.has(id)) this.marked.delete(id);
    const contour = this.selection && this.contours.get(this.selection.contour);
    if (!contour) {
      const other = [...this.marked].at(-1);
      this.selection = other === undefined ? null : { contour: other, point: null };
    } else if (this.selection?.point != null && this.selection.point >= contour.control.length) this.selection = { contour: contour.id, point: null };
  }
}
