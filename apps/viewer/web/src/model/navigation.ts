// SPDX-License-Identifier: Apache-2.0
import { extent, projected, rotatedAxes, type Axes, type Plane } from "../geometry/plane";
import { toScreen, type Screen } from "../geometry/screen";
import { add, dot, scale, sub, type Vec3 } from "../geometry/vec";
import { VIEW_NAMES, type ImageInfo, type Session, type ViewGeometry, type ViewName, type Window } from "../net/protocol";
import { Emitter } from "./emitter";

export type PaneName = ViewName | "surface";
const LAYOUT_NAMES = ["overview", "big-slice", "big-surface", "single"] as const;
export type LayoutName = (typeof LAYOUT_NAMES)[number];

/** Which way a view looks, and what part of its plane it shows. */
export interface Camera {
  axes: Axes;
  center: Vec3; // only its position along u and v counts
  zoom: number; // 1 shows the whole image
}

/** What is kept with the project for the next visit. */
export interface SavedNavigation {
  crosshair: Vec3;
  cameras: Record<ViewName, Camera>;
  window: Window;
  layout: LayoutName;
  big: PaneName;
  linked?: boolean;
}

/** Where one looks, without layout and zoom: what windows beside each other have in common. */
export interface SharedPlace {
  crosshair: Vec3;
  axes: Record<ViewName, Axes>;
  window: Window;
  time: number;
}

const PANES: readonly PaneName[] = [...VIEW_NAMES, "surface"];
const ZOOM_LIMITS: [number, number] = [0.25, 40];
const FIT_MARGIN = 1.06;

/** Where the user is in the image. All slice planes go through the crosshair. */
export class Navigation extends Emitter<"planes" | "window" | "layout" | "time"> {
  crosshair: Vec3 = [0, 0, 0];
  cameras = {} as Record<ViewName, Camera>;
  window: Window = { center: 0, width: 1 };
  layout: LayoutName = "overview";
  linked = false; // all slices zoom and shift together
  big: PaneName = "axial"; // the pane that is big in "big-slice", or alone in "single"
  /** As they are shown, the slices as they were taken first. */
  order: readonly ViewName[] = VIEW_NAMES;
  /** Which of the volumes that follow each other is seen, from 0. */
  time = 0;
  private image: ImageInfo | null = null;
  private views!: Record<ViewName, ViewGeometry>;

  start(session: Session, saved: SavedNavigation | null): void {
    this.image = session.image;
    this.views = session.views;
    this.order = [session.first_view, ...VIEW_NAMES.filter((view) => view !== session.first_view)];
    this.window = saved?.window ?? { ...session.window };
    this.crosshair = saved?.crosshair ?? this.middle();
    for (const view of VIEW_NAMES) this.cameras[view] = saved?.cameras[view] ?? this.initialCamera(view);
    const { state } = session.arrangement; // of a project that is new
    this.layout = saved?.layout ?? LAYOUT_NAMES.find((name) => name === state?.layout) ?? "overview";
    this.big = saved?.big ?? PANES.find((name) => name === state?.big) ?? session.first_view;
    this.linked = saved?.linked ?? false;
    this.time = session.image.time;
    this.emit("planes", "window", "layout", "time");
  }

  /** False until the server has said what the image is. */
  get hasImage(): boolean {
    return this.image !== null;
  }

  get times(): number {
    return this.image?.times ?? 1;
  }

  /** The time that contours belong to. */
  get ownTime(): number {
    return this.image?.time ?? 0;
  }

  /** Another time is seen than the one that contours belong to. */
  get isAway(): boolean {
    return this.time !== this.ownTime;
  }

  /** After the last one comes the first. */
  setTime(time: number): void {
    const next = ((time % this.times) + this.times) % this.times;
    if (next === this.time) return;
    this.time = next;
    this.emit("time");
  }

  saved(): SavedNavigation {
    const { crosshair, cameras, window, layout, big, linked } = this;
    return { crosshair, cameras, window, layout, big, linked };
  }

  place(): SharedPlace {
    const { axial, sagittal, coronal, oblique } = this.cameras;
    return {
      crosshair: this.crosshair,
      axes: { axial: axial.axes, sagittal: sagittal.axes, coronal: coronal.axes, oblique: oblique.axes },
      window: this.window,
      time: this.time,
    };
  }

  /** Looks where another window does. */
  follow({ crosshair, axes, window, time }: SharedPlace): void {
    if (!this.image) return;
    for (const view of VIEW_NAMES) this.cameras[view] = { ...this.cameras[view], axes: axes[view] };
    Object.assign(this, { crosshair, window, time });
    this.emit("planes", "window", "time");
  }

  /** What the view is called: of an image that lies obliquely not by the patient's axes. */
  title(view: ViewName): string {
    return this.views[view].title;
  }

  plane(view: ViewName): Plane {
    return { ...this.cameras[view].axes, origin: this.crosshair };
  }

  step(view: ViewName): number {
    return this.views[view].step_mm;
  }

  /** The view's canvas on its plane. */
  screen(view: ViewName, width: number, height: number): Screen {
    const { axes, center, zoom } = this.cameras[view];
    const { width_mm, height_mm } = this.views[view];
    const fit = FIT_MARGIN * Math.max(width_mm / width, height_mm / height);
    return { axes, center: projected(this.plane(view), center), mm_per_pixel: fit / zoom, width, height };
  }

  /** Where scrolling on leads: down, from the head to the feet, or else away from the viewer. */
  direction(view: ViewName): Vec3 {
    return scale(this.cameras[view].axes.normal, this.scrollsBackwards(view) ? -1 : 1);
  }

  /** How far the crosshair can go in the view's direction from the image's centre, in mm, and where it is. */
  depth(view: ViewName): { from: number; to: number; at: number } {
    const direction = this.direction(view);
    const { origin, normal } = this.views[view].plane;
    const [first, last] = this.views[view].range_mm;
    const ends: [number, number] = dot(direction, normal) > 0 ? [first, last] : [-last, -first];
    const [from, to] = this.isTurned(view) ? extent(this.image!.corners, direction, origin) : ends;
    return { from, to, at: this.depthOf(view, this.crosshair) };
  }

  /** How deep a point lies in the view's direction, from the image's centre, in mm. */
  depthOf(view: ViewName, p: Vec3): number {
    return dot(sub(p, this.views[view].plane.origin), this.direction(view));
  }

  /** The number of the slice on which the point lies while the view is not turned, from 1. */
  unturnedSliceOf(view: ViewName, p: Vec3): number {
    const { plane, range_mm, step_mm } = this.views[view];
    const [first, last] = range_mm;
    const height = dot(sub(p, plane.origin), plane.normal);
    return Math.round((this.scrollsBackwards(view) ? last - height : height - first) / step_mm) + 1;
  }

  private scrollsBackwards(view: ViewName): boolean {
    return this.views[view].plane.normal[2] > 0.5;
  }

  /** The view that looks along this normal, or against it, when it is not turned. */
  unturnedViewAlong(normal: Vec3): ViewName | null {
    return VIEW_NAMES.find((view) => Math.abs(dot(this.views[view].plane.normal, normal)) > 0.9999) ?? null;
  }

  isTurned(view: ViewName): boolean {
    return dot(this.cameras[view].axes.normal, this.views[view].plane.normal) < 1 - 1e-9;
  }

  /** Number of the slice and how many there are, from 1. */
  slice(view: ViewName): { number: number; count: number } {
    const { from, to, at } = this.depth(view);
    const step = this.step(view);
    return { number: Math.round((at - from) / step) + 1, count: Math.round((to - from) / step) + 1 };
  }

  scroll(view: ViewName, steps: number): void {
    const { from, at } = this.depth(view);
    const step = this.step(view);
    this.scrollTo(view, from + (Math.round((at - from) / step) + steps) * step);
  }

  /** Moves the crosshair in the view's direction to `depth_mm` from the image's centre, as far as the image goes. */
  scrollTo(view: ViewName, depth_mm: number): void {
    const { from, to, at } = this.depth(view);
    const target = Math.min(Math.max(depth_mm, from), to);
    if (Math.abs(target - at) < 1e-9) return;
    this.crosshair = add(this.crosshair, scale(this.direction(view), target - at));
    this.emit("planes");
  }

  setCrosshair(p: Vec3): void {
    this.crosshair = this.insideImage(p);
    this.emit("planes");
  }

  /** Moves the crosshair there, and brings it into sight of views that are zoomed in on another place. */
  goTo(p: Vec3, screens: Partial<Record<ViewName, Screen>>): void {
    this.crosshair = this.insideImage(p);
    for (const view of VIEW_NAMES) {
      const screen = screens[view];
      if (!screen) continue;
      const [x, y] = toScreen(screen, this.crosshair);
      const margin = 24;
      if (x < margin || y < margin || x > screen.width - margin || y > screen.height - margin)
        this.cameras[view] = { ...this.cameras[view], center: this.crosshair };
    }
    this.emit("planes");
  }

  toggleLinked(): void {
    this.linked = !this.linked;
    this.emit("layout");
  }

  private together(view: ViewName): readonly ViewName[] {
    return this.linked ? VIEW_NAMES : [view];
  }

  /** Keeps the image under `at` where it is on the screen. */
  zoomAt(view: ViewName, at: Vec3, factor: number): void {
    for (const each of this.together(view)) {
      const camera = this.cameras[each];
      const zoom = Math.min(Math.max(camera.zoom * factor, ZOOM_LIMITS[0]), ZOOM_LIMITS[1]);
      const center = add(at, scale(sub(camera.center, at), camera.zoom / zoom));
      this.cameras[each] = { ...camera, zoom, center };
    }
    this.emit("planes");
  }

  pan(view: ViewName, by: Vec3): void {
    for (const each of this.together(view)) this.cameras[each] = { ...this.cameras[each], center: add(this.cameras[each].center, by) };
    this.emit("planes");
  }

  /** Turns `view` about the crosshair and the normal of the view in which its line was turned. */
  rotate(view: ViewName, about: ViewName, angle: number): void {
    const camera = this.cameras[view];
    this.cameras[view] = { ...camera, axes: rotatedAxes(camera.axes, this.cameras[about].axes.normal, angle) };
    this.emit("planes");
  }

  /** Turns `view` so that it shows this plane. */
  turnTo(view: ViewName, axes: Axes): void {
    this.cameras[view] = { ...this.cameras[view], axes: { u: axes.u, v: axes.v, normal: axes.normal } };
    this.emit("planes");
  }

  resetView(view: ViewName): void {
    this.cameras[view] = this.initialCamera(view);
    this.emit("planes");
  }

  resetAll(): void {
    for (const view of VIEW_NAMES) this.cameras[view] = this.initialCamera(view);
    this.crosshair = this.middle();
    this.emit("planes");
  }

  setWindow(window: Window): void {
    const [least, most] = this.image!.range;
    const width = Math.min(Math.max(window.width, 1e-3 * Math.max(most - least, 1e-6)), 4 * Math.max(most - least, 1));
    this.window = { center: window.center, width };
    this.emit("window");
  }

  setLayout(layout: LayoutName, big: PaneName = this.big): void {
    this.layout = layout;
    this.big = big;
    this.emit("layout");
  }

  private initialCamera(view: ViewName): Camera {
    const { u, v, normal, origin } = this.views[view].plane;
    return { axes: { u, v, normal }, center: origin, zoom: 1 };
  }

  /** In the middle of a voxel: of an even number of slices the middle one would be seen between two. */
  private middle(): Vec3 {
    const across = this.order.filter((view) => view !== "oblique").reverse(); // the first one last: it has to be met
    return across.reduce((p, view) => this.onGrid(view, p), this.image!.center);
  }

  private onGrid(view: ViewName, p: Vec3): Vec3 {
    const { plane, range_mm, step_mm } = this.views[view];
    const at = dot(sub(p, plane.origin), plane.normal);
    const snapped = range_mm[0] + Math.round((at - range_mm[0]) / step_mm) * step_mm;
    return add(p, scale(plane.normal, snapped - at));
  }

  private insideImage(p: Vec3): Vec3 {
    let inside = p;
    for (const view of ["axial", "sagittal", "coronal"] as const) {
      const { plane, range_mm } = this.views[view];
      const at = dot(sub(inside, plane.origin), plane.normal);
      const clamped = Math.min(Math.max(at, range_mm[0]), range_mm[1]);
      inside = add(inside, scale(plane.normal, clamped - at));
    }
    return inside;
  }
}
