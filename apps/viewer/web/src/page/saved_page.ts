// SPDX-License-Identifier: Apache-2.0
import type { Appearance, SavedAppearance } from "../model/appearance";
import type { Measurement } from "../model/measurements";
import type { Navigation, SavedNavigation } from "../model/navigation";
import type { Opacities } from "../model/opacities";
import type { PaneSizes, SavedSizes } from "../model/pane_sizes";
import type { Project } from "../model/project";
import type { SavedSecondImage, SecondImage } from "../model/second_image";
import type { Editor } from "../tools/editor";
import type { SavedSketch } from "../tools/sketch";

const SAVE_PAGE_MS = 400;
const LONGEST_SAVED_SKETCHES = 56_000; // characters: the server keeps 64 KiB for a page

/** What the server keeps for the page: where one looks, and what is drawn but not saved. */
export interface SavedPage {
  navigation: SavedNavigation;
  structure: number;
  hintSeen: boolean;
  appearance?: SavedAppearance;
  sizes?: SavedSizes;
  opacities?: Record<string, number>;
  measurements?: Measurement[];
  second?: SavedSecondImage;
  sketch?: SavedSketch;
  unsaved?: SavedSketch[]; // what was finished, and the server had not taken yet
}

export interface SavedPageServices {
  navigation: Navigation;
  project: Project;
  appearance: Appearance;
  sizes: PaneSizes;
  opacities: Opacities;
  second: SecondImage;
  editor: Editor;
  isOpen(): boolean;
  hintSeen(): boolean;
  save(state: SavedPage): void;
}

/** Saves the page's own state a moment after it has changed. */
export class PageKeeper {
  private timer = 0;

  constructor(private readonly services: SavedPageServices) {}

  saveSoon(): void {
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.save(), SAVE_PAGE_MS);
  }

  /** What was to be saved soon. */
  saveNow(): void {
    if (this.timer !== 0) this.save();
  }

  private save(): void {
    if (!this.services.isOpen()) return;
    window.clearTimeout(this.timer);
    this.timer = 0;
    this.services.save(this.state());
  }

  /** What of it an opened page takes up again; all but where it looks. */
  restore(page: SavedPage | null): void {
    const { project, appearance, opacities, editor } = this.services;
    if (page?.opacities) opacities.restore(page.opacities);
    if (page?.appearance) appearance.set(page.appearance);
    if (page?.measurements) editor.measuring.measurements.restore(page.measurements);
    if (page?.structure) project.activate(page.structure);
    editor.drawing.outbox.restore(page?.sketch, page?.unsaved ?? []);
  }

  private state(): SavedPage {
    const { navigation, project, appearance, sizes, opacities, editor } = this.services;
    const { drawing, measuring } = editor;
    const state: SavedPage = {
      navigation: navigation.saved(),
      structure: project.activeStructure?.id ?? 0,
      hintSeen: this.services.hintSeen(),
      appearance: appearance.saved(),
      sizes: sizes.saved(),
      opacities: opacities.saved(),
      measurements: measuring.measurements.saved(),
    };
    const second = this.services.second.saved();
    if (second) state.second = second;
    let room = LONGEST_SAVED_SKETCHES;
    const fits = (sketch: SavedSketch): boolean => (room -= JSON.stringify(sketch).length) > 0;
    const sketch = drawing.sketch?.saved();
    if (sketch && fits(sketch)) state.sketch = sketch;
    const unsaved = drawing.outbox.saved().filter(fits);
    if (unsaved.length > 0) state.unsaved = unsaved;
    return state;
  }
}
