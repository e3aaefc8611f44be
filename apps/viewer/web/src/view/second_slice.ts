// SPDX-License-Identifier: Apache-2.0
import { isSamePlane, type PixelPlane } from "../geometry/plane";
import type { Screen } from "../geometry/screen";
import type { Navigation } from "../model/navigation";
import type { SecondImage } from "../model/second_image";
import { ServerError, type Http } from "../net/http";
import type { ViewName } from "../net/protocol";
import { colorTable } from "../model/color_maps";
import { PlaneBitmap } from "./plane_bitmap";
import { spread, type SampledSlice } from "./samples";
import { colorsOfCodes } from "./windowing";

/** Which raster of a view is asked for. */
export interface Raster {
  view: ViewName;
  plane: PixelPlane;
  width: number;
  height: number;
}

interface Values extends SampledSlice {
  key: string;
  plane: PixelPlane;
}

/** The second image on a view's slice, over the first one: its values, which the page puts into window and colours itself. */
export class SecondSlice {
  private readonly bitmap = new PlaneBitmap("second-image");
  private values: Values | null = null;
  private colored = ""; // which values, and how: another opacity costs nothing

  constructor(
    private readonly second: SecondImage,
    private readonly http: Http,
    private readonly navigation: Navigation,
  ) {}

  get canvas(): HTMLCanvasElement {
    return this.bitmap.canvas;
  }

  /** Whether the image is to be seen, and its values on this plane are not here. */
  needs(planeKey: string): boolean {
    return this.second.isSeen && this.values?.key !== this.keyOf(planeKey);
  }

  private keyOf(planeKey: string): string {
    const time = this.movesWith(this.navigation) ? this.navigation.time : 0;
    return `${this.second.info?.key ?? ""} ${time} ${planeKey}`;
  }

  /** It moves in time with the first one where it has as many volumes and was opened at the same. */
  private movesWith({ times, ownTime }: Navigation): boolean {
    return this.second.info?.times === times && this.second.info.time === ownTime;
  }

  /** Returns what lays the values, so that both images of a slice can change at once; null where nothing is to be laid. */
  async ask(raster: Raster, planeKey: string): Promise<(() => void) | null> {
    const { info, untilGone } = this.second;
    if (!info || !this.needs(planeKey)) return null;
    const key = this.keyOf(planeKey);
    const { navigation } = this;
    const time = navigation.isAway && this.movesWith(navigation) ? { time: navigation.time } : {};
    try {
      const reply = await this.http.slice({ ...raster, image: info.image, ...time, pixels: "values", outlines: false }, untilGone);
      const { values, samples } = reply.header;
      if (!values || !samples) return null; // it has gone: the page will be told
      return () => {
        this.values = { key, codes: reply.u16("values"), coding: values, samples, ...raster };
        this.recolor();
      };
    } catch (error) {
      const isSuperseded = error instanceof ServerError && error.kind === "cancelled";
      if (untilGone.aborted || (info !== this.second.info && !isSuperseded)) return null; // what is there instead is asked for when the page is told
      throw error;
    }
  }

  /** Puts what is there into the window and the colours of now. */
  recolor(): void {
    if (!this.values) return;
    const { values } = this;
    const coloring = JSON.stringify([values.key, this.second.colors, this.second.isAlone, this.second.window]);
    if (coloring === this.colored) return;
    this.colored = coloring;
    const colors = colorsOfCodes(values.coding, this.second.window, colorTable(this.second.colors, !this.second.isAlone), 0);
    this.bitmap.put(values.width, values.height, values.plane, (rgba) => spread(values, colors, rgba));
  }

  resized(): void {
    this.bitmap.resized();
  }

  /** Only where it lies on the plane that the first image shows: two slices over each other must be of one place. */
  paint(screen: Screen, ratio: number, first: PixelPlane | null): void {
    const { isSeen, isAlone, opacity, info } = this.second;
    const { plane } = this.bitmap;
    const isInPlace = isSeen && plane !== null && first !== null && isSamePlane(plane, first) && this.values?.key.startsWith(`${info?.key} `) === true;
    const { canvas } = this.bitmap;
    canvas.hidden = !isSeen;
    canvas.classList.toggle("alone", isAlone);
    canvas.style.opacity = isAlone ? "1" : String(opacity);
    this.bitmap.paint(screen, ratio, isInPlace);
  }
}
