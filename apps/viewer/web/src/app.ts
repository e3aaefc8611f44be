// SPDX-License-Identifier: Apache-2.0
import { type Vec3 } from "./geometry/vec";
import type { Screen } from "./geometry/screen";
import { Appearance } from "./model/appearance";
import { Navigation, type PaneName } from "./model/navigation";
import { PaneSizes } from "./model/pane_sizes";
import { Project } from "./model/project";
import { SecondImage } from "./model/second_image";
import type { Theme } from "./model/theme";
import { Http } from "./net/http";
import { Latest } from "./net/latest";
import { VIEW_NAMES, type Contour, type FurtherImage, type Outlines, type ServerEvent, type Session, type ViewName } from "./net/protocol";
import { Socket, type ConnectionState } from "./net/socket";
import { ArrangementKeeper } from "./page/arrangement";
import { AddImageDialog } from "./start/add_image";
import { Cine } from "./page/cine";
import { LinkedWindows } from "./page/linked_windows";
import { PageKeeper, type SavedPage } from "./page/saved_page";
import { Saving } from "./page/saving";
import { StartPage } from "./start/start_page";
import { SurfaceView } from "./three/surface_view";
import { Editor } from "./tools/editor";
import { Pointers } from "./tools/pointers";
import { ViewInput } from "./tools/view_input";
import type { InPlane } from "./ui/contour_names";
import { Keyboard } from "./ui/keyboard";
import { hintFor } from "./ui/hints";
import { el } from "./ui/dom";
import { firstHint, openExport } from "./ui/dialogs";
import { Dividers } from "./ui/dividers";
import { openHelp } from "./ui/help";
import { IdentityCard } from "./ui/identity";
import { importFile, openImport } from "./ui/imports";
import { crosshairOnto, Panel, viewAlong } from "./ui/panel";
import { SecondImageCard } from "./ui/second_image_card";
import { TimeCard } from "./ui/time_card";
import { openStatistics } from "./ui/statistics";
import { Notices, StatusBar } from "./ui/status";
import { Toolbar } from "./ui/toolbar";
import { placeText, valuesText } from "./ui/values";
import { SliceView } from "./view/slice_view";

/** Puts the parts of the page together, and hands the server's events to them. */
export class App {
  private readonly navigation = new Navigation();
  private readonly project = new Project();
  private readonly appearance = new Appearance();
  private readonly sizes = new PaneSizes();
  private readonly second = new SecondImage();
  private readonly views = new Map<ViewName, SliceView>();
  private readonly cine = new Cine(this.navigation, () => Promise.all([...this.views.values()].map((view) => view.idle())));
  private readonly editor: Editor;
  private active: ViewName = "axial";
  private readonly http: Http;
  private readonly socket: Socket;
  private readonly status = new StatusBar();
  private readonly notices = new Notices();
  private readonly identity = new IdentityCard();
  private readonly secondCard = new SecondImageCard(this.second, () => this.removeImage());
  private addImageDialog: AddImageDialog | null = null;
  private readonly stage = el("main", { class: "stage" });
  private readonly startPage: StartPage;
  private readonly surface: SurfaceView;
  private readonly toolbar: Toolbar;
  private readonly keyboard: Keyboard;
  private readonly inputs: ViewInput[] = [];
  private readonly pointers = new Pointers(
    () =>
      void this.notices.show(
        "info",
        "A pen draws here, so touches are taken for the hand that holds it, and ignored. To draw with a finger, load the page again.",
      ),
  );
  private readonly values: Latest<Vec3>;
  private session: Session | null = null;
  private closeCrossingNotice = () => {};
  private hintSeen = false;
  private readonly saving: Saving;
  private readonly keeper: PageKeeper;
  private readonly arrangement: ArrangementKeeper;
  private readonly windows = new LinkedWindows(this.navigation);

  constructor(
    private readonly token: string,
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
    const failed = (error: unknown) => this.saving.failed(error);
    this.editor = new Editor(this.navigation, this.project, {
      call: (name, args) => this.socket.call(name, args),
      screenOf: (view) => this.views.get(view)?.screen() ?? null,
      outlinesOf: (view) => this.views.get(view)?.shownOutlines() ?? null,
      failed,
      tell: (text, remedy) => void this.notices.show("info", text, remedy),
      made: (contour) => this.tellCrossing(contour),
      notSaved: (sketch, why) => this.saving.tellNotSaved(sketch, why),
    });
    const shared = {
      navigation: this.navigation,
      project: this.project,
      appearance: this.appearance,
      theme: this.theme,
      sizes: this.sizes,
      second: this.second,
      editor: this.editor,
      http: this.http,
      failed,
    };
    this.keeper = new PageKeeper({
      ...shared,
      isOpen: () => this.session !== null && !this.windows.isSecond,
      hintSeen: () => this.hintSeen,
      save: (state) => void this.socket.call("page.save", { state }).catch(() => undefined), // the next change saves again
    });
    this.arrangement = new ArrangementKeeper({
      ...shared,
      keep: (modality, state) => void this.http.keepArrangement(modality, state).catch(() => undefined), // a convenience
    });
    for (const name of VIEW_NAMES) this.views.set(name, new SliceView(name, shared));
    this.surface = new SurfaceView({ ...shared, goTo: (p) => this.goTo(p), openWindow: () => this.openWindow() });
    this.values = new Latest((p) => this.askValue(p));
    const inSight = (act: () => void) => () => void (this.editor.isAnotherTime() || act()); // as keys that edit
    this.toolbar = new Toolbar({
      ...shared,
      undo: inSight(() => this.undo()),
      redo: inSight(() => this.redo()),
      openAnother: () => void this.openAnother(),
      addImage: () => this.addImage(),
      openExport: () => openExport({ ...shared, hasDicom: () => this.session?.has_dicom ?? false }),
      openImport: () => openImport(this.importServices()),
      openHelp: () => openHelp(this.session?.version ?? ""),
    });
    const panel = new Panel({
      ...shared,
      points: this.editor.points,
      call: this.editor.make,
      identity: this.identity.element,
      time: new TimeCard(this.navigation, this.cine).element,
      secondImage: this.secondCard.element,
      suggest: inSight(() => void this.suggest()),
      openStatistics: () =>
        openStatistics(
          this.http,
          (p) => this.goTo(p),
          (first, second) => this.surface.compare(first, second),
        ),
      addStructure: () => void this.addStructure(),
      goTo: (p) => this.goTo(p),
      show: (contour) => this.show(contour),
      propose: (steps) => inSight(() => void this.editor.proposals.next(this.active, steps))(),
    });
    this.keyboard = new Keyboard({
      ...shared,
      cine: this.cine,
      focused: () => this.active,
      toggleSingle: (pane) => this.toggleSingle(pane),
      undo: () => this.undo(),
      redo: () => this.redo(),
      help: () => openHelp(this.session?.version ?? ""),
      leave: () => this.leave(),
      suggest: () => void this.suggest(),
      rename: () => panel.rename(this.project.activeStructure?.id),
      tell: (text) => void this.notices.show("info", text),
    });
    this.stage.append(...[...this.views.values()].map((view) => view.element), this.surface.element, this.notices.element);
    document.body.append(this.toolbar.element, this.stage, panel.element, this.status.element, this.startPage.element);
    new Dividers(this.stage, this.sizes);
    this.connectParts();
    this.acceptDrops();
    this.guardClosing();
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
    navigation.on(["planes", "window"], refresh);
    navigation.on(["time"], refresh);
    navigation.on(["planes"], () => this.surface.planesChanged());
    navigation.on(["layout"], () => this.lay());
    navigation.on(["layout"], () => this.arrangement.keepSoon());
    this.sizes.on(["changed"], () => this.arrangement.keepSoon());
    this.sizes.on(["changed"], () => this.keeper.saveSoon());
    navigation.on(["planes", "window", "layout"], () => this.keeper.saveSoon());
    project.on(["contours", "structures"], contoursChanged);
    project.on(["surfaces"], surfacesChanged);
    project.on(["selection"], paint);
    project.on(["draft"], draftChanged);
    project.on(["contours", "structures", "selection"], () => this.surface.contoursChanged());
    project.on(["structures"], () => this.surface.restyle());
    project.on(["surfaces"], () => this.surface.surfacesChanged());
    project.on(["structures"], () => this.keeper.saveSoon());
    this.appearance.on(["changed"], paint);
    this.appearance.on(["changed"], () => this.keeper.saveSoon());
    this.theme.on(["changed"], () => this.surface.themeChanged());
    this.second.on(["image", "shown", "look"], secondChanged);
    this.second.on(["shown", "look"], () => this.keeper.saveSoon());
    this.second.on(["image", "shown"], () => editor.drawing.setImage(this.second.front));
    editor.on(["tool", "hover"], paint);
    editor.on(["tool", "hover"], () => this.tellHint());
    editor.measuring.measurements.on(["changed"], paint);
    editor.measuring.measurements.on(["changed"], () => this.keeper.saveSoon());
    editor.points.on(["points"], paint);
    editor.points.on(["points"], () => this.surface.pointsChanged());
    editor.points.on(["points"], () => this.tellHint());
    editor.drawing.on(["sketch"], paint);
    editor.drawing.on(["sketch"], () => this.tellHint());
    editor.proposals.on(["proposal"], paint);
    editor.proposals.on(["proposal"], () => this.tellHint());
    editor.drawing.on(["points"], () => this.keeper.saveSoon());
    editor.drawing.on(["points"], () => this.saving.tell());
    project.on(["selection"], () => this.tellHint());
    project.on(["contours"], () => this.closeCrossingNotice());
    for (const [name, view] of this.views) {
      this.inputs.push(
        new ViewInput(view, {
          navigation,
          editor,
          pointers: this.pointers,
          isPanning: () => this.keyboard.isPanning,
          windowed: (isShifted) => (this.second.info && (this.second.isAlone || isShifted) ? this.second : navigation),
          pointed: (_, event) => this.pointed(view, event),
          jump: (_, event) => this.jump(view, event),
          hint: (text) => (text === null ? this.tellHint() : this.status.setHint(text)),
        }),
      );
      const activate = (event: PointerEvent) => {
        if (!this.pointers.ignores(event)) this.activate(name);
      };
      view.element.addEventListener("pointerdown", activate, { capture: true });
      view.element.addEventListener("focusin", () => this.activate(name)); // keys are for the view that the keyboard is in
      view.header.addEventListener("dblclick", () => this.toggleSingle(name));
    }
    this.surface.header.addEventListener("dblclick", () => this.toggleSingle("surface"));
  }

  // Server

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
        return this.showImages(event.images);
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
        this.addImageDialog?.setWork(event.text, event.fraction);
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
    this.status.start(session.project);
    this.saving.tell();
    this.identity.start(session);
    this.secondCard.start(session);
    this.second.set(session.images[0] ?? null, page?.second ?? null);
    this.toolbar.start(session);
    // After a reconnect the user stays where he is.
    this.navigation.start(session, isFirst ? (page?.navigation ?? null) : this.navigation.saved());
    this.views.forEach((view) => view.showTitle());
    if (isFirst) this.activate(this.views.has(this.navigation.big as ViewName) ? (this.navigation.big as ViewName) : session.first_view);
    this.views.forEach((view) => view.forgetOutlines());
    this.surface.forgetRevisions();
    this.project.start(session);
    if (isFirst) this.restore(session, page);
    this.windows.start(session.project);
    void this.surface.start(session.image);
    for (const note of isFirst ? session.image.notes : []) this.notices.show("warning", note);
    this.hintSeen ||= page?.hintSeen ?? false;
    if (!this.hintSeen && session.contours.length === 0) this.showFirstHint();
    this.tellHint();
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

  private openWindow(): void {
    if (this.keeper.isWaiting) this.keeper.save(); // it begins where this one is
    if (!this.windows.open(this.token)) this.notices.show("warning", "The browser lets this page open no window. Allow it in the address bar.");
  }

  private connected(state: ConnectionState): void {
    if (state === "lost") this.status.setWork("", null); // nobody tells any more when it is done
    this.saving.connected(state);
    this.startPage.connected(state);
  }

  /** Said until the next edit, as long as undo takes back this one. */
  private tellCrossing(contour: Contour): void {
    if (contour.self_crossings.length === 0) return;
    const where = contour.self_crossings.length === 1 ? "at the ringed place" : `at ${contour.self_crossings.length} ringed places`;
    const text = `This contour crosses itself ${where}: what is inside of it is not clear there, and the surface may leave the line.`;
    this.closeCrossingNotice = this.notices.show("warning", text, { label: "Take it back", act: () => this.undo() });
  }

  private undo(): void {
    const { drawing, edits } = this.editor;
    drawing.outbox.afterSending(() => {
      if (!drawing.undo()) edits.make("undo", {});
    });
  }

  private redo(): void {
    const { drawing, edits } = this.editor;
    drawing.outbox.afterSending(() => {
      if (!drawing.redo()) edits.make("redo", {});
    });
  }

  /** A new structure is for what is drawn next. */
  private async addStructure(): Promise<void> {
    try {
      const { structure } = await this.socket.call("structure.add", {});
      this.project.select(null);
      this.project.activate(structure.id);
    } catch (error) {
      this.saving.failed(error);
    }
  }

  /** The start page, for all pages of this project. Nothing is lost, so what is not saved yet is waited for. */
  private async openAnother(): Promise<void> {
    if (!this.saving.isDone)
      return void this.notices.show("warning", "Not all is saved yet. Save it (Enter), or give it up (Esc), before another image is opened.");
    if (this.keeper.isWaiting) this.keeper.save();
    try {
      await this.socket.call("ping", {}); // after what was asked before: the page's own state, too
      await this.http.close();
    } catch (error) {
      this.saving.failed(error);
    }
  }

  private addImage(): void {
    const { places = [], folder = "" } = this.session ?? {};
    this.addImageDialog = new AddImageDialog({ http: this.http, places, folder, present: this.second.info });
  }

  /** It goes at once, so that nothing is asked of it meanwhile; if the server keeps it, it is back. */
  private removeImage(): void {
    const { info } = this.second;
    if (!info) return;
    const look = this.second.saved();
    this.second.set(null);
    this.socket.call("image.remove", { image: info.image }).catch((error: unknown) => {
      this.second.set(info, look);
      this.saving.failed(error);
    });
  }

  /** What has to be assumed of a new one is said once; its card says it always. */
  private showImages(images: FurtherImage[]): void {
    const info = images[0] ?? null;
    const isNew = info !== null && info.key !== this.second.info?.key;
    this.second.set(info);
    for (const note of isNew ? info.notes : []) this.notices.show("warning", note);
  }

  // Looking around

  private lay(): void {
    const { layout, big } = this.navigation;
    this.stage.dataset["layout"] = layout;
    const panes: [PaneName, HTMLElement][] = [
      ...[...this.views].map(([name, view]): [PaneName, HTMLElement] => [name, view.element]),
      ["surface", this.surface.element],
    ];
    const bigPane: PaneName | null = layout === "big-surface" ? "surface" : layout === "overview" ? null : big;
    for (const [name, element] of panes) {
      element.classList.toggle("big", name === bigPane);
      element.hidden = layout === "single" && name !== bigPane;
      element.dataset["place"] = String(this.navigation.order.indexOf(name as ViewName) + 1); // 0: the 3D view
    }
  }

  private toggleSingle(pane: PaneName): void {
    const { navigation } = this;
    if (navigation.layout === "single" && navigation.big === pane) navigation.setLayout("overview");
    else navigation.setLayout("single", pane);
  }

  private activate(view: ViewName): void {
    this.active = view;
    for (const [name, { element }] of this.views) element.classList.toggle("focused", name === view);
    if (this.navigation.layout === "overview") this.navigation.big = view;
  }

  private screens(): Partial<Record<ViewName, Screen>> {
    const screens: Partial<Record<ViewName, Screen>> = {};
    for (const [name, view] of this.views) {
      const screen = view.screen();
      if (screen) screens[name] = screen;
    }
    return screens;
  }

  private goTo(p: Vec3): void {
    this.navigation.goTo(p, this.screens());
  }

  private show(contour: InPlane): void {
    let view = viewAlong(contour, this.navigation);
    if (!view) {
      view = "oblique";
      this.navigation.turnTo(view, contour.plane);
    }
    this.activate(view);
    this.goTo(crosshairOnto(contour, this.navigation.crosshair));
  }

  private async suggest(): Promise<void> {
    const view = await this.editor.proposals.suggest();
    if (view) this.activate(view);
  }

  private jump(view: SliceView, event: PointerEvent): void {
    const at = view.worldAt(event);
    if (at) this.goTo(at);
  }

  private pointed(view: SliceView, event: PointerEvent): void {
    const at = view.worldAt(event);
    if (at && this.saving.connection === "open") this.values.send(at);
  }

  private async askValue(at: Vec3): Promise<void> {
    const { session, second, navigation } = this;
    const { values } = await this.socket.call("value", { at, ...(navigation.isAway && { time: navigation.time }) });
    if (session) this.status.setCursor(`${placeText(at)}  ·  ${valuesText(values, session, second.info)}`);
  }

  /** Esc: first what the pointer does, then the sketch, then the tool, then the selection. */
  private leave(): void {
    if ([...this.inputs, this.surface].some((input) => input.cancel())) return;
    if (this.editor.drawing.sketch) return this.editor.drawing.leave();
    if (this.editor.proposals.drop() || this.editor.leaveBegun()) return;
    if (this.editor.tool.id !== "edit") return this.editor.choose("edit");
    this.project.select(null);
  }

  private tellHint(): void {
    this.status.setHint(hintFor(this.editor));
  }

  private showFirstHint(): void {
    if (this.stage.querySelector(".first-hint")) return;
    const hint = firstHint(() => {
      hint.remove();
      this.hintSeen = true;
      this.editor.choose("wire");
      this.keeper.saveSoon();
    });
    this.stage.append(hint);
  }

  private importServices() {
    return {
      http: this.http,
      endings: this.session?.imports ?? { contours: [], masks: [] },
      failed: (error: unknown) => void this.notices.show("error", error instanceof Error ? error.message : String(error)),
      working: (text: string, cancel: () => void) => this.notices.working(text, cancel),
      imported: (file: string, structures: number[]) => {
        this.notices.show("info", `${file}: ${structures.length === 1 ? "1 structure" : `${structures.length} structures`} imported.`);
        if (structures[0]) this.project.activate(structures[0]);
      },
    };
  }

  private acceptDrops(): void {
    document.addEventListener("dragover", (event) => event.preventDefault());
    document.addEventListener("drop", (event) => {
      event.preventDefault();
      const file = event.dataTransfer?.files[0];
      if (file) importFile(file, this.importServices());
    });
  }

  /** Asks before work is left that no next visit would bring back. What is saved as late as "pagehide" Firefox no longer sends. */
  private guardClosing(): void {
    const save = () => {
      if (this.keeper.isWaiting) this.keeper.save();
    };
    window.addEventListener("beforeunload", (event) => {
      save();
      const isSketchKept = this.saving.connection === "open" && !this.windows.isSecond;
      if (!this.saving.isDone || (this.editor.drawing.sketch && !isSketchKept)) event.preventDefault();
    });
    window.addEventListener("pagehide", save);
  }
}
