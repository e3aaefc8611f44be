// SPDX-License-Identifier: Apache-2.0
import { pulled, pullReach } from "../geometry/loop";
import { gap, planeOf, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import { distance, sub, type Vec3 } from "../geometry/vec";
import type { Origin, ViewName } from "../net/protocol";
import { Edits } from "./edits";
import { freeOutlines, nearestOutline, type FreeOutline } from "./free_outlines";
import { DRAG_PIXELS, type Gesture } from "./gesture";
import { LINE_PIXELS } from "./hit";
import { Sketch } from "./sketch";

const MOVED_MM = 0.05;

/** To the nearest of some points. */
const nearestGap = (points: readonly Vec3[], p: Vec3): number => points.reduce((least, q) => Math.min(least, distance(p, q)), Infinity);

/** A computed outline that the pointer is on. */
export interface OutlineHit {
  structure: number;
  at: Vec3;
}

/** Makes contours of what is fitted: where the outline is wrong it is pulled right, and where it is right it is kept. */
export class OutlineEdits extends Edits {
  at(view: ViewName, screen: Screen, pointer: Point2): OutlineHit | null {
    const found = this.below(view, screen, pointer);
    return found && { structure: found.outline.structure, at: toWorld(screen, found.place.at) };
  }

  /** The line that is hit, while the view shows it. */
  line(view: ViewName, { at }: OutlineHit): readonly Vec3[] {
    const screen = this.services.screenOf(view);
    return (screen && this.below(view, screen, toScreen(screen, at))?.outline.points) ?? [];
  }

  /** Null where no outline is. A click moves the crosshair there, as beside the outline. */
  press(view: ViewName, screen: Screen, pointer: Point2): Gesture | null {
    const found = this.below(view, screen, pointer);
    if (!found || this.drawing.holdsUnsaved()) return null;
    const { outline, place } = found;
    const before = place.index + 1;
    const points = [...outline.points.slice(0, before), toWorld(screen, place.at), ...outline.points.slice(before)];
    const start = toWorld(screen, pointer);
    const reach = pullReach(points);
    const contourAt = (at: Point2) => this.contour(screen, outline, pulled(points, before, sub(toWorld(screen, at), start), reach), "pulled");
    let isDrag = false;
    return {
      move: (at) => {
        isDrag ||= gap(at, pointer) > DRAG_PIXELS;
        if (!isDrag) return;
        const pulledLine = contourAt(at);
        this.draft(pulledLine, (p) => nearestGap(points, p) > MOVED_MM);
      },
      end: (at) => {
        this.drafts.drop();
        this.drawing.showHand([]);
        if (isDrag) this.add(contourAt(at));
        else this.navigation.setCrosshair(start);
      },
      cancel: () => {
        this.drawing.showHand([]);
        this.drafts.giveUp();
      },
    };
  }

  /** Makes a contour of the outline under the pointer, or else of the active structure's that is nearest to it, as it is. */
  adopt(view: ViewName, pointer: Point2 | null): void {
    const screen = this.services.screenOf(view);
    if (!screen || this.drawing.holdsUnsaved()) return;
    if (this.drawing.sketch) return this.services.tell("Close the contour that you are drawing first (Enter), or leave it (Esc).");
    const at = pointer ?? [screen.width / 2, screen.height / 2];
    const active = this.project.activeStructure;
    const free = this.free(view, screen);
    const found =
      this.below(view, screen, at) ??
      nearestOutline(
        free.filter(({ structure }) => structure === active?.id),
        at,
      );
    if (found) return this.add(this.contour(screen, found.outline, found.outline.points, "adopted"));
    const name = active?.name ?? "The structure";
    this.services.tell(`${name} has no outline on this slice that is not drawn already. Point at a slice where its computed outline shows, and press A again.`);
  }

  /** A contour that the hand still holds. */
  draft(sketch: Sketch, isMoved?: (p: Vec3) => boolean): void {
    const line = sketch.line();
    this.drawing.showHand(line, isMoved ? line.filter(isMoved) : null);
    const { plane, structure, points, hole } = sketch;
    const time = this.project.timeOfNew;
    this.drafts.send({ name: "contour.add", args: { structure, plane, control: points, ...(hole && { hole }), ...(time !== null && { time }) } });
  }

  add(contour: Sketch): void {
    if (this.project.activeStructure?.id !== contour.structure) this.project.activate(contour.structure);
    this.drawing.send(contour);
  }

  /** An outline's contour with this line. */
  contour(screen: Screen, { structure, isHole }: FreeOutline, points: readonly Vec3[], origin: Origin): Sketch {
    return Sketch.closedFree(planeOf(screen), structure, points, { hole: isHole, origin });
  }

  /** The outlines of the view's slice that can be made contours. */
  free(view: ViewName, screen: Screen): FreeOutline[] {
    const shown = this.services.outlinesOf(view);
    return shown ? freeOutlines(shown, this.project, screen, this.navigation.step(view)) : [];
  }

  private below(view: ViewName, screen: Screen, pointer: Point2): ReturnType<typeof nearestOutline> {
    const found = nearestOutline(this.free(view, screen), pointer);
    return found && found.place.distance <= LINE_PIXELS * (screen.reach ?? 1) ? found : null;
  }
}
