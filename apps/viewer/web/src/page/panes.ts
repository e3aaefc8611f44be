// SPDX-License-Identifier: Apache-2.0
import { heightOver } from "../geometry/plane";
import type { Screen } from "../geometry/screen";
import { dot, type Vec3 } from "../geometry/vec";
import type { Navigation, PaneName } from "../model/navigation";
import { VIEW_NAMES, type ViewName } from "../net/protocol";
import type { SurfaceView } from "../three/surface_view";
import { el } from "../dom/dom";
import type { InPlane } from "../ui/contour_names";
import type { SliceView } from "../view/slice_view";

/** The slices and the 3D view: how they are laid out, and which of the slices keys are for. */
export class Panes {
  readonly element: HTMLElement;
  active: ViewName = "axial";

  constructor(
    private readonly navigation: Navigation,
    private readonly views: ReadonlyMap<ViewName, SliceView>,
    private readonly surface: SurfaceView,
  ) {
    this.element = el("main", { class: "stage" }, ...[...views.values()].map((view) => view.element), surface.element);
    navigation.on(["layout"], () => this.lay());
    for (const [name, view] of views) view.header.addEventListener("dblclick", () => this.toggleSingle(name));
    surface.header.addEventListener("dblclick", () => this.toggleSingle("surface"));
  }

  /** The view that was big when the project was left, or else the one that the image was taken in. */
  begin(first: ViewName): void {
    const { big } = this.navigation;
    this.activate(big === "surface" ? first : big);
  }

  activate(view: ViewName): void {
    this.active = view;
    for (const [name, { element }] of this.views) element.classList.toggle("focused", name === view);
    if (this.navigation.layout === "overview") this.navigation.big = view;
  }

  toggleSingle(pane: PaneName): void {
    const { navigation } = this;
    if (pane !== "surface") this.activate(pane); // keys would scroll one that is not shown
    if (navigation.layout === "single" && navigation.big === pane) navigation.setLayout("overview");
    else navigation.setLayout("single", pane);
  }

  goTo(p: Vec3): void {
    this.navigation.goTo(p, this.screens());
  }

  /** At its time, in the view that looks along it; where there is none, the free one is turned. */
  show(contour: InPlane): void {
    this.navigation.setTime(contour.time ?? this.navigation.ownTime);
    let view = viewAlong(contour, this.navigation);
    if (!view) {
      view = "oblique";
      this.navigation.turnTo(view, contour.plane);
    }
    this.activate(view);
    this.goTo(crosshairOnto(contour, this.navigation.crosshair));
  }

  private lay(): void {
    const { layout, big, order } = this.navigation;
    this.element.dataset["layout"] = layout;
    const panes: [PaneName, HTMLElement][] = [
      ...[...this.views].map(([name, view]): [PaneName, HTMLElement] => [name, view.element]),
      ["surface", this.surface.element],
    ];
    const bigPane: PaneName | null = layout === "big-surface" ? "surface" : layout === "overview" ? null : big;
    for (const [name, element] of panes) {
      element.classList.toggle("big", name === bigPane);
      element.hidden = layout === "single" && name !== bigPane;
      element.dataset["place"] = String(order.indexOf(name as ViewName) + 1); // 0: the 3D view
    }
  }

  private screens(): Partial<Record<ViewName, Screen>> {
    const screens: Partial<Record<ViewName, Screen>> = {};
    for (const [name, view] of this.views) {
      const screen = view.screen();
      if (screen) screens[name] = screen;
    }
    return screens;
  }
}

/** The view whose plane is parallel to the contour's, if there is one. */
function viewAlong(contour: InPlane, navigation: Navigation): ViewName | null {
  const normal = contour.plane.normal;
  return VIEW_NAMES.find((view) => Math.abs(dot(navigation.cameras[view].axes.normal, normal)) > 1 - 1e-6) ?? null;
}

/** Where the crosshair must go so that planes along the contour's contain it: straight along its normal. */
function crosshairOnto(contour: InPlane, crosshair: Vec3): Vec3 {
  const height = heightOver(contour.plane, crosshair);
  return crosshair.map((value, i) => value - height * contour.plane.normal[i]!) as unknown as Vec3;
}
