// SPDX-License-Identifier: Apache-2.0
import type { Contour } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { firstHint } from "../ui/dialogs";
import { hintFor } from "../ui/hints";
import type { Notices, StatusBar } from "../ui/status";

export interface HintServices {
  editor: Editor;
  status: StatusBar;
  notices: Notices;
  /** Where the first one is put. */
  stage: HTMLElement;
  undo(): void;
  seen(): void;
}

/** What the user is told of drawing: what can be done next, how to begin, and that a contour crosses itself. */
export class Hints {
  /** The first one is for those who have never drawn here. */
  isSeen = false;
  private closeCrossing = () => {};

  constructor(private readonly services: HintServices) {}

  /** In the status line; `text`: of what the pointer does just now. */
  tell(text: string | null = null): void {
    this.services.status.setHint(text ?? hintFor(this.services.editor));
  }

  showFirst(): void {
    const { editor, stage } = this.services;
    if (this.isSeen || stage.querySelector(".first-hint")) return;
    const hint = firstHint(() => {
      this.leaveFirst();
      editor.choose("wire");
    });
    stage.append(hint);
    hint.querySelector("button")?.focus({ preventScroll: true });
  }

  /** Takes the first one away; false where there is none. */
  leaveFirst(): boolean {
    const hint = this.services.stage.querySelector(".first-hint");
    if (!hint) return false;
    hint.remove();
    this.isSeen = true;
    this.services.seen();
    return true;
  }

  /** Said until the next edit, as long as undo takes back this one. */
  tellCrossing(contour: Contour): void {
    if (contour.self_crossings.length === 0) return;
    const where = contour.self_crossings.length === 1 ? "at the ringed place" : `at ${contour.self_crossings.length} ringed places`;
    const text = `This contour crosses itself ${where}: what is inside of it is not clear there, and the surface may leave the line.`;
    this.closeCrossing = this.services.notices.show("warning", text, { label: "Take it back", act: () => this.services.undo() });
  }

  edited(): void {
    this.closeCrossing();
    this.services.stage.querySelector(".first-hint")?.remove(); // whoever edits, or imports, has begun
  }
}
