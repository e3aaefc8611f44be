// SPDX-License-Identifier: Apache-2.0
import type { SecondImage } from "../model/second_image";
import type { Http } from "../net/http";
import type { FurtherImage, Session } from "../net/protocol";
import type { Socket } from "../net/socket";
import { AddImageDialog } from "../start/add_image";
import type { Notices } from "../ui/status";

export interface FurtherImageServices {
  second: SecondImage;
  http: Http;
  socket: Socket;
  notices: Notices;
  session(): Session | null;
  failed(error: unknown): void;
}

/** The second image of the project, which is seen over the first: chosen, told by the server, taken away. */
export class FurtherImageKeeper {
  private dialog: AddImageDialog | null = null;

  constructor(private readonly services: FurtherImageServices) {}

  add(): void {
    const { http, second, session } = this.services;
    const { places = [], folder = "", frame_of_reference_uid: frame = "" } = session() ?? {};
    this.dialog = new AddImageDialog({ http, places, folder, frame, present: second.info });
  }

  /** It goes at once, so that nothing is asked of it meanwhile; if the server keeps it, it is back. */
  remove(): void {
    const { second, socket, failed } = this.services;
    const { info } = second;
    if (!info) return;
    const look = second.saved();
    second.set(null);
    socket.call("image.remove", { image: info.image }).catch((error: unknown) => {
      second.set(info, look);
      failed(error);
    });
  }

  /** What has to be assumed of a new one is said once; its card says it always. */
  show(images: FurtherImage[]): void {
    const { second, notices } = this.services;
    const info = images[0] ?? null;
    const isNew = info !== null && info.key !== second.info?.key;
    second.set(info);
    for (const note of isNew ? info.notes : []) notices.show("warning", note);
  }

  setWork(text: string, fraction: number | null): void {
    this.dialog?.setWork(text, fraction);
  }
}
