// SPDX-License-Identifier: Apache-2.0
import type { BorderPair, Borders, Changed, Contour, Hand, History, Session, Structure, Surface, UseImage } from "../net/protocol";
import { Emitter } from "./emitter";

type Topic = "contours" | "structures" | "surfaces" | "stages" | "history" | "selection" | "draft" | "borders" | "image" | "refused";

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
    for (const structure of session.structures) this.structures.set(structure.id, structure);
    for (const contour of session.contours) this.contours.set(contour.id, contour);
    for (const surface of session.surfaces) this.surfaces.set(surface.structure, surface);
    this.history = session.history;
    this.borders = session.borders;
    this.borderPairs = session.border_pairs;
    this.useImage = session.use_image;
    this.draftContour = null;
    this.keepReferencesValid();
    this.emit("contours", "structures", "surfaces", "history", "selection", "draft", "borders", "image");
  }

  setBorderPairs(pairs: BorderPair[]): void {
    this.borderPairs = pairs;
    this.emit("borders");
  }

  apply({ structures, contours, history, borders, use_image }: Changed): void {
    for (const structure of structures?.set ?? []) this.setStructure(structure);
    for (const id of structures?.removed ?? []) {
      this.structures.delete(id);
      this.surfaces.delete(id);
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
    this.draftContour = null;
    this.keepReferencesValid();
    this.emit("contours", "structures", "surfaces", "history", "selection", "draft", "borders", "image");
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

  shownContours(): Contour[] {
    return [...this.contours.keys()].map((id) => this.contour(id)!).filter((contour) => this.isShown(contour));
  }

  contoursOf(structure: number): Contour[] {
    return [...this.contours.values()].filter((contour) => contour.structure === structure);
  }

  /** Whether there is anything of it: contours, or a mask. */
  hasContent({ id, mask }: Structure): boolean {
    return mask !== undefined || this.contoursOf(id).length > 0;
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
