// SPDX-License-Identifier: Apache-2.0
import { depthBelow, gap, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import { distance, type Vec3 } from "../geometry/vec";
import { Emitter } from "../model/emitter";
import type { Project } from "../model/project";
import type { ContourEdits } from "./contour_edits";
import { CLICK_PIXELS, DRAG_PIXELS, type Gesture } from "./gesture";
import type { Place } from "./place";
import type { EditorServices } from "./services";
import { isHidden } from "./sight";

const POINT_PIXELS = 8;

/** A single point that the structure's surface passes. */
export interface PointOfSurface {
  structure: number;
  at: Vec3;
}

/** Where a click in the 3D view met a structure's surface, and how large a click is there. */
export interface SurfacePlace extends PointOfSurface {
  reach_mm: number;
}

/** Sets, moves and removes single points of surfaces. */
export class SurfacePoints extends Emitter<"points"> {
  private chosen: PointOfSurface | null = null;
  /** One under the hand, or on its way to the server; `from`: where it was, if it was. */
  private held: (PointOfSurface & { from: Vec3 | null }) | null = null;

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
  shown(): PointOfSurface[] {
    const { held } = this;
    const stored = [...this.project.structures.values()]
      .filter(({ visible }) => visible)
      .flatMap(({ id, surface_points = [] }) => surface_points.map(({ at }): PointOfSurface => ({ structure: id, at })));
    if (!held) return stored;
    return [...stored.filter(({ structure, at }) => structure !== held.structure || !isSame(at, held.from)), held];
  }

  get selected(): PointOfSurface | null {
    return this.shown().find((point) => this.isSelected(point)) ?? null;
  }

  isSelected({ structure, at }: PointOfSurface): boolean {
    return this.chosen?.structure === structure && isSame(at, this.chosen.at);
  }

  select(point: PointOfSurface): void {
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
  lyingIn(screen: Screen, step_mm: number): PointOfSurface[] {
    return this.shown().filter(({ at }) => Math.abs(depthBelow(screen, at)) < step_mm / 2);
  }

  at({ screen, step_mm, pointer }: Place): PointOfSurface | null {
    const reach = POINT_PIXELS * (screen.reach ?? 1);
    return this.lyingIn(screen, step_mm).find(({ at }) => gap(toScreen(screen, at), pointer) < reach) ?? null;
  }

  /** Sets a point of the active structure, which the hand may still move until it lets go; or takes one that is there. */
  press(place: Place): Gesture | null {
    const grabbed = this.at(place);
    if (grabbed) return this.grab(place.screen, place.pointer, grabbed);
    const structure = this.project.activeStructure?.id;
    if (structure === undefined || !this.takesPoints(structure)) return null;
    return this.gesture(place.screen, place.pointer, { structure, from: null }, 0, (at) => this.add({ structure, at }));
  }

  grab(screen: Screen, pointer: Point2, point: PointOfSurface): Gesture {
    this.select(point);
    const { structure, at: from } = point;
    return this.gesture(screen, pointer, { structure, from }, DRAG_PIXELS, (to) => {
      this.choose({ structure, at: to });
      this.edits.make("point.move", { structure, at: from, to });
    });
  }

  clickSurface({ structure, at, reach_mm }: SurfacePlace): void {
    const there = this.shown().find((point) => point.structure === structure && distance(point.at, at) < reach_mm);
    if (there) this.select(there);
    else if (this.takesPoints(structure)) this.add({ structure, at });
  }

  /** False where none is selected. */
  removeSelected(): boolean {
    const { selected } = this;
    if (selected) this.remove(selected);
    return selected !== null;
  }

  remove({ structure, at }: PointOfSurface): void {
    this.edits.make("point.remove", { structure, at });
  }

  private add(point: PointOfSurface): void {
    this.select(point);
    this.hold({ ...point, from: null });
    this.edits.make("point.add", { ...point });
  }

  private takesPoints(structure: number): boolean {
    if (isHidden(structure, this.project, this.services)) return false;
    if (this.project.contoursOf(structure).length > 0) return true;
    this.services.tell(`${this.project.structures.get(structure)?.name} has no contour yet, and a point alone makes no surface.`);
    return false;
  }

  /** A press that moves less than `slack` pixels from a point leaves it where it is. */
  private gesture(screen: Screen, start: Point2, of: { structure: number; from: Vec3 | null }, slack: number, make: (at: Vec3) => void): Gesture {
    let isMoved = slack === 0;
    const follow = (to: Point2) => {
      isMoved ||= gap(to, start) > slack;
      // A click is where it began, not where a hand that was not quite still has let go.
      if (isMoved) this.hold({ ...of, at: toWorld(screen, gap(to, start) > CLICK_PIXELS ? to : start) });
    };
    if (isMoved) follow(start);
    return {
      move: follow,
      end: (to) => {
        follow(to);
        if (isMoved) make(this.held!.at);
      },
      cancel: () => this.hold(null),
    };
  }

  private choose(point: PointOfSurface | null): void {
    if (this.chosen === point) return;
    this.chosen = point;
    this.emit("points");
  }

  private hold(held: (PointOfSurface & { from: Vec3 | null }) | null): void {
    if (this.held === held) return;
    this.held = held;
    this.emit("points");
  }
}

const isSame = (a: Vec3, b: Vec3 | null): boolean => b !== null && a.every((value, axis) => value === b[axis]);
