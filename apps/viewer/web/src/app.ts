// SPDX-License-Identifier: Apache-2.0
import type { Theme } from "./model/theme";
import type { Outlines, ServerEvent, Session, ViewName } from "./net/protocol";
import type { ConnectionState } from "./net/socket";
import { BackToStart } from "./page/back";
import { Controls } from "./page/controls";
import { acceptDrops, guardClosing } from "./page/guards";
import { Keepers } from "./page/keepers";
import { Models } from "./page/models";
import type { SavedPage } from "./page/saved_page";
import { Server } from "./page/server";
import { Stage } from "./page/stage";
import { connectUpdates } from "./page/updates";
import { StartPage } from "./start/start_page";
import { Editor } from "./tools/editor";
import { offerWaiting } from "./ui/sending";

/** Puts the parts of the page together, and hands the server's events to them. */
export class App {
  private session: Session | null = null;
  // Each part is made of those above it. What one needs of a part below it is a function, which is called later.
  private readonly models: Models;
  private readonly server: Server;
  private readonly startPage: StartPage;
  private readonly editor: Editor;
  private readonly keepers: Keepers;
  private readonly stage: Stage;
  private readonly controls: Controls;
  private readonly back = new BackToStart(() => this.controls.actions.leaveForStart());

  constructor(token: string, theme: Theme) {
    const session = () => this.session;
    this.models = new Models(theme);
    this.server = new Server(token, {
      receive: (event) => this.receive(event),
      connection: (state) => this.connected(state),
      outbox: () => this.editor.drawing.outbox,
      session,
    });
    this.startPage = new StartPage(this.server.http);
    this.editor = this.madeEditor();
    const { models, server, editor } = this;
    this.keepers = new Keepers({ models, server, editor, session, hintSeen: () => this.controls.hints.isSeen });
    this.stage = new Stage({
      models,
      server,
      editor,
      session,
      openWindow: () => this.controls.actions.openWindow(),
      isPanning: () => this.controls.keyboard.isPanning,
      hint: (text) => this.controls.hints.tell(text),
    });
    const { keepers, stage } = this;
    this.controls = new Controls({ models, server, editor, stage, keepers, session });
    this.lay();
    connectUpdates({ models, server, editor, stage, keepers, hints: this.controls.hints });
    acceptDrops(this.controls.actions.importFile);
    guardClosing(
      () => this.isLostByLeaving(),
      () => keepers.page.saveNow(),
    );
  }

  start(): void {
    this.server.socket.open();
  }

  private madeEditor(): Editor {
    const { models, server } = this;
    return new Editor(models.navigation, models.project, {
      call: (name, args) => server.socket.call(name, args),
      screenOf: (view) => this.stage.screenOf(view),
      outlinesOf: (view) => this.stage.views.get(view)?.shownOutlines() ?? null,
      failed: server.failed,
      tell: (text, remedy) => void server.notices.show("info", text, remedy),
      made: (contour) => this.controls.hints.tellCrossing(contour),
      notSaved: (sketch, why) => server.saving.tellNotSaved(sketch, why),
    });
  }

  private lay(): void {
    const { toolbar, panel, timeStrip } = this.controls;
    const stage = this.stage.panes.element;
    stage.append(this.server.notices.element);
    document.body.append(toolbar.element, stage, timeStrip.element, panel.element, this.server.status.element, this.startPage.element);
  }

  private isLostByLeaving(): boolean {
    const isSketchKept = this.server.saving.connection === "open" && !this.keepers.windows.isSecond;
    return !this.server.saving.isDone || (this.editor.drawing.sketch !== null && !isSketchKept);
  }

  private connected(state: ConnectionState): void {
    if (state === "lost") this.server.status.setWork("", null); // nobody tells any more when it is done
    this.server.saving.connected(state);
    this.startPage.connected(state);
  }

  private receive(event: ServerEvent): void {
    const { project } = this.models;
    switch (event.event) {
      case "start":
        return this.session ? location.reload() : this.startPage.show(event);
      case "opening":
        return this.startPage.setOpening(event);
      case "failed":
        return this.startPage.failed(event.error);
      case "opened":
        return this.server.socket.reopen();
      case "closed":
        return location.reload();
      case "session":
        return this.begin(event);
      case "images":
        return this.keepers.furtherImage.show(event.images);
      case "changed":
        return project.apply(event);
      case "surface":
        return project.setSurface(event);
      case "motion":
        return project.setMotion(event);
      case "borders":
        return project.setBorderPairs(event.pairs);
      case "outlines":
        return this.showOutlines(event);
      case "status":
        this.startPage.setWork(event.text, event.fraction);
        this.keepers.furtherImage.setWork(event.text, event.fraction);
        return this.server.status.setWork(event.text, event.fraction);
      case "notice":
        return void this.server.notices.show(event.level, event.text);
    }
  }

  private showOutlines({ structure, revision, views, time }: Outlines): void {
    if (time !== undefined && time !== this.models.navigation.time) return; // of what moves, and of another time
    for (const { view, plane, lines, without_image } of views)
      this.stage.views.get(view as ViewName)?.showOutlines(structure, revision, plane, lines, without_image);
  }

  private begin(session: Session): void {
    // Of another session nothing of this page is right, and nothing of it may be taken for an edit there.
    if (this.session && this.session.opening !== session.opening && this.session.project !== session.project) return location.reload();
    const isFirst = this.session === null;
    const page = session.page as SavedPage | null;
    this.startPage.hide();
    this.server.http.opening = session.opening;
    this.session = session;
    document.title = `${session.title} · kontur`;
    this.beginCards(session, page);
    this.beginViews(session, isFirst, page);
    if (isFirst) this.keepers.restore(session, page);
    if (isFirst) this.controls.near.start(session);
    this.keepers.windows.start(session.project);
    void this.stage.surface.start(session.image);
    for (const note of isFirst ? session.image.notes : []) this.server.notices.show("warning", note);
    this.beginHints(session, page);
    if (isFirst && session.archive !== undefined) void offerWaiting(this.server.http, session.archive, this.server.notices);
    if (session.can_close && !this.keepers.windows.isSecond) this.back.start();
    document.body.dataset["ready"] = "true";
  }

  private beginCards(session: Session, page: SavedPage | null): void {
    const { status, saving } = this.server;
    const { identity, secondCard, toolbar } = this.controls;
    status.start(session.project, session.project_path, session.read_only);
    saving.tell();
    identity.start(session);
    secondCard.start(session);
    this.models.second.set(session.images[0] ?? null, page?.second ?? null);
    toolbar.start(session);
  }

  private beginViews(session: Session, isFirst: boolean, page: SavedPage | null): void {
    const { navigation, project } = this.models;
    const { views, surface, panes } = this.stage;
    // After a reconnect the user stays where he is.
    navigation.start(session, isFirst ? (page?.navigation ?? null) : navigation.saved());
    views.forEach((view) => view.showTitle());
    if (isFirst) panes.begin(session.first_view);
    views.forEach((view) => view.forgetOutlines());
    surface.forgetRevisions();
    project.start(session);
  }

  private beginHints(session: Session, page: SavedPage | null): void {
    const { hints } = this.controls;
    hints.isSeen ||= page?.hintSeen ?? false;
    if (session.contours.length === 0) hints.showFirst();
    hints.tell();
  }
}
