// SPDX-License-Identifier: Apache-2.0
import type { BinaryReply } from "../net/binary";

/** Without a picture what it belongs to is as good. */
export async function paintThumbnail(canvas: HTMLCanvasElement, ask: () => Promise<BinaryReply<{ width: number; height: number }>>): Promise<void> {
  try {
    const reply = await ask();
    const { width, height } = reply.header;
    const shades = reply.u8("pixels");
    const pixels = new ImageData(width, height);
    for (let i = 0; i < shades.length; ++i) pixels.data.set([shades[i]!, shades[i]!, shades[i]!, 255], 4 * i);
    canvas.width = width;
    canvas.height = height;
    canvas.getContext("2d")!.putImageData(pixels, 0, 0);
    canvas.dataset["painted"] = "true";
  } catch {
    canvas.dataset["painted"] = "false";
  }
}
