// SPDX-License-Identifier: Apache-2.0
import type { Screen } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";
import { Cine } from "../model/cine";
import { VIEW_NAMES, type Session, type ViewName } from "../net/protocol";
import { SurfaceView } from "../three/surface_view";
import type { Editor } from "../tools/editor";
import { KeyPointer } from "../tools/key_pointer";
import { Pointers } from "../tools/pointers";
import { ViewInput, type InputView } from "../tools/view_input";
import { SliceView } from "../view/slice_view";
import type { Models } from "./models";
import { Panes } from "./panes";
import type { Server } from "./server";
import { ValueAtPointer } from "./value_at_pointer";

const PEN_DRAWS = "A pen draws here, so touches are taken for the hand that holds it, and ignored. To draw with a finger, load the page again.";

export interface StageServices {
  models: Models;
  server: Server;
  editor: Editor;
  session(): Session | null;
  /** One more of this project, for a second screen. */
  openWindow(): void;
  isPanning(): boolean;
  hint(text: string | null): void;
}

/** The slices and the 3D view, and the pointers that work on them. */
export class Stage {
  readonly views = new Map<ViewName, SliceView>();
  readonly surface: SurfaceView;
  readonly panes: Panes;
  readonly cine: Cine;
  readonly keyPointer: KeyPointer;
  private readonly pointers: Pointers;
  private readonly inputs: ViewInput[];
  private readonly value: ValueAtPointer;

  constructor(private readonly services: StageServices) {
    const { models, server, editor } = services;
    const shared = { ...models, http: server.http, socket: server.socket, status: server.status, editor, failed: server.failed, session: services.session };
    for (const name of VIEW_NAMES) this.views.set(name, new SliceView(name, { ...shared, appearance: models.appearance }));
    this.surface = new SurfaceView({ ...shared, goTo: (p) => this.panes.goTo(p), openWindow: services.openWindow });
    this.panes = new Panes(models.navigation, this.views, this.surface);
    const shown = () => Promise.all([...[...this.views.values()].map((view) => view.idle()), this.surface.idle()]);
    this.cine = new Cine(models.navigation, shown);
    this.value = new ValueAtPointer(shared);
    this.pointers = new Pointers(() => void server.notices.show("info", PEN_DRAWS));
    this.keyPointer = new KeyPointer({
      ...shared,
      screenOf: (view) => this.screenOf(view),
      elementOf: (view) => this.views.get(view)?.element ?? null,
      pointed: (at) => this.tellValue(at),
    });
    this.inputs = [...this.views.values()].map((view) => this.inputOf(view));
    for (const view of this.views.values()) this.activateOnPress(view);
  }

  screenOf(view: ViewName): Screen | null {
    return this.views.get(view)?.screen() ?? null;
  }

  /** What the pointer does is given up; false where it does nothing. */
  readonly cancelPointers = (): boolean => [...this.inputs, this.surface, this.keyPointer].some((input) => input.cancel());

  private inputOf(view: SliceView): ViewInput {
    const { models, editor, isPanning, hint } = this.services;
    const { navigation, second } = models;
    return new ViewInput(view, {
      navigation,
      editor,
      pointers: this.pointers,
      isPanning,
      windowed: (isShifted) => (second.info && (second.isAlone || isShifted) ? second : navigation),
      pointed: (from, event) => this.pointed(from, event),
      jump: (from, event) => this.jump(from, event),
      hint,
    });
  }

  private activateOnPress(view: SliceView): void {
    const activate = (event: PointerEvent) => {
      if (!this.pointers.ignores(event)) this.panes.activate(view.name);
    };
    view.element.addEventListener("pointerdown", activate, { capture: true });
    view.element.addEventListener("focusin", () => this.panes.activate(view.name)); // keys are for the view that the keyboard is in
  }

  private jump(view: InputView, event: PointerEvent): void {
    const at = this.views.get(view.name)?.worldAt(event);
    if (at) this.panes.goTo(at);
  }

  private pointed(view: InputView, event: PointerEvent): void {
    this.keyPointer.hide();
    const at = this.views.get(view.name)?.worldAt(event);
    if (at) this.tellValue(at);
  }

  private tellValue(at: Vec3): void {
    if (this.services.server.saving.connection === "open") this.value.tell(at);
  }
}
