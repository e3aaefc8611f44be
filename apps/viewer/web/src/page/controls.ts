// SPDX-License-Identifier: Apache-2.0
import type { Session } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { DifferenceCard } from "../ui/difference_card";
import { Dividers } from "../ui/dividers";
import { IdentityCard } from "../ui/identity";
import { Keyboard } from "../ui/keyboard";
import { NearDrawings } from "../ui/near_drawings";
import { Panel } from "../ui/panel";
import { SecondImageCard } from "../ui/second_image_card";
import { TimeStrip } from "../ui/time_strip";
import { Toolbar } from "../ui/toolbar";
import { PageActions } from "./actions";
import { Hints } from "./hints";
import type { Keepers } from "./keepers";
import type { Models } from "./models";
import type { Server } from "./server";
import type { Stage } from "./stage";

export interface ControlsServices {
  models: Models;
  server: Server;
  editor: Editor;
  stage: Stage;
  keepers: Keepers;
  session(): Session | null;
}

/** Toolbar, panel and keyboard, what they ask for, and what is told of drawing. */
export class Controls {
  readonly actions: PageActions;
  readonly hints: Hints;
  readonly toolbar: Toolbar;
  readonly panel: Panel;
  readonly keyboard: Keyboard;
  readonly timeStrip: TimeStrip;
  readonly near: NearDrawings;
  readonly identity = new IdentityCard();
  readonly secondCard: SecondImageCard;
  readonly differences: DifferenceCard;

  constructor(private readonly services: ControlsServices) {
    const { models, server, stage, keepers } = services;
    this.near = new NearDrawings({ http: server.http, project: models.project, import: (drawing) => this.actions.importNear(drawing) });
    this.differences = new DifferenceCard({ ...this.shared(), goTo: (p) => stage.panes.goTo(p), tell: (text) => void server.notices.show("info", text) });
    this.actions = new PageActions({
      ...this.shared(),
      goThroughDifferences: (first, second) => void this.differences.start(first, second),
      near: () => this.near.found,
      cancelPointers: stage.cancelPointers,
      rename: (structure) => this.panel.rename(structure),
      leaveHint: () => this.hints.leaveFirst(),
    });
    this.hints = new Hints({ ...this.shared(), stage: stage.panes.element, undo: this.actions.undo, seen: () => keepers.page.saveSoon() });
    this.secondCard = new SecondImageCard(models.second, () => keepers.furtherImage.remove());
    this.toolbar = this.madeToolbar();
    this.panel = this.madePanel();
    this.keyboard = this.madeKeyboard();
    this.timeStrip = new TimeStrip({
      ...this.shared(),
      call: services.editor.make,
      proposeHere: this.inSight(() => void services.editor.proposals.here(stage.panes.active)),
    });
    new Dividers(stage.panes.element, models.sizes);
  }

  private shared() {
    const { models, server, editor, stage, keepers, session } = this.services;
    const { token, http, socket, status, notices, saving, failed } = server;
    const { surface, panes, cine } = stage;
    const { windows, page: keeper } = keepers;
    return { ...models, token, http, socket, status, notices, saving, failed, editor, surface, panes, cine, windows, keeper, session };
  }

  /** As keys that edit: nothing happens while another time is seen. */
  private inSight(act: () => void): () => void {
    return () => void (this.services.editor.isAnotherTime() || act());
  }

  private madeToolbar(): Toolbar {
    const { actions } = this;
    return new Toolbar({
      ...this.shared(),
      ...actions,
      undo: this.inSight(actions.undo),
      redo: this.inSight(actions.redo),
      addImage: () => this.services.keepers.furtherImage.add(),
    });
  }

  private madePanel(): Panel {
    const { editor, stage } = this.services;
    return new Panel({
      ...this.shared(),
      ...this.actions,
      points: editor.points,
      call: editor.make,
      ask: (name, args) => this.services.server.socket.call(name, args),
      identity: this.identity.element,
      near: this.near.element,
      secondImage: this.secondCard.element,
      differences: this.differences.element,
      suggest: this.inSight(() => void this.actions.suggest()),
      goTo: (p) => stage.panes.goTo(p),
      show: (contour) => stage.panes.show(contour),
      propose: (steps) => this.inSight(() => void editor.proposals.next(stage.panes.active, steps))(),
    });
  }

  private madeKeyboard(): Keyboard {
    const { actions } = this;
    const { stage, server, models } = this.services;
    return new Keyboard({
      ...this.shared(),
      ...actions,
      keyPointer: stage.keyPointer,
      focused: () => stage.panes.active,
      toggleSingle: (pane) => stage.panes.toggleSingle(pane),
      help: actions.openHelp,
      suggest: () => void actions.suggest(),
      nextDifference: (by) => void this.differences.step(by),
      rename: () => this.panel.rename(models.project.activeStructure?.id),
      tell: (text) => void server.notices.show("info", text),
    });
  }
}
