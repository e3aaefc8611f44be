// SPDX-License-Identifier: Apache-2.0
import { toWorld, type Point2, type Screen } from "../geometry/screen";
import { mix, sub, type Vec3 } from "../geometry/vec";
import type { Arguments, CallName, Edit } from "../net/calls";
import type { Contour } from "../net/protocol";
import { Edits } from "./edits";
import type { Gesture, Modifiers } from "./gesture";
import { inView, type ContourHit } from "./hit";
import { isContourHidden } from "./sight";

/** Changes contours that are there, by gestures and by commands. */
export class ContourEdits extends Edits {
  /** Carries out a call that changes the project, after the sketches that are on their way. */
  make<Name extends CallName>(name: Name, args: Arguments<Name>): void {
    const { drawing, project, services } = this;
    if (drawing.outbox.isSending) return drawing.outbox.afterSending(() => this.make(name, args));
    drawing.forgetLeft();
    services.call(name, args).then(
      (result: object) => {
        if ("contour" in result) services.made(result.contour as Contour);
      },
      (error: unknown) => {
        project.refused();
        services.failed(error);
      },
    );
  }

  press(screen: Screen, pointer: Point2, hit: ContourHit, modifiers: Modifiers): Gesture | null {
    if (modifiers.ctrl) {
      this.make("contour.insert_point", { id: hit.contour, at: hit.at });
      this.project.select({ contour: hit.contour, point: null });
      return null;
    }
    this.project.select({ contour: hit.contour, point: hit.on === "point" ? hit.index : null });
    if (modifiers.shift) return this.move(screen, pointer, hit.contour);
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

  move(screen: Screen, pointer: Point2, contour: number): Gesture {
    this.project.select({ contour, point: null });
    const start = toWorld(screen, pointer);
    return this.draftGesture(pointer, (at) => ({
      name: "contour.translate",
      args: { id: contour, by: sub(toWorld(screen, at), start) },
    }));
  }

  redraw(screen: Screen, step_mm: number, pointer: Point2, hit: ContourHit | null): Gesture | null {
    if (this.drawing.holdsUnsaved()) return null;
    const id = hit?.contour ?? this.project.selection?.contour;
    const contour = id === undefined ? undefined : this.project.contour(id);
    if (!contour || !inView(contour, screen, step_mm)) {
      this.services.tell("Begin on the line of the contour that you want to redraw.");
      return null;
    }
    if (isContourHidden(contour, this.project, this.services)) return null;
    this.project.select({ contour: contour.id, point: null });
    const hand: Vec3[] = [toWorld(screen, pointer)];
    return {
      isStroke: true,
      move: (at) => {
        hand.push(toWorld(screen, at));
        this.drawing.showHand(hand);
      },
      end: () => {
        this.drawing.showHand([]);
        if (hand.length > 2) this.drawing.redraw(contour, hand);
      },
      cancel: () => this.drawing.showHand([]),
    };
  }

  /** The surface follows the pointer by drafts; the release makes the edit. */
  private draftGesture(start: Point2, editAt: (pointer: Point2) => Edit): Gesture {
    return this.drafts.drag(start, editAt, ({ name, args }) => this.make(name, args));
  }

  /** Opens the selected contour at the stretch that is hit, or behind its selected point, or where it was closed; closes an open line. */
  openOrClose(hit: ContourHit | null): void {
    const { selectedContour: contour, selection } = this.project;
    if (!contour) return this.services.tell("Select a contour to open or close it. While you draw one, U ends it as an open line.");
    if (isContourHidden(contour, this.project, this.services)) return;
    if (!contour.closed) return this.make("contour.set", { id: contour.id, closed: true });
    const at = hit?.on === "line" && hit.contour === contour.id ? hit.at : behind(contour, selection?.point ?? null);
    this.make("contour.set", { id: contour.id, closed: false, ...(at && { at }) });
    this.project.select({ contour: contour.id, point: null });
  }

  /** The structure lies on the other side of an open line than it was taken to; "auto": that is found out again. */
  turnSide(contour: Contour, side: "other" | "auto"): void {
    const other = this.project.sideOf(contour) === "left" ? "right" : "left";
    this.make("contour.set", { id: contour.id, inside: side === "auto" ? "auto" : other });
  }

  /** The selected point, or else the marked contours. */
  deleteSelected(): void {
    const { selection, marked } = this.project;
    if (!selection) return;
    if (selection.point === null) return this.make("contour.remove", { ids: [...marked] });
    this.make("contour.delete_point", { id: selection.contour, index: selection.point });
    this.project.select({ contour: selection.contour, point: null });
  }
}

/** In the middle of the stretch behind a control point. */
function behind({ control, points }: Contour, index: number | null): Vec3 | null {
  const from = index === null ? undefined : control[index];
  if (!from || control.length < 2) return null;
  const to = control[index! + 1]?.index ?? points.length;
  const middle = Math.floor((from.index + to) / 2);
  return mix(points[middle]!, points[(middle + 1) % points.length]!, 0.5);
}
