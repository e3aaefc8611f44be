// SPDX-License-Identifier: Apache-2.0
import type { Session } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { ArrangementKeeper } from "./arrangement";
import { FurtherImageKeeper } from "./further_image";
import { LinkedWindows } from "./linked_windows";
import type { Models } from "./models";
import { PageKeeper, type SavedPage } from "./saved_page";
import type { Server } from "./server";

export interface KeepersServices {
  models: Models;
  server: Server;
  editor: Editor;
  session(): Session | null;
  hintSeen(): boolean;
}

/** What outlives the page: its own state, how its modality is laid out, the second image, a second window's place. */
export class Keepers {
  readonly windows: LinkedWindows;
  readonly page: PageKeeper;
  readonly arrangement: ArrangementKeeper;
  readonly furtherImage: FurtherImageKeeper;

  constructor(private readonly services: KeepersServices) {
    const { models, server, editor, session } = services;
    const { http, socket, notices, failed } = server;
    this.windows = new LinkedWindows(models.navigation);
    this.page = new PageKeeper({
      ...models,
      editor,
      isOpen: () => session() !== null && !this.windows.isSecond,
      hintSeen: services.hintSeen,
      save: (state) => void socket.call("page.save", { state }).catch(() => undefined), // the next change saves again
    });
    this.arrangement = new ArrangementKeeper({
      ...models,
      keep: (modality, state) => void http.keepArrangement(modality, state).catch(() => undefined), // a convenience
    });
    this.furtherImage = new FurtherImageKeeper({ ...models, http, socket, notices, session, failed });
  }

  /** An opened page takes up what it left. */
  restore(session: Session, page: SavedPage | null): void {
    if (!this.windows.isSecond) {
      this.page.restore(page);
      return this.arrangement.start(session, page);
    }
    const { sketch, unsaved, ...others } = page ?? ({} as Partial<SavedPage>); // what is half drawn is the first window's
    this.page.restore(others as SavedPage);
    this.services.models.navigation.setLayout("single", "surface");
  }
}
