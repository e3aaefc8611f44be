// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "./geometry/vec";
import { Appearance } from "./model/appearance";
import { Navigation } from "./model/navigation";
import { PaneSizes } from "./model/pane_sizes";
import { Project } from "./model/project";
import { SecondImage } from "./model/second_image";
import type { Theme } from "./model/theme";
import { Http } from "./net/http";
import { VIEW_NAMES, type Outlines, type ServerEvent, type Session, type ViewName } from "./net/protocol";
import { Socket, type ConnectionState } from "./net/socket";
import { PageActions } from "./page/actions";
import { ArrangementKeeper } from "./page/arrangement";
import { Cine } from "./model/cine";
import { FurtherImageKeeper } from "./page/further_image";
import { acceptDrops, guardClosing } from "./page/guards";
import { Hints } from "./page/hints";
import { LinkedWindows } from "./page/linked_windows";
import { Panes } from "./page/panes";
import { PageKeeper, type SavedPage } from "./page/saved_page";
import { Saving } from "./page/saving";
import { ValueAtPointer } from "./page/value_at_pointer";
import { StartPage } from "./start/start_page";
import { SurfaceView } from "./three/surface_view";
import { Editor } from "./tools/editor";
import { KeyPointer } from "./tools/key_pointer";
import { Pointers } from "./tools/pointers";
import { ViewInput } from "./tools/view_input";
import { Dividers } from "./ui/dividers";
import { IdentityCard } from "./ui/identity";
import { Keyboard } from "./ui/keyboard";
import { NearDrawings } from "./ui/near_drawings";
import { Panel } from "./ui/panel";
import { SecondImageCard } from "./ui/second_image_card";
import { Notices, StatusBar } from "./ui/status";
import { TimeCard } from "./ui/time_card";
import { Toolbar } from "./ui/toolbar";
import { SliceView } from "./view/slice_view";

const PEN_DRAWS = "A pen draws here, so touches are taken for the hand that holds it, and ignored. To draw with a finger, load the page again.";

/** Puts the parts of the page together, and hands the server's events to them. */
export class App {
  private session: Session | null = null;
  private readonly navigation = new Navigation();
  private readonly project = new Project();
  private readonly appearance = new Appearance();
  private readonly sizes = new PaneSizes();
  private readonly second = new SecondImage();
  private readonly http: Http;
  private readonly socket: Socket;
  private readonly status = new StatusBar();
  private readonly notices = new Notices();
  private readonly pointers = new Pointers(() => void this.notices.show("info", PEN_DRAWS));
  private readonly near: NearDrawings;
  private readonly startPage: StartPage;
  private readonly saving: Saving;
  private readonly editor: Editor;
  private readonly keeper: PageKeeper;
  private readonly arrangement: ArrangementKeeper;
  private readonly windows = new LinkedWindows(this.navigation);
  private readonly views = new Map<ViewName, SliceView>();
  private readonly cine = new Cine(this.navigation, () => Promise.all([...this.views.values()].map((view) => view.idle())));
  private readonly surface: SurfaceView;
  private readonly panes: Panes;
  private readonly hints: Hints;
  private readonly value: ValueAtPointer;
  private readonly furtherImage: FurtherImageKeeper;
  private readonly identity = new IdentityCard();
  private readonly secondCard = new SecondImageCard(this.second, () => this.furtherImage.remove());
  private readonly actions: PageActions;
  private readonly toolbar: Toolbar;
  private readonly keyboard: Keyboard;
  private readonly inputs: ViewInput[] = [];
  private readonly keyPointer: KeyPointer;

  constructor(
    token: string,
    private readonly theme: Theme,
  ) {
    this.http = new Http(token);
    this.startPage = new StartPage(this.http);
    this.saving = new Saving({
      status: this.status,
      notices: this.notices,
      outbox: () => this.editor.drawing.outbox,
      project: () => this.session?.project,
      token,
    });
    this.socket = new Socket(token, {
      event: (event) => this.receive(event),
      connection: (state) => this.connected(state),
      unsaved: (count, acknowledged) => this.saving.countUnsaved(count, acknowledged),
      knock: () => this.http.knock(),
    });
    this.near = new NearDrawings({ http: this.http, project: this.project, import: (drawing) => this.actions.importNear(drawing) });
    const failed = (error: unknown) => this.saving.failed(error);
    const screenOf = (view: ViewName) => this.views.get(view)?.screen() ?? null;
    this.editor = new Editor(this.navigation, this.project, {
      call: (name, args) => this.socket.call(name, args),
      screenOf,
      outlinesOf: (view) => this.views.get(view)?.shownOutlines() ?? null,
      failed,
      tell: (text, remedy) => void this.notices.show("info", text, remedy),
      made: (contour) => this.hints.tellCrossing(contour),
      notSaved: (sketch, why) => this.saving.tellNotSaved(sketch, why),
    });
    const shared = {
      token,
      navigation: this.navigation,
      project: this.project,
      appearance: this.appearance,
      theme: this.theme,
      sizes: this.sizes,
      second: this.second,
      editor: this.editor,
      http: this.http,
      socket: this.socket,
      status: this.status,
      notices: this.notices,
      saving: this.saving,
      windows: this.windows,
      cine: this.cine,
      session: () => this.session,
      goTo: (p: Vec3) => this.panes.goTo(p),
      failed,
    };
    this.keeper = new PageKeeper({
      ...shared,
      isOpen: () => this.session !== null && !this.windows.isSecond,
      hintSeen: () => this.hints.isSeen,
      save: (state) => void this.socket.call("page.save", { state }).catch(() => undefined), // the next change saves again
    });
    this.arrangement = new ArrangementKeeper({
      ...shared,
      keep: (modality, state) => void this.http.keepArrangement(modality, state).catch(() => undefined), // a convenience
    });
    for (const name of VIEW_NAMES) this.views.set(name, new SliceView(name, shared));
    this.surface = new SurfaceView({ ...shared, openWindow: () => this.actions.openWindow() });
    this.panes = new Panes(this.navigation, this.views, this.surface);
    this.actions = new PageActions({
      ...shared,
      surface: this.surface,
      panes: this.panes,
      keeper: this.keeper,
      near: () => this.near.found,
      cancelPointers: () => [...this.inputs, this.surface, this.keyPointer].some((input) => input.cancel()),
    });
    this.hints = new Hints({ ...shared, stage: this.panes.element, undo: this.actions.undo, seen: () => this.keeper.saveSoon() });
    this.value = new ValueAtPointer(shared);
    this.keyPointer = new KeyPointer({
      ...shared,
      screenOf,
      elementOf: (view) => this.views.get(view)?.element ?? null,
      pointed: (at) => this.tellValue(at),
    });
    this.furtherImage = new FurtherImageKeeper(shared);
    const { actions, panes } = this;
    const inSight = (act: () => void) => () => void (this.editor.isAnotherTime() || act()); // as keys that edit
    this.toolbar = new Toolbar({ ...shared, ...actions, undo: inSight(actions.undo), redo: inSight(actions.redo), addImage: () => this.furtherImage.add() });
    const panel = new Panel({
      ...shared,
      ...actions,
      points: this.editor.points,
      call: this.editor.make,
      identity: this.identity.element,
      near: this.near.element,
      time: new TimeCard(this.navigation, this.cine).element,
      secondImage: this.secondCard.element,
      suggest: inSight(() => void actions.suggest()),
      show: (contour) => panes.show(contour),
      propose: (steps) => inSight(() => void this.editor.proposals.next(panes.active, steps))(),
    });
    this.keyboard = new Keyboard({
      ...shared,
      ...actions,
      keyPointer: this.keyPointer,
      focused: () => panes.active,
      toggleSingle: (pane) => panes.toggleSingle(pane),
      help: actions.openHelp,
      suggest: () => void actions.suggest(),
      rename: () => panel.rename(this.project.activeStructure?.id),
      tell: (text) => void this.notices.show("info", text),
    });
    panes.element.append(this.notices.element);
    document.body.append(this.toolbar.element, panes.element, panel.element, this.status.element, this.startPage.element);
    new Dividers(panes.element, this.sizes);
    this.connectParts();
    this.connectViews();
    acceptDrops(actions.importFile);
    guardClosing(
      () => this.isLostByLeaving(),
      () => this.keeper.saveNow(),
    );
  }

  start(): void {
    this.socket.open();
  }

  private connectParts(): void {
    const { navigation, project, editor } = this;
    const each = (act: (view: SliceView) => void) => () => this.views.forEach(act);
    const paint = each((view) => view.paint());
    const refresh = each((view) => view.refresh(true));
    const contoursChanged = each((view) => view.contoursChanged());
    const surfacesChanged = each((view) => view.surfacesChanged());
    const draftChanged = each((view) => view.draftChanged());
    const secondChanged = each((view) => view.secondChanged());
    const tellHint = () => this.hints.tell();
    const saveSoon = () => this.keeper.saveSoon();
    navigation.on(["planes", "window"], refresh);
    navigation.on(["time"], refresh);
    navigation.on(["planes"], () => this.surface.planesChanged());
    navigation.on(["layout"], () => this.arrangement.keepSoon());
    navigation.on(["planes", "window", "layout"], saveSoon);
    this.sizes.on(["changed"], () => this.arrangement.keepSoon());
    this.sizes.on(["changed"], saveSoon);
    project.on(["contours", "structures"], contoursChanged);
    project.on(["surfaces"], surfacesChanged);
    project.on(["selection"], paint);
    project.on(["selection"], tellHint);
    project.on(["draft"], draftChanged);
    project.on(["contours"], () => this.hints.edited());
    project.on(["contours", "structures", "selection"], () => this.surface.contoursChanged());
    project.on(["structures"], () => this.surface.restyle());
    project.on(["structures"], saveSoon);
    project.on(["surfaces"], () => this.surface.surfacesChanged());
    this.appearance.on(["changed"], paint);
    this.appearance.on(["changed"], saveSoon);
    this.theme.on(["changed"], () => this.surface.themeChanged());
    this.second.on(["image", "shown", "look"], secondChanged);
    this.second.on(["shown", "look"], saveSoon);
    this.second.on(["image", "shown"], () => editor.drawing.setImage(this.second.front));
    editor.on(["tool", "hover"], paint);
    editor.on(["tool", "hover"], tellHint);
    editor.measuring.measurements.on(["changed"], paint);
    editor.measuring.measurements.on(["changed"], saveSoon);
    editor.points.on(["points"], paint);
    editor.points.on(["points"], () => this.surface.pointsChanged());
    editor.points.on(["points"], tellHint);
    editor.drawing.on(["sketch"], paint);
    editor.drawing.on(["sketch"], tellHint);
    editor.drawing.on(["points"], saveSoon);
    editor.drawing.on(["points"], () => this.saving.tell());
    editor.proposals.on(["proposal"], paint);
    editor.proposals.on(["proposal"], tellHint);
  }

  private connectViews(): void {
    for (const [name, view] of this.views) {
      this.inputs.push(
        new ViewInput(view, {
          navigation: this.navigation,
          editor: this.editor,
          pointers: this.pointers,
          isPanning: () => this.keyboard.isPanning,
          windowed: (isShifted) => (this.second.info && (this.second.isAlone || isShifted) ? this.second : this.navigation),
          pointed: (_, event) => this.pointed(view, event),
          jump: (_, event) => this.jump(view, event),
          hint: (text) => this.hints.tell(text),
        }),
      );
      const activate = (event: PointerEvent) => {
        if (!this.pointers.ignores(event)) this.panes.activate(name);
      };
      view.element.addEventListener("pointerdown", activate, { capture: true });
      view.element.addEventListener("focusin", () => this.panes.activate(name)); // keys are for the view that the keyboard is in
    }
  }

  private jump(view: SliceView, event: PointerEvent): void {
    const at = view.worldAt(event);
    if (at) this.panes.goTo(at);
  }

  private pointed(view: SliceView, event: PointerEvent): void {
    this.keyPointer.hide();
    const at = view.worldAt(event);
    if (at) this.tellValue(at);
  }

  private tellValue(at: Vec3): void {
    if (this.saving.connection === "open") this.value.tell(at);
  }

  private isLostByLeaving(): boolean {
    const isSketchKept = this.saving.connection === "open" && !this.windows.isSecond;
    return !this.saving.isDone || (this.editor.drawing.sketch !== null && !isSketchKept);
  }

  // Server

  private connected(state: ConnectionState): void {
    if (state === "lost") this.status.setWork("", null); // nobody tells any more when it is done
    this.saving.connected(state);
    this.startPage.connected(state);
  }

  private receive(event: ServerEvent): void {
    switch (event.event) {
      case "start":
        return this.session ? location.reload() : this.startPage.show(event);
      case "opening":
        return this.startPage.setOpening(event);
      case "failed":
        return this.startPage.failed(event.error);
      case "opened":
        return this.socket.reopen();
      case "closed":
        return location.reload();
      case "session":
        return this.begin(event);
      case "images":
        return this.furtherImage.show(event.images);
      case "changed":
        return this.project.apply(event);
      case "surface":
        return this.project.setSurface(event);
      case "borders":
        return this.project.setBorderPairs(event.pairs);
      case "outlines":
        return this.showOutlines(event);
      case "status":
        this.startPage.setWork(event.text, event.fraction);
        this.furtherImage.setWork(event.text, event.fraction);
        return this.status.setWork(event.text, event.fraction);
      case "notice":
        return void this.notices.show(event.level, event.text);
    }
  }

  private showOutlines({ structure, revision, views }: Outlines): void {
    for (const { view, plane, lines, without_image } of views) this.views.get(view as ViewName)?.showOutlines(structure, revision, plane, lines, without_image);
  }

  private begin(session: Session): void {
    // Of another session nothing of this page is right, and nothing of it may be taken for an edit there.
    if (this.session && this.session.opening !== session.opening && this.session.project !== session.project) return location.reload();
    const isFirst = this.session === null;
    this.startPage.hide();
    this.http.opening = session.opening;
    this.session = session;
    const page = session.page as SavedPage | null;
    document.title = `${session.title} · kontur`;
    this.status.start(session.project, session.read_only);
    this.saving.tell();
    this.identity.start(session);
    this.secondCard.start(session);
    this.second.set(session.images[0] ?? null, page?.second ?? null);
    this.toolbar.start(session);
    // After a reconnect the user stays where he is.
    this.navigation.start(session, isFirst ? (page?.navigation ?? null) : this.navigation.saved());
    this.views.forEach((view) => view.showTitle());
    if (isFirst) this.panes.begin(session.first_view);
    this.views.forEach((view) => view.forgetOutlines());
    this.surface.forgetRevisions();
    this.project.start(session);
    if (isFirst) this.restore(session, page);
    if (isFirst) this.near.start(session);
    this.windows.start(session.project);
    void this.surface.start(session.image);
    for (const note of isFirst ? session.image.notes : []) this.notices.show("warning", note);
    this.hints.isSeen ||= page?.hintSeen ?? false;
    if (session.contours.length === 0) this.hints.showFirst();
    this.hints.tell();
    document.body.dataset["ready"] = "true";
  }

  private restore(session: Session, page: SavedPage | null): void {
    if (!this.windows.isSecond) {
      this.keeper.restore(page);
      return this.arrangement.start(session, page);
    }
    const { sketch, unsaved, ...others } = page ?? ({} as Partial<SavedPage>); // what is half drawn is the first window's
    this.keeper.restore(others as SavedPage);
    this.navigation.setLayout("single", "surface");
  }
}
