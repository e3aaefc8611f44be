// SPDX-License-Identifier: Apache-2.0
import { Latest } from "../net/latest";
import type { Http } from "../net/http";
import { paintThumbnail } from "./thumbnails";

interface Wanted {
  canvas: HTMLCanvasElement;
  file: string;
  frame: number;
}

/** Small pictures of a file's frames, one read at a time: the latest that was asked for wins. */
export class FramePictures {
  private readonly requests: Latest<Wanted>;

  constructor(http: Http) {
    this.requests = new Latest(async ({ canvas, file, frame }) => {
      await paintThumbnail(canvas, () => http.frameThumbnail(file, frame));
      canvas.dataset["frame"] = String(frame);
    });
  }

  show(canvas: HTMLCanvasElement, file: string, frame: number): void {
    this.requests.send({ canvas, file, frame });
  }
}
