// SPDX-License-Identifier: Apache-2.0
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { Drafts } from "./drafts";
import type { Drawing } from "./drawing";
import type { EditorServices } from "./services";

/** What changes contours, by gestures and by commands, works with these. */
export abstract class Edits {
  constructor(
    protected readonly navigation: Navigation,
    protected readonly project: Project,
    protected readonly drawing: Drawing,
    protected readonly drafts: Drafts,
    protected readonly services: EditorServices,
  ) {}
}
