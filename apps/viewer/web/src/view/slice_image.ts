// SPDX-License-Identifier: Apache-2.0
import { areParallel, type PixelPlane } from "../geometry/plane";
import { sliceOnScreen, type Screen } from "../geometry/screen";
import type { Coding, Window } from "../net/protocol";
import { el } from "../ui/dom";
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
  readonly canvas = el("canvas", { class: "image" });
  private readonly bitmap = document.createElement("canvas");
  private plane: PixelPlane | null = null;
  private pixels: ImageData | null = null;
  private values: Values | null = null;
  private painted = ""; // which image, and where: painting it once more would cost a frame as much again
  private images = 0; // how many have come

  get isEmpty(): boolean {
    return this.plane === null;
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
    const { values, pixels, plane } = this;
    if (!values || !pixels || !plane || !canShow(values.coding, window)) return false;
    this.put(shadesOf(values.codes, values.coding, window, values.shades), pixels.width, pixels.height, plane);
    return true;
  }

  private put(gray: Uint8Array, width: number, height: number, plane: PixelPlane): void {
    const context = this.bitmap.getContext("2d")!;
    if (this.pixels?.width !== width || this.pixels.height !== height) {
      this.bitmap.width = width;
      this.bitmap.height = height;
      this.pixels = context.createImageData(width, height);
    }
    const rgba = new Uint32Array(this.pixels.data.buffer);
    for (let i = 0; i < gray.length; ++i) rgba[i] = GRAY[gray[i]!]!;
    context.putImageData(this.pixels, 0, 0);
    this.plane = plane;
    ++this.images;
  }

  /** A canvas of another size is empty. */
  resized(): void {
    this.painted = "";
  }

  paint(screen: Screen, ratio: number): void {
    const { canvas, bitmap, plane } = this;
    const context = canvas.getContext("2d")!;
    const place = plane && areParallel(plane, screen.axes) ? sliceOnScreen(screen, plane) : null;
    const painting = JSON.stringify([this.images, ratio, place, canvas.width, canvas.height]);
    if (painting === this.painted) return;
    this.painted = painting;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, canvas.width, canvas.height);
    if (place) {
      const { a, dx, dy } = place;
      context.setTransform(a * ratio, 0, 0, a * ratio, (dx - a / 2) * ratio, (dy - a / 2) * ratio);
      context.drawImage(bitmap, 0, 0);
    } else if (plane) {
      context.drawImage(bitmap, 0, 0, canvas.width, canvas.height); // until the turned slice arrives the old one stays, as it was
    }
  }
}
