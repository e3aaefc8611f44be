// SPDX-License-Identifier: Apache-2.0
import { areParallel, type PixelPlane } from "../geometry/plane";
import { sliceOnScreen, type Screen } from "../geometry/screen";
import { el } from "../dom/dom";

/** A picture of a plane, laid on a canvas where that plane is seen. */
export class PlaneBitmap {
  readonly canvas: HTMLCanvasElement;
  private readonly bitmap = document.createElement("canvas");
  plane: PixelPlane | null = null;
  pixels: ImageData | null = null;
  private painted = ""; // which picture, and where: painting it once more would cost a frame as much again
  private pictures = 0; // how many have come

  constructor(className: string) {
    this.canvas = el("canvas", { class: className });
  }

  /** `fill` is given the pixels as they lie in a canvas, red in the lowest byte. */
  put(width: number, height: number, plane: PixelPlane, fill: (rgba: Uint32Array) => void): void {
    const context = this.bitmap.getContext("2d")!;
    if (this.pixels?.width !== width || this.pixels.height !== height) {
      this.bitmap.width = width;
      this.bitmap.height = height;
      this.pixels = context.createImageData(width, height);
    }
    fill(new Uint32Array(this.pixels.data.buffer));
    context.putImageData(this.pixels, 0, 0);
    this.plane = plane;
    ++this.pictures;
  }

  /** A canvas of another size is empty. */
  resized(): void {
    this.painted = "";
  }

  /** False: nothing, as if no picture had come. */
  paint(screen: Screen, ratio: number, isSeen = true): void {
    const { canvas, bitmap } = this;
    const plane = isSeen ? this.plane : null;
    const context = canvas.getContext("2d")!;
    const place = plane && areParallel(plane, screen.axes) ? sliceOnScreen(screen, plane) : null;
    const painting = JSON.stringify([isSeen, this.pictures, ratio, place, canvas.width, canvas.height]);
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
