// SPDX-License-Identifier: Apache-2.0
import type { PixelPlane } from "../geometry/plane";
import type { Screen } from "../geometry/screen";
import type { Window } from "../net/protocol";
import { PlaneBitmap } from "./plane_bitmap";
import { spread, type SampledSlice } from "./samples";
import { canShow, colorsOfCodes } from "./windowing";

const GRAY = Uint32Array.from({ length: 256 }, (_, value) => 0xff000000 | (value << 16) | (value << 8) | value);

/** The grey values of a slice, laid where its plane is seen. */
export class SliceImage {
  private readonly bitmap = new PlaneBitmap("image");
  private values: SampledSlice | null = null; // of the slice that is shown

  get canvas(): HTMLCanvasElement {
    return this.bitmap.canvas;
  }

  get isEmpty(): boolean {
    return this.bitmap.plane === null;
  }

  /** Of what is shown; null before anything has come. */
  get plane(): PixelPlane | null {
    return this.bitmap.plane;
  }

  keep(gray: Uint8Array, width: number, height: number, plane: PixelPlane): void {
    this.values = null;
    this.bitmap.put(width, height, plane, (rgba) => {
      for (let i = 0; i < gray.length; ++i) rgba[i] = GRAY[gray[i]!]!;
    });
  }

  keepValues(values: SampledSlice, window: Window, plane: PixelPlane): void {
    this.values = values;
    this.put(values, window, plane);
  }

  /** Shows what is there in another window; false where its values are not known, or too coarsely for it. */
  window(window: Window): boolean {
    const { values } = this;
    const { plane } = this.bitmap;
    if (!values || !plane || !canShow(values.coding, window)) return false;
    this.put(values, window, plane);
    return true;
  }

  private put(values: SampledSlice, window: Window, plane: PixelPlane): void {
    const colors = colorsOfCodes(values.coding, window, GRAY, GRAY[0]!);
    this.bitmap.put(values.width, values.height, plane, (rgba) => spread(values, colors, rgba));
  }

  resized(): void {
    this.bitmap.resized();
  }

  paint(screen: Screen, ratio: number): void {
    this.bitmap.paint(screen, ratio);
  }
}
