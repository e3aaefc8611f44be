// SPDX-License-Identifier: Apache-2.0
import type { FurtherImage, Window } from "../net/protocol";
import { COLOR_MAPS, type ColorMapName } from "./color_maps";
import { Emitter } from "./emitter";

/** Which of the two images the slices show: the project's own, the second one over it, or the second one alone. */
export type Shown = "first" | "both" | "second";

/** How a second image was looked at; kept with the project, for as long as it is the same image. */
export interface SavedSecondImage {
  key: string;
  shown: Shown;
  opacity: number;
  colors: ColorMapName;
  window: Window;
  isFolded?: boolean;
}

const USUAL_OPACITY = 0.5;
const USUAL_EMISSION_OPACITY = 0.7; // its colours fade out where there is little

/** The image that is seen over the one that the project is drawn on, and how. */
export class SecondImage extends Emitter<"image" | "shown" | "look"> {
  info: FurtherImage | null = null;
  shown: Shown = "both";
  /** From 0 to 1, over the first image. */
  opacity = USUAL_OPACITY;
  colors: ColorMapName = "gray";
  window: Window = { center: 0, width: 1 };
  /** Its card shows only which of the two are seen. */
  isFolded = false;
  private beforeAlone: Shown = "both";
  private here = new AbortController(); // aborted when the image goes

  /** What the server holds now; `saved` is how this page, or the last visit, looked at it. */
  set(info: FurtherImage | null, saved: SavedSecondImage | null = null): void {
    const isSame = info !== null && this.info?.key === info.key;
    this.info = info;
    if (!isSame) {
      this.here.abort();
      this.here = new AbortController();
    }
    if (info && !isSame) this.takeLook(info, saved?.key === info.key ? saved : null);
    this.emit("image", "shown", "look");
  }

  private takeLook(info: FurtherImage, saved: SavedSecondImage | null): void {
    this.shown = saved?.shown ?? "both";
    this.beforeAlone = "both";
    this.opacity = saved?.opacity ?? (info.emission ? USUAL_EMISSION_OPACITY : USUAL_OPACITY);
    this.colors = COLOR_MAPS.find(({ name }) => name === saved?.colors)?.name ?? (info.emission ? "hot" : "gray");
    this.window = saved?.window ?? { ...info.window };
    this.isFolded = saved?.isFolded ?? false;
  }

  /** Aborts when the image is no longer there: what is asked of it then has no answer. */
  get untilGone(): AbortSignal {
    return this.here.signal;
  }

  /** Whether a slice needs it. */
  get isSeen(): boolean {
    return this.info !== null && this.shown !== "first";
  }

  get isAlone(): boolean {
    return this.info !== null && this.shown === "second";
  }

  /** The number of the image that one draws on: what is seen alone, else the project's own. */
  get front(): number {
    return this.isAlone ? 1 : 0;
  }

  show(shown: Shown): void {
    if (shown === this.shown) return;
    if (shown === "second") this.beforeAlone = this.shown;
    this.shown = shown;
    this.emit("shown");
  }

  /** To the second image alone, and back to what was seen before. */
  flip(): void {
    this.show(this.shown === "second" ? this.beforeAlone : "second");
  }

  /** Over the first one, or out of sight. */
  toggleOver(): void {
    this.show(this.shown === "both" ? "first" : "both");
  }

  setOpacity(opacity: number): void {
    this.opacity = Math.min(Math.max(opacity, 0), 1);
    this.emit("look");
  }

  setColors(colors: ColorMapName): void {
    this.colors = colors;
    this.emit("look");
  }

  setWindow({ center, width }: Window): void {
    if (!this.info) return;
    const [least, most] = this.info.range;
    const span = Math.max(most - least, 1e-6);
    this.window = { center, width: Math.min(Math.max(width, 1e-3 * span), 4 * span) };
    this.emit("look");
  }

  toggleFolded(): void {
    this.isFolded = !this.isFolded;
    this.emit("look");
  }

  saved(): SavedSecondImage | null {
    if (!this.info) return null;
    const { shown, opacity, colors, window, isFolded } = this;
    return { key: this.info.key, shown, opacity, colors, window, ...(isFolded && { isFolded }) };
  }
}
