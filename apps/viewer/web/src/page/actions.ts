// SPDX-License-Identifier: Apache-2.0
import type { Project } from "../model/project";
import type { Http } from "../net/http";
import type { NearDrawing, Session } from "../net/protocol";
import type { Socket } from "../net/socket";
import type { Editor } from "../tools/editor";
import { openExport } from "../ui/dialogs";
import { openHelp } from "../ui/help";
import { importFile, importNear, openImport, type ImportServices } from "../ui/imports";
import { openStatistics } from "../ui/statistics";
import type { Notices } from "../ui/status";
import type { SurfaceView } from "../three/surface_view";
import type { LinkedWindows } from "./linked_windows";
import type { Panes } from "./panes";
import type { PageKeeper } from "./saved_page";
import type { Saving } from "./saving";
import { snapshot } from "./snapshot";

export interface PageActionServices {
  token: string;
  http: Http;
  socket: Socket;
  project: Project;
  editor: Editor;
  surface: SurfaceView;
  panes: Panes;
  windows: LinkedWindows;
  saving: Saving;
  keeper: PageKeeper;
  notices: Notices;
  session(): Session | null;
  /** What others have drawn on the image, in files near it. */
  near(): readonly NearDrawing[];
  /** Lets the user type the name of a structure. */
  rename(structure: number): void;
  /** Of two structures. */
  goThroughDifferences(first: number, second: number): void;
  /** The first hint is taken away; false where there is none. */
  leaveHint(): boolean;
  /** What the pointer does is given up; false where it does nothing. */
  cancelPointers(): boolean;
}

/** What toolbar, panel and keyboard ask for that no part of the page can do alone. Each is a value, so that they can be handed on one by one. */
export class PageActions {
  constructor(private readonly services: PageActionServices) {}

  readonly undo = (): void => {
    const { drawing, edits } = this.services.editor;
    drawing.outbox.afterSending(() => {
      if (!drawing.undo()) edits.make("undo", {});
    });
  };

  readonly redo = (): void => {
    const { drawing, edits } = this.services.editor;
    drawing.outbox.afterSending(() => {
      if (!drawing.redo()) edits.make("redo", {});
    });
  };

  /** Esc: first what the pointer does, then the sketch, then the tool, then the selection. */
  readonly leave = (): void => {
    const { editor, project, cancelPointers, leaveHint } = this.services;
    if (leaveHint()) return;
    if (cancelPointers()) return;
    if (editor.drawing.sketch) return editor.drawing.leave();
    if (editor.proposals.drop() || editor.leaveBegun()) return;
    if (editor.tool.id !== "edit") return editor.choose("edit");
    project.select(null);
  };

  /** Shows where to draw next. */
  readonly suggest = async (): Promise<void> => {
    const view = await this.services.editor.proposals.suggest();
    if (view) this.services.panes.activate(view);
  };

  /** A new structure is for what is drawn next. Its name is asked for at once. */
  readonly addStructure = async (): Promise<void> => {
    const { socket, project, saving, rename } = this.services;
    try {
      const { structure } = await socket.call("structure.add", {});
      project.select(null);
      project.activate(structure.id);
      rename(structure.id);
    } catch (error) {
      saving.failed(error);
    }
  };

  /** The start page, for all pages of this project. Nothing is lost, so what is not saved yet is waited for. */
  readonly openAnother = async (): Promise<void> => void (await this.leaveForStart());

  /** False where the image stays open. */
  readonly leaveForStart = async (): Promise<boolean> => {
    const { http, socket, keeper, saving, notices } = this.services;
    if (!saving.isDone) {
      notices.show("warning", "Not all is saved yet. Save it (Enter), or give it up (Esc), before another image is opened.");
      return false;
    }
    keeper.saveNow();
    try {
      await socket.call("ping", {}); // after what was asked before: the page's own state, too
      await http.close();
      return true;
    } catch (error) {
      saving.failed(error);
      return false;
    }
  };

  readonly openWindow = (): void => {
    const { keeper, windows, token, notices } = this.services;
    keeper.saveNow(); // it begins where this one is
    if (!windows.open(token)) notices.show("warning", "The browser lets this page open no window. Allow it in the address bar.");
  };

  readonly openHelp = (): void => openHelp(this.services.session()?.version ?? "");

  readonly openExport = (): void => {
    const { panes, surface, project, session } = this.services;
    const picture = () => snapshot({ stage: panes.element, redraw3D: () => surface.redraw(), cube: () => surface.cubePlace(), project, session: session()! });
    const setLabel = async (id: number, label_value: number | "automatic") => void (await this.services.socket.call("structure.set", { id, label_value }));
    openExport({ ...this.services, hasDicom: () => session()?.has_dicom ?? false, archive: () => session()?.archive, snapshot: picture, setLabel });
  };

  readonly openStatistics = (): void => {
    const { http, panes, surface } = this.services;
    openStatistics(http, (p) => panes.goTo(p), {
      showDistances: (first, second) => surface.compare(first, second),
      goThrough: this.services.goThroughDifferences,
    });
  };

  readonly openImport = (): void => openImport(this.importServices(), this.services.near());

  readonly importNear = (drawing: NearDrawing): void => importNear(drawing, this.importServices());

  readonly importFile = (file: File): void => void importFile(file, this.importServices());

  private importServices(): ImportServices {
    const { http, notices, project, session } = this.services;
    return {
      http,
      endings: session()?.imports ?? { contours: [], masks: [] },
      failed: (error) => void notices.show("error", error instanceof Error ? error.message : String(error)),
      working: (text, cancel) => notices.working(text, cancel),
      imported: (file, structures) => {
        notices.show("info", `${file}: ${structures.length === 1 ? "1 structure" : `${structures.length} structures`} imported.`);
        if (structures[0]) project.activate(structures[0]);
      },
    };
  }
}
