// SPDX-License-Identifier: Apache-2.0
import { gap, type Point2 } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";
import type { Editor } from "../tools/editor";
import { CLICK_PIXELS, type Gesture } from "../tools/gesture";
import type { SinglePoint } from "../tools/single_points";
import type { Scene } from "./scene";

const REACH_PIXELS = { finger: 22, other: 9 };

export interface SurfaceInputServices {
  editor: Editor;
  goTo(p: Vec3): void;
}

/** Clicks on surfaces and marks, and drags of single points; all else turns the view. */
export class SurfaceInput {
  private pressed: { id: number; at: Point2 } | null = null; // as long as it may be a click
  private gesture: Gesture | null = null;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly services: SurfaceInputServices,
    private readonly scene: () => Scene | null,
  ) {
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", () => void this.cancel());
    canvas.addEventListener("dblclick", (event) => {
      const hit = this.scene()?.pick(...this.placeOf(event));
      if (hit) services.goTo(hit.at);
    });
  }

  /** Leaves what the pointer is doing; false when it is doing nothing. */
  cancel(): boolean {
    const { gesture } = this;
    this.gesture = null;
    gesture?.cancel?.();
    return gesture !== null;
  }

  private down(event: PointerEvent): void {
    const at = this.placeOf(event);
    this.pressed = event.isPrimary && event.button === 0 ? { id: event.pointerId, at } : null;
    const point = this.pressed && !this.markBelow(event) ? this.pointBelow(event) : null;
    if (!point) return;
    event.stopImmediatePropagation(); // the view stays as it is
    this.canvas.setPointerCapture(event.pointerId);
    this.gesture = this.services.editor.points.grab((to) => this.placeFor(point, to), at, point);
  }

  /** What lies on the surface moves along it, and what does not, across the view. */
  private placeFor(point: SinglePoint, to: Point2): Vec3 | null {
    const scene = this.scene();
    if (!scene) return null;
    return point.kind === "surface" ? (scene.pick(...to, point.structure)?.at ?? null) : scene.beside(point.at, ...to);
  }

  private move(event: PointerEvent): void {
    if (this.gesture) return this.gesture.move(this.placeOf(event));
    if (this.pressed && !this.isStill(event)) this.pressed = null; // it turns the view, even if it comes back
    if (event.buttons === 0) this.canvas.style.cursor = this.cursorFor(event);
  }

  private cursorFor(event: PointerEvent): string {
    if (this.markBelow(event)) return "pointer";
    if (this.pointBelow(event)) return "grab";
    return this.services.editor.tool.clickSurface ? "crosshair" : "";
  }

  private up(event: PointerEvent): void {
    const { gesture } = this;
    this.gesture = null;
    if (gesture) gesture.end(this.placeOf(event));
    else if (this.isStill(event)) this.click(event);
    this.pressed = null;
  }

  private isStill(event: PointerEvent): boolean {
    return this.pressed?.id === event.pointerId && gap(this.pressed.at, this.placeOf(event)) < CLICK_PIXELS;
  }

  /** On a mark it goes to the place; elsewhere on a surface it is the tool's. */
  private click(event: PointerEvent): void {
    const { editor, goTo } = this.services;
    const scene = this.scene();
    const mark = this.markBelow(event);
    if (mark) return goTo(mark);
    const hit = editor.tool.clickSurface && !editor.isBare && !editor.mayNotEdit() ? scene?.pick(...this.placeOf(event)) : null;
    if (hit) editor.tool.clickSurface!(editor, { ...hit, reach_mm: reachOf(event) * scene!.mm_per_pixel });
  }

  private markBelow(event: PointerEvent): Vec3 | null {
    return this.scene()?.markAt(...this.placeOf(event), reachOf(event)) ?? null;
  }

  /** One that the tool would take. */
  private pointBelow(event: PointerEvent): SinglePoint | null {
    const { editor } = this.services;
    if (!editor.tool.grabsPoints || editor.isBare || editor.isOutOfTime) return null;
    const number = this.scene()?.pointAt(...this.placeOf(event), reachOf(event)) ?? null;
    return number === null ? null : (editor.points.shown()[number] ?? null);
  }

  private placeOf(event: MouseEvent): Point2 {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }
}

const reachOf = ({ pointerType }: PointerEvent): number => (pointerType === "touch" ? REACH_PIXELS.finger : REACH_PIXELS.other);
