// SPDX-License-Identifier: Apache-2.0
import { brushed, newPart, newPartOfOpen, type BrushPoint } from "../geometry/brush";
import { arcLengths, nearestOnPath } from "../geometry/loop";
import { projected } from "../geometry/plane";
import { toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";
import type { Project } from "../model/project";
import type { Edit } from "../net/calls";
import type { Contour, ViewName } from "../net/protocol";
import type { ContourEdits } from "./contour_edits";
import type { Drafts } from "./drafts";
import type { Drawing } from "./drawing";
import type { FreeOutline } from "./free_outlines";
import type { Gesture } from "./gesture";
import { inView } from "./hit";
import type { OutlineEdits } from "./outline_edits";
import type { Place } from "./place";
import type { EditorServices } from "./services";
import { isHidden } from "./sight";

const LEAST_PIXELS = 4;
const MOST_PIXELS = 200;
const NEARLY_HALF = 0.49; // of a line: the server redraws the shorter part

/** What the brush works on, and what of it is drawn at its end. */
interface Target {
  points: readonly Vec3[];
  isClosed: boolean;
  draft(line: readonly BrushPoint[]): void;
  make(line: readonly BrushPoint[]): void;
}

/** What the brush changes: drawn contours, computed outlines, and what is seen of both while the hand moves. */
interface Changes {
  readonly edits: ContourEdits;
  readonly outlines: OutlineEdits;
  readonly drafts: Drafts;
}

/** A round brush that pushes the active structure's nearest line on the slice: a contour, or the computed outline, which becomes one. */
export class Pushing {
  radius = 24; // pixels
  /** Where the brush is seen. */
  place: { view: ViewName; at: Point2 } | null = null;

  constructor(
    private readonly project: Project,
    private readonly drawing: Drawing,
    private readonly changes: Changes,
    private readonly services: EditorServices,
  ) {}

  resize(factor: number): void {
    this.radius = Math.min(Math.max(this.radius * factor, LEAST_PIXELS), MOST_PIXELS);
  }

  press({ view, screen, step_mm, pointer }: Place): Gesture | null {
    if (this.drawing.holdsUnsaved() || isHidden(this.project.activeStructure?.id, this.project, this.services)) return null;
    const target = this.nearest(view, screen, step_mm, pointer);
    if (!target) {
      this.services.tell(`${this.project.activeStructure?.name ?? "The structure"} has no line on this slice that could be pushed.`);
      return null;
    }
    const before: readonly BrushPoint[] = target.points.map((p, original) => ({ at: toScreen(screen, p), original }));
    let line = before;
    let last = pointer;
    const brush = (at: Point2) => {
      this.place = { view, at };
      line = brushed(line, last, at, this.radius, target.isClosed);
      last = at;
    };
    brush(pointer);
    return {
      isStroke: true,
      move: (at) => {
        brush(at);
        const seen = line === before ? [] : this.world(screen, target, line);
        this.drawing.showHand(seen.length > 0 ? [...seen, ...(target.isClosed ? [seen[0]!] : [])] : []);
        if (line !== before) target.draft(line);
      },
      end: (at) => {
        brush(at);
        this.changes.drafts.drop();
        this.drawing.showHand([]);
        if (line !== before) target.make(line);
      },
      cancel: () => {
        this.drawing.showHand([]);
        this.changes.drafts.giveUp();
      },
    };
  }

  /** Points that nothing has touched are where they were, to the last bit. */
  private world(screen: Screen, { points }: Pick<Target, "points">, line: readonly BrushPoint[]): Vec3[] {
    return line.map(({ at, original }) => (original === undefined ? toWorld(screen, at) : points[original]!));
  }

  private nearest(view: ViewName, screen: Screen, step_mm: number, pointer: Point2): Target | null {
    const active = this.project.activeStructure?.id;
    const drawn = this.project.shownContours().filter((contour) => contour.structure === active && inView(contour, screen, step_mm));
    const computed = this.changes.outlines.free(view, screen).filter(({ structure }) => structure === active);
    const targets = [...drawn.map((contour) => this.ofContour(screen, contour)), ...computed.map((outline) => this.ofOutline(screen, outline))];
    const away = targets.map(
      ({ points, isClosed }) =>
        nearestOnPath(
          points.map((p) => toScreen(screen, p)),
          pointer,
          isClosed,
        ).distance,
    );
    return targets[away.indexOf(Math.min(...away))] ?? null;
  }

  private ofContour(screen: Screen, contour: Contour): Target {
    const edit = (line: readonly BrushPoint[]): Edit =>
      this.redraw(contour, line, (part) => this.world(screen, contour, part).map((p) => projected(contour.plane, p)));
    return {
      points: contour.points,
      isClosed: contour.closed,
      draft: (line) => this.changes.drafts.send(edit(line)),
      make: (line) => {
        const { name, args } = edit(line);
        this.changes.edits.make(name, args);
        this.project.select({ contour: contour.id, point: null });
      },
    };
  }

  /** Where little has changed the rest keeps its points to drag. */
  private redraw({ id, points, closed }: Contour, line: readonly BrushPoint[], world: (part: readonly BrushPoint[]) => Vec3[]): Edit {
    const part = closed ? newPart(line) : newPartOfOpen(line, points.length);
    const at = arcLengths(points);
    const whole = at.at(-1)!;
    const replaced = part ? (at[part.to]! - at[part.from]! + whole) % whole : whole;
    if (part && (!closed || replaced < NEARLY_HALF * whole)) return { name: "contour.redraw", args: { id, path: world(part.points), origin: "pushed" } };
    return { name: "contour.redraw", args: { id, path: world(line), whole: true, origin: "pushed" } };
  }

  private ofOutline(screen: Screen, outline: FreeOutline): Target {
    const contour = (line: readonly BrushPoint[]) => this.changes.outlines.contour(screen, outline, this.world(screen, outline, line), "pushed");
    return {
      points: outline.points,
      isClosed: true,
      draft: (line) => this.changes.outlines.draft(contour(line)),
      make: (line) => this.changes.outlines.add(contour(line)),
    };
  }
}
