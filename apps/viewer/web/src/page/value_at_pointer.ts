// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import type { Navigation } from "../model/navigation";
import type { SecondImage } from "../model/second_image";
import { Latest } from "../net/latest";
import type { Session } from "../net/protocol";
import type { Socket } from "../net/socket";
import type { StatusBar } from "../ui/status";
import { placeText, valuesText } from "../ui/values";

export interface ValueServices {
  navigation: Navigation;
  second: SecondImage;
  socket: Socket;
  status: StatusBar;
  session(): Session | null;
}

/** Tells in the status line where the pointer is, and what the images have there. */
export class ValueAtPointer {
  private readonly values = new Latest<Vec3>((p) => this.ask(p));

  constructor(private readonly services: ValueServices) {}

  tell(at: Vec3): void {
    this.values.send(at);
  }

  private async ask(at: Vec3): Promise<void> {
    const { navigation, second, socket, status, session } = this.services;
    const { values } = await socket.call("value", { at, ...(navigation.isAway && { time: navigation.time }) });
    const opened = session();
    if (opened) status.setCursor(`${placeText(at, Math.min(...opened.image.spacing_mm))}  ·  ${valuesText(values, opened, second.info)}`);
  }
}
