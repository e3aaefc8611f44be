// SPDX-License-Identifier: Apache-2.0
import type { Navigation } from "../model/navigation";
import type { PaneSizes } from "../model/pane_sizes";
import type { SavedArrangement, Session } from "../net/protocol";
import type { SavedPage } from "./saved_page";

const KEEP_MS = 400;

export interface ArrangementServices {
  navigation: Navigation;
  sizes: PaneSizes;
  keep(modality: string, state: SavedArrangement): void;
}

/** Has the layout and the panes' sizes kept for later images of the modality, when the user has changed them. */
export class ArrangementKeeper {
  private modality: string | null = null;
  private kept = "";
  private timer = 0;

  constructor(private readonly services: ArrangementServices) {}

  /** A project has its own; a new one begins with what its modality had last. */
  start({ arrangement }: Session, page: SavedPage | null): void {
    this.services.sizes.restore(page ? page.sizes : arrangement.state?.sizes);
    this.modality = arrangement.modality;
    this.kept = JSON.stringify(this.state());
  }

  keepSoon(): void {
    if (this.modality === null) return;
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.keep(), KEEP_MS);
  }

  private keep(): void {
    const state = this.state();
    const text = JSON.stringify(state);
    if (text === this.kept || this.modality === null) return;
    this.kept = text;
    this.services.keep(this.modality, state);
  }

  private state(): SavedArrangement {
    const { navigation, sizes } = this.services;
    // In the overview "big" is the pane that one works in just now.
    return { layout: navigation.layout, ...(navigation.layout !== "overview" && { big: navigation.big }), sizes: sizes.saved() };
  }
}
