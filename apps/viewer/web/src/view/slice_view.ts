// SPDX-License-Identifier: Apache-2.0
import type { PixelPlane } from "../geometry/plane";
import { isSamePlane } from "../geometry/plane";
import { planeOf, slicePlane, toWorld, type Point2, type Screen } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";
import type { SavedAppearance } from "../model/appearance";
import { measured } from "../model/measurements";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { SecondImage } from "../model/second_image";
import type { Http } from "../net/http";
import { ServerError } from "../net/http";
import type { BinaryReply } from "../net/binary";
import { Latest } from "../net/latest";
import type { Coding, Pixels, SliceHeader, ViewName } from "../net/protocol";
import type { Editor } from "../tools/editor";
import type { ShownOutlines } from "../tools/free_outlines";
import { inView } from "../tools/hit";
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { OverlayPainter } from "./overlay";
import { newestOutlines, toldOutline } from "./outlines";
import { PLANE_COLORS } from "../model/palette";
import { SliceFrames } from "./slice_frames";
import { SliceImage } from "./slice_image";
import { SecondSlice } from "./second_slice";
import { SliceSlider } from "./slice_slider";
import { canShow } from "./windowing";
import { SliceVectors, type ShownSlice } from "./slice_vectors";

const MOST_PIXELS = 4096; // of a slice, along a side
const CROSSINGS_WAIT_MS = 250;
const ASK_AGAIN_MS = 50; // so that two who overtake each other leave the server time to answer one

export interface SliceViewServices {
  navigation: Navigation;
  project: Project;
  editor: Editor;
  appearance: SavedAppearance;
  second: SecondImage;
  http: Http;
  failed(error: unknown): void;
}

/** What has come of a slice, and its size. */
interface KeptSlice {
  reply: BinaryReply<SliceHeader>;
  width: number;
  height: number;
  plane: PixelPlane;
  time: number;
}

/** One pane: a slice as the server computes it, vectors over it, a slider beside it. */
export class SliceView {
  readonly element: HTMLElement;
  readonly overlay = el("canvas", { class: "overlay", tabIndex: 0 });
  readonly header: HTMLElement;
  private readonly image = new SliceImage();
  private readonly second: SecondSlice;
  private readonly slider: SliceSlider;
  private readonly title = el("span", { class: "pane-title" });
  private readonly position = el("span", { class: "slice-number" });
  private slice: ShownSlice | null = null;
  private readonly vectors: SliceVectors;
  private readonly frames = new SliceFrames<KeptSlice>();
  private readonly requests: Latest<{ pixels: Pixels }>;
  private askedPlane = "";
  private valuesComing = ""; // of which plane
  private coding: Coding | null = null; // how finely values came last
  private asked = ""; // what the pixels depend on: other views' scrolling must not cost a slice here
  private paintQueued = false;
  private showsDraft = false;
  private crossingsTimer = 0;
  private width = 0;
  private height = 0;
  private fontPixels = 13;

  constructor(
    readonly name: ViewName,
    private readonly services: SliceViewServices,
  ) {
    const { navigation } = services;
    this.second = new SecondSlice(services.second, services.http, services.navigation);
    this.slider = new SliceSlider(name, navigation, services.project);
    this.vectors = new SliceVectors(name, services);
    this.requests = new Latest(
      (request) => this.ask(request.pixels),
      (old, next) => ({ pixels: next.pixels || old.pixels }),
    );
    this.header = el("div", { class: "pane-header" });
    const reset = button({
      icon: ICONS.reset,
      title: "Turn and zoom this view back to where it began",
      class: "icon-button small",
      test: `reset-${name}`,
      click: () => navigation.resetView(name),
    });
    const enlarge = button({
      icon: ICONS.enlarge,
      title: "Show this view alone, or go back (double click on its title)",
      class: "icon-button small",
      test: `enlarge-${name}`,
      click: () => void this.header.dispatchEvent(new MouseEvent("dblclick")),
    });
    this.overlay.setAttribute("role", "img");
    const dot = el("span", { class: "plane-dot" });
    dot.style.background = PLANE_COLORS[name];
    this.header.append(dot, this.title, this.position, el("span", { class: "spring" }), reset, enlarge);
    this.element = el(
      "section",
      { class: "pane slice", "data-view": name },
      this.image.canvas,
      this.second.canvas,
      this.overlay,
      this.header,
      this.slider.element,
    );
    this.element.style.setProperty("--plane-color", PLANE_COLORS[name]);
    new ResizeObserver(() => this.resized()).observe(this.element);
  }

  /** Says what the view is called. */
  showTitle(): void {
    const title = this.services.navigation.title(this.name);
    this.title.textContent = title;
    this.element.setAttribute("aria-label", `${title} view`);
    this.overlay.setAttribute("aria-label", `${title} slice`);
  }

  /** Null while the pane is not shown. */
  screen(): Screen | null {
    if (!this.services.navigation.hasImage || this.width < 16 || this.height < 16) return null;
    return this.services.navigation.screen(this.name, this.width, this.height);
  }

  /** Asks for a slice where plane, size or window have changed; without `pixels` for the outlines on it in any case. */
  refresh(pixels: boolean): void {
    if (!this.screen()) return void (this.asked = this.askedPlane = ""); // when it is shown again all may be different
    this.updateSlider();
    this.paint();
    const key = this.pixelKey();
    const needsPixels = this.image.isEmpty || key !== this.asked;
    const needsSecond = this.second.needs(this.planeKey());
    if (pixels && !needsPixels && !needsSecond) return;
    if (needsPixels && !needsSecond && this.showKept(key)) return;
    const isOtherWindow = needsPixels && !this.image.isEmpty && this.imageKey() === this.askedPlane;
    if (needsPixels) [this.asked, this.askedPlane] = [key, this.imageKey()];
    if (isOtherWindow && !needsSecond && this.valuesComing === this.askedPlane) return; // shown in the window that there is then
    if (isOtherWindow && !needsSecond && !this.requests.busy && this.image.window(this.services.navigation.window)) return;
    const wanted = needsPixels && (this.isTooCoarse() ? "shades" : isOtherWindow ? "values" : true);
    if (needsPixels) this.valuesComing = wanted === "values" ? this.askedPlane : "";
    this.requests.send({ pixels: wanted });
    this.element.dataset["pending"] = "true";
    window.clearTimeout(this.crossingsTimer);
    this.crossingsTimer = 0;
    void this.requests.idle().then(() => (this.element.dataset["pending"] = String(this.crossingsTimer !== 0)));
  }

  /** A frame that has been seen needs no server; its outlines may be newer by now. False where it is not known. */
  private showKept(key: string): boolean {
    const kept = this.requests.busy ? null : this.frames.get(key);
    if (!kept) return false;
    [this.asked, this.askedPlane] = [key, this.imageKey()];
    this.take(kept, true);
    this.paint();
    this.tellState();
    if (this.lacksOutlines()) this.requests.send({ pixels: false });
    return true;
  }

  /** Settles when all that was asked for has come. */
  idle(): Promise<void> {
    return this.requests.idle();
  }

  /** The second image is to be seen, or not, or another one, or in other colours. */
  secondChanged(): void {
    this.frames.clear();
    this.second.recolor();
    this.refresh(true);
  }

  /** Paints before the next frame. */
  paint(): void {
    if (this.paintQueued) return;
    this.paintQueued = true;
    requestAnimationFrame(() => {
      this.paintQueued = false;
      this.paintNow();
    });
  }

  /** Asks for the points where contours cross the plane: after the surface that is on its way, which users wait for. */
  contoursChanged(): void {
    this.frames.clear(); // where contours cross is told with a slice
    const isComing = [...this.services.project.surfaces.values()].some(({ stage }) => stage === "outdated" || stage === "preview");
    if (!isComing || !this.slice) return this.refresh(false);
    this.slider.update();
    this.paint();
    this.element.dataset["pending"] = "true";
    window.clearTimeout(this.crossingsTimer);
    this.crossingsTimer = window.setTimeout(() => {
      this.crossingsTimer = 0;
      this.refresh(false);
    }, CROSSINGS_WAIT_MS);
  }

  /** Paints if the contour under the hand is seen here, or was. */
  draftChanged(): void {
    const screen = this.screen();
    const { project, navigation } = this.services;
    const showed = this.showsDraft;
    this.showsDraft = screen !== null && project.draft !== null && inView(project.draft, screen, navigation.step(this.name));
    if (showed || this.showsDraft) this.paint();
  }

  /** Asks for the outlines of surfaces that are newer than those shown, unless they have been told already. */
  surfacesChanged(): void {
    if (this.lacksOutlines()) return this.refresh(false);
    if ([...this.services.project.surfaces.values()].some(({ stage }) => stage !== "preview")) this.paint(); // conflicts may be new
    // The slice that is on its way may have been made before them, and take their place.
    if (this.requests.busy) void this.requests.idle().then(() => !this.requests.busy && this.lacksOutlines() && this.refresh(false));
  }

  private lacksOutlines(): boolean {
    const { project } = this.services;
    if (this.slice && this.slice.time !== project.time) return true;
    return [...project.surfaces.values()].some(({ structure, stage }) => {
      const shown = this.slice?.outlines.get(structure)?.revision;
      return (
        shown !== (stage === "none" && !project.motions.has(structure) ? undefined : project.revisionAt(structure)) &&
        project.structures.get(structure)?.visible === true
      );
    });
  }

  /** Outlines that the server tells unasked. Of another plane than the one shown they are of no use. */
  showOutlines(structure: number, revision: number, plane: PixelPlane, lines: number[][], withoutImage?: number[][]): void {
    if (!this.slice || !isSamePlane(plane, this.slice.plane)) return;
    this.slice.outlines.set(structure, toldOutline(structure, revision, lines, withoutImage));
    this.paintNow();
    this.tellState();
  }

  /** Null before the first slice has come. Those of a slice that was shown before are told with their own plane. */
  shownOutlines(): ShownOutlines | null {
    return this.slice && { plane: this.slice.plane, outlines: this.slice.outlines.values() };
  }

  /** Of a server that has started anew, and counts revisions from 1. */
  forgetOutlines(): void {
    this.frames.clear();
    this.slice?.outlines.clear();
  }

  pointOf(event: MouseEvent): Point2 {
    const box = this.overlay.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  private resized(): void {
    const box = this.element.getBoundingClientRect();
    if (box.width === this.width && box.height === this.height) return;
    this.width = box.width;
    this.height = box.height;
    this.fontPixels = Number.parseFloat(getComputedStyle(this.element).fontSize);
    const ratio = this.ratio();
    for (const canvas of [this.image.canvas, this.second.canvas, this.overlay]) {
      canvas.width = Math.round(this.width * ratio);
      canvas.height = Math.round(this.height * ratio);
    }
    this.image.resized();
    this.second.resized();
    this.refresh(true);
  }

  private planeKey(): string {
    const { origin, u, v, mm_per_pixel } = slicePlane(this.screen()!, this.ratio());
    return [...origin, ...u, ...v, mm_per_pixel, this.width, this.height].map((value) => value.toFixed(6)).join();
  }

  /** Of what is seen of the image, in whatever window. */
  private imageKey(): string {
    return `${this.planeKey()} ${this.services.navigation.time}`;
  }

  private pixelKey(): string {
    const { center, width } = this.services.navigation.window;
    return [this.imageKey(), center.toFixed(6), width.toFixed(6)].join();
  }

  /** Values come in steps that the window would show: then only the server can show it. */
  private isTooCoarse(): boolean {
    return this.coding !== null && !canShow(this.coding, this.services.navigation.window);
  }

  private ratio(): number {
    return Math.min(window.devicePixelRatio || 1, MOST_PIXELS / Math.max(this.width, this.height, 1));
  }

  private async ask(pixels: Pixels): Promise<void> {
    const screen = this.screen();
    if (!screen) return;
    const ratio = this.ratio();
    const plane = slicePlane(screen, ratio);
    const width = Math.max(1, Math.round(screen.width * ratio));
    const height = Math.max(1, Math.round(screen.height * ratio));
    const { window, time, isAway } = this.services.navigation;
    const key = this.pixelKey();
    try {
      const raster = { view: this.name, plane, width, height };
      const [reply, laySecond] = await Promise.all([
        this.services.http.slice({ ...raster, window, pixels, outlines: true, ...(isAway && { time }) }),
        this.second.ask(raster, this.planeKey()),
      ]);
      const made = { reply, width, height, plane, time };
      this.take(made, pixels !== false);
      if (pixels && this.services.navigation.times > 1) this.frames.keep(key, made, reply.bytes);
      laySecond?.();
      this.paintNow();
    } catch (error) {
      if (error instanceof ServerError && error.kind === "cancelled") return this.askAgain(pixels);
      if (pixels) this.asked = this.askedPlane = this.valuesComing = "";
      this.services.failed(error);
    }
    this.tellState();
    this.element.dataset["slices"] = String(Number(this.element.dataset["slices"] ?? 0) + 1);
  }

  private take({ reply, width, height, plane, time }: KeptSlice, hasPixels: boolean): void {
    this.slice = {
      plane,
      header: reply.header,
      outlines: newestOutlines(
        reply.header.outlines,
        reply.f32("outline_points"),
        this.slice && this.slice.time === time && isSamePlane(plane, this.slice.plane) ? this.slice.outlines : null,
      ),
      time,
      crossingPoints: reply.f32("crossing_points"),
    };
    if (hasPixels) this.keepPixels(reply, width, height);
  }

  /** The window may have changed since values were asked for. */
  private keepPixels(reply: BinaryReply<SliceHeader>, width: number, height: number): void {
    const { plane } = this.slice!;
    const { values, samples } = reply.header;
    if (!values || !samples) return this.image.keep(reply.u8("pixels"), width, height, plane);
    this.coding = values;
    this.valuesComing = "";
    this.image.keepValues({ codes: reply.u16("values"), coding: values, samples, width, height }, this.services.navigation.window, plane);
    if (this.isTooCoarse()) this.requests.send({ pixels: "shades" });
  }

  /** A request that another one overtook is not answered, and what it asked for is still wanted. */
  private async askAgain(pixels: Pixels): Promise<void> {
    if (!this.requests.hasNext) await new Promise((resolve) => void setTimeout(resolve, ASK_AGAIN_MS));
    this.requests.send({ pixels });
  }

  /** What tests and measurements wait for. */
  private tellState(): void {
    const { dataset } = this.element;
    dataset["revisions"] = [...(this.slice?.outlines.values() ?? [])].map((outline) => `${outline.structure}:${outline.revision}`).join(" ");
    dataset["withoutImage"] = [...(this.slice?.outlines.values() ?? [])]
      .flatMap(({ structure, without_image }) => (without_image ? [structure] : []))
      .join(" ");
    dataset["crossings"] = String(this.slice?.header.crossings.length ?? 0);
  }

  private updateSlider(): void {
    const { navigation } = this.services;
    this.slider.update();
    const { number, count } = navigation.slice(this.name);
    this.position.textContent = `${number} / ${count}`;
    const { dataset } = this.element;
    dataset["slice"] = String(number);
    dataset["turned"] = String(navigation.isTurned(this.name));
    dataset["pixelsPerMm"] = String(1 / this.screen()!.mm_per_pixel);
  }

  private paintNow(): void {
    const screen = this.screen();
    if (!screen) return;
    this.image.paint(screen, this.ratio());
    this.second.paint(screen, this.ratio(), this.image.plane);
    this.paintOverlay(screen);
  }

  private paintOverlay(screen: Screen): void {
    const context = this.overlay.getContext("2d")!;
    const ratio = this.ratio();
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, this.width, this.height);
    this.vectors.paint(new OverlayPainter(context, screen, this.services.appearance, this.fontPixels), screen, this.slice);
    this.overlay.style.cursor = this.services.editor.cursor();
    this.tellMeasured(screen);
  }

  /** A canvas says nothing to those who do not see it. */
  private tellMeasured(screen: Screen): void {
    const { editor, navigation } = this.services;
    const texts = editor.measuring.measurements.lyingIn(planeOf(screen), navigation.step(this.name)).map(measured).join("; ");
    if (this.element.dataset["measured"] === texts) return;
    this.element.dataset["measured"] = texts;
    this.overlay.setAttribute("aria-label", [`${navigation.title(this.name)} slice`, texts].filter(Boolean).join(": "));
  }

  /** The point of the plane under the pointer. */
  worldAt(event: MouseEvent): Vec3 | null {
    const screen = this.screen();
    return screen && toWorld(screen, this.pointOf(event));
  }
}
