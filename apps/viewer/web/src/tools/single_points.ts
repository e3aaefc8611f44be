// SPDX-License-Identifier: Apache-2.0
import { depthBelow, gap, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import { isInside } from "../geometry/loop";
import { distance, type Vec3 } from "../geometry/vec";
import { Emitter } from "../model/emitter";
import type { Project } from "../model/project";
import type { PointKind, Structure } from "../net/protocol";
import type { ContourEdits } from "./contour_edits";
import { linesOf } from "./free_outlines";
import { CLICK_PIXELS, DRAG_PIXELS, type Gesture } from "./gesture";
import type { Place } from "./place";
import type { EditorServices } from "./services";
import { isHidden } from "./sight";

const POINT_PIXELS = 8;

/** A single point of a structure: its surface passes it, or it lies inside or outside. */
export interface SinglePoint {
  structure: number;
  kind: PointKind;
  at: Vec3;
}

/** Where the hand has a point, by where the pointer is; null where that is no place for it. */
export type PlaceOf = (pointer: Point2) => Vec3 | null;

/** Where a click in the 3D view met a structure's surface, and how large a click is there. */
export interface SurfacePlace {
  structure: number;
  at: Vec3;
  reach_mm: number;
}

/** `from`: where it was, if it was. */
interface Held extends SinglePoint {
  from: Vec3 | null;
}

/** In the order of the list. */
export const pointsOf = ({ id: structure, surface_points = [], interior = [], exterior = [] }: Structure): SinglePoint[] => [
  ...surface_points.map(({ at }): SinglePoint => ({ structure, kind: "surface", at })),
  ...interior.map((at): SinglePoint => ({ structure, kind: "interior", at })),
  ...exterior.map((at): SinglePoint => ({ structure, kind: "exterior", at })),
];

/** Sets, moves and removes single points of structures. */
export class SinglePoints extends Emitter<"points"> {
  private chosen: SinglePoint | null = null;
  /** One under the hand, or on its way to the server. */
  private held: Held | null = null;

  constructor(
    private readonly project: Project,
    private readonly edits: ContourEdits,
    private readonly services: EditorServices,
  ) {
    super();
    project.on(["structures", "draft"], () => this.hold(null));
    project.on(["selection"], () => {
      if (project.selection) this.choose(null);
    });
  }

  /** Of structures that are seen, each where the hand has it. */
  shown(): SinglePoint[] {
    const { held } = this;
    const stored = [...this.project.structures.values()].filter(({ visible }) => visible).flatMap(pointsOf);
    if (!held) return stored;
    return [...stored.filter(({ structure, at }) => structure !== held.structure || !isSame(at, held.from)), held];
  }

  get selected(): SinglePoint | null {
    return this.shown().find((point) => this.isSelected(point)) ?? null;
  }

  isSelected({ structure, at }: SinglePoint): boolean {
    return this.chosen?.structure === structure && isSame(at, this.chosen.at);
  }

  select(point: SinglePoint): void {
    this.project.select(null);
    this.project.activate(point.structure);
    this.choose(point);
  }

  /** False where none was selected. */
  deselect(): boolean {
    const was = this.selected !== null;
    this.choose(null);
    return was;
  }

  /** Those that lie in the slice. */
  lyingIn(screen: Screen, step_mm: number): SinglePoint[] {
    return this.shown().filter(({ at }) => Math.abs(depthBelow(screen, at)) < step_mm / 2);
  }

  at({ screen, step_mm, pointer }: Place): SinglePoint | null {
    const reach = POINT_PIXELS * (screen.reach ?? 1);
    return this.lyingIn(screen, step_mm).find(({ at }) => gap(toScreen(screen, at), pointer) < reach) ?? null;
  }

  /** Sets a point of the active structure, which the hand may still move until it lets go; or takes one that is there. */
  press(place: Place): Gesture | null {
    const grabbed = this.at(place);
    if (grabbed) return this.grab(onSlice(place.screen), place.pointer, grabbed);
    const structure = this.project.activeStructure?.id;
    if (structure === undefined || !this.takesPoints(structure)) return null;
    const kind = this.kindAt(place, structure);
    return this.gesture(onSlice(place.screen), place.pointer, { structure, kind, from: null }, 0, (at) => this.add(structure, at, kind));
  }

  /** Of a mask a point says that it is wrong here: outside where the mask has it inside, and the other way round. */
  private kindAt({ view, screen, pointer }: Place, structure: number): PointKind {
    if (!this.project.structures.get(structure)?.mask) return "surface";
    const shown = this.services.outlinesOf(view);
    const lines = shown ? linesOf(shown, structure, screen) : [];
    return lines.filter((line) => isInside(line, pointer)).length % 2 === 1 ? "exterior" : "interior";
  }

  /** `placeOf`: on a slice, or in space. */
  grab(placeOf: PlaceOf, pointer: Point2, point: SinglePoint): Gesture {
    this.select(point);
    const { structure, kind, at: from } = point;
    return this.gesture(placeOf, pointer, { structure, kind, from }, DRAG_PIXELS, (to) => {
      this.choose({ structure, kind, at: to });
      this.edits.make("point.move", { structure, at: from, to });
    });
  }

  clickSurface({ structure, at, reach_mm }: SurfacePlace): void {
    const there = this.shown().find((point) => point.structure === structure && distance(point.at, at) < reach_mm);
    if (there) this.select(there);
    else if (this.project.structures.get(structure)?.mask) this.services.tell("Points of a mask lie inside or outside of it: click on a slice.");
    else if (this.takesPoints(structure)) this.add(structure, at);
  }

  /** False where none is selected. */
  removeSelected(): boolean {
    const { selected } = this;
    if (selected) this.edits.make("point.remove", { structure: selected.structure, at: selected.at });
    return selected !== null;
  }

  private add(structure: number, at: Vec3, kind: PointKind = "surface"): void {
    const point: SinglePoint = { structure, kind, at };
    this.select(point);
    this.hold({ ...point, from: null });
    this.edits.make("point.add", { structure, at, kind });
  }

  private takesPoints(structure: number): boolean {
    if (isHidden(structure, this.project, this.services)) return false;
    if (this.project.contoursOf(structure).length > 0 || this.project.structures.get(structure)?.mask) return true;
    this.services.tell(`${this.project.structures.get(structure)?.name} has no contour yet, and a point alone makes no surface.`);
    return false;
  }

  /** A press that moves less than `slack` pixels from a point leaves it where it is. */
  private gesture(placeOf: PlaceOf, start: Point2, of: Omit<Held, "at">, slack: number, make: (at: Vec3) => void): Gesture {
    let isMoved = slack === 0;
    let at: Vec3 | null = null;
    const follow = (to: Point2) => {
      isMoved ||= gap(to, start) > slack;
      if (!isMoved) return;
      // A click is where it began, not where a hand that was not quite still has let go.
      at = placeOf(gap(to, start) > CLICK_PIXELS ? to : start) ?? at;
      if (at) this.hold({ ...of, at });
    };
    if (isMoved) follow(start);
    return {
      move: follow,
      end: (to) => {
        follow(to);
        if (at) make(at);
      },
      cancel: () => this.hold(null),
    };
  }

  private choose(point: SinglePoint | null): void {
    if (this.chosen === point) return;
    this.chosen = point;
    this.emit("points");
  }

  private hold(held: Held | null): void {
    if (this.held === held) return;
    this.held = held;
    this.emit("points");
  }
}

export const onSlice =
  (screen: Screen): PlaceOf =>
  (pointer) =>
    toWorld(screen, pointer);

const isSame = (a: Vec3, b: Vec3 | null): boolean => b !== null && a.every((value, axis) => value === b[axis]);
