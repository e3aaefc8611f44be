// SPDX-License-Identifier: Apache-2.0
import { gap, type Point2 } from "../geometry/screen";
import type { Project } from "../model/project";
import { Latest } from "../net/latest";
import type { Arguments, Edit, EditName } from "../net/calls";
import { DRAG_PIXELS, type Gesture } from "./gesture";
import type { EditorServices } from "./services";

/** Edits that the surface follows while the hand is at them, and that are not made before it lets go. */
export class Drafts {
  private readonly edits = new Latest<Edit>((edit) => this.ask(edit));

  constructor(
    private readonly project: Project,
    private readonly services: EditorServices,
  ) {}

  /** Drags something: what `editAt` a place would do is shown on the way, and done by `make` where the pointer lets go. */
  drag(start: Point2, editAt: (pointer: Point2) => Edit, make: (edit: Edit) => void): Gesture {
    let isDrag = false;
    return {
      move: (at) => {
        isDrag ||= gap(at, start) > DRAG_PIXELS;
        if (isDrag) this.send(editAt(at));
      },
      end: (at) => {
        this.drop();
        if (isDrag && this.isThere(editAt(at))) make(editAt(at));
      },
      cancel: () => this.giveUp(),
    };
  }

  send(edit: Edit): void {
    this.edits.send(edit);
  }

  /** What waits is not sent any more: the edit itself follows. */
  drop(): void {
    this.edits.drop();
  }

  /** No edit follows: all is as it was. */
  giveUp(): void {
    this.drop();
    void this.edits.idle().then(() => {
      this.project.draft = null;
      this.services.call("draft.drop", {}).catch(this.services.failed);
    });
  }

  /** Whether what it edits has not been removed under the hand, by a key or another page. */
  private isThere({ args }: Edit): boolean {
    return !("id" in args) || this.project.contours.has(args.id);
  }

  private async ask<Name extends EditName>({ name, args }: { name: Name; args: Arguments<Name> }): Promise<void> {
    try {
      const { contour, carried } = await this.services.call(name, { ...args, draft: true });
      this.project.setDraft(contour, carried);
    } catch (error) {
      if (this.isThere({ name, args } as Edit)) this.services.failed(error);
    }
  }
}
