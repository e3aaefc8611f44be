// SPDX-License-Identifier: Apache-2.0
import type { PixelPlane } from "../geometry/plane";
import type { Screen } from "../geometry/screen";
import type { Coding, Window } from "../net/protocol";
import { PlaneBitmap } from "./plane_bitmap";
import { canShow, shadesOf } from "./windowing";

const GRAY = Uint32Array.from({ length: 256 }, (_, value) => 0xff000000 | (value << 16) | (value << 8) | value);

/** The values of the slice that is shown. */
interface Values {
  codes: Uint16Array;
  coding: Coding;
  shades: Uint8Array;
}

/** The grey values of a slice, laid where its plane is seen. */
export class SliceImage {
  private readonly bitmap = new PlaneBitmap("image");
  private values: Values | null = null;

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
    this.put(gray, width, height, plane);
  }

  keepValues(codes: Uint16Array, coding: Coding, window: Window, width: number, height: number, plane: PixelPlane): void {
    this.values = { codes, coding, shades: new Uint8Array(codes.length) };
    this.put(shadesOf(codes, coding, window, this.values.shades), width, height, plane);
  }

  /** Shows what is there in another window; false where its values are not known, or too coarsely for it. */
  window(window: Window): boolean {
    const { values } = this;
    const { pixels, plane } = this.bitmap;
    if (!values || !pixels || !plane || !canShow(values.coding, window)) return false;
    this.put(shadesOf(values.codes, values.coding, window, values.shades), pixels.width, pixels.height, plane);
    return true;
  }

  private put(gray: Uint8Array, width: number, height: number, plane: PixelPlane): void {
    this.bitmap.put(width, height, plane, (rgba) => {
      for (let i = 0; i < gray.length; ++i) rgba[i] = GRAY[gray[i]!]!;
    });
  }

  resized(): void {
    this.bitmap.resized();
  }

  paint(screen: Screen, ratio: number): void {
    this.bitmap.paint(screen, ratio);
  }
}
