// SPDX-License-Identifier: Apache-2.0
import { DIVIDERS, LEAST, MOST, type DividerName, type PaneSizes } from "../model/pane_sizes";
import { el } from "../dom/dom";

const NAMES: Record<DividerName, string> = {
  columns: "Width of the left slices",
  rows: "Height of the upper slices",
  surface: "Size of the slices beside the 3D view",
  big: "Size of the big view",
  panel: "Width of the views beside the list",
};
const KEY_STEP = 0.02;
const TALL = 0.9; // a stage that is narrower than this part of its height has the 3D view below the slices

/** The lines between the panes, which are dragged, or moved by arrow keys; a double click or Enter puts one back. */
export class Dividers {
  private readonly elements = new Map<DividerName, HTMLElement>();

  constructor(
    private readonly stage: HTMLElement,
    private readonly sizes: PaneSizes,
  ) {
    for (const divider of DIVIDERS) {
      const element = this.make(divider);
      this.elements.set(divider, element);
      (divider === "panel" ? document.body : stage).append(element);
    }
    sizes.on(["changed"], () => this.lay());
    new ResizeObserver(() => this.lay()).observe(stage);
    this.lay();
  }

  private get isTall(): boolean {
    return this.stage.clientWidth < TALL * this.stage.clientHeight;
  }

  /** Whether the divider stands upright, and goes to the left and right. */
  private isUpright(divider: DividerName): boolean {
    if (divider === "rows") return false;
    return !this.isTall || divider === "columns" || divider === "panel";
  }

  /** Of what the divider parts: where it begins on the screen, and how long it is. */
  private range(divider: DividerName): [from: number, length: number] {
    const whole = (divider === "panel" ? document.body : this.stage).getBoundingClientRect();
    const isSlices = divider === (this.isTall ? "rows" : "columns"); // all of it, but for the 3D view
    const share = isSlices ? this.sizes.share("surface") : 1;
    return this.isUpright(divider) ? [whole.left, share * whole.width] : [whole.top, share * whole.height];
  }

  private lay(): void {
    this.stage.dataset["shape"] = this.isTall ? "tall" : "wide";
    this.laySlices();
    for (const [divider, element] of this.elements) {
      const share = this.shown(divider);
      const { style } = divider === "panel" ? document.body : this.stage;
      if (divider === "panel" && !this.sizes.isMoved("panel")) style.removeProperty("--panel-after");
      else {
        style.setProperty(`--${divider}-before`, `${share}fr`);
        style.setProperty(`--${divider}-after`, divider === "panel" ? `${100 * (1 - share)}vw` : `${1 - share}fr`);
      }
      element.setAttribute("aria-orientation", this.isUpright(divider) ? "vertical" : "horizontal");
      element.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    }
  }

  /** Slices share what the 3D view leaves them. */
  private laySlices(): void {
    const { style } = this.stage;
    const slices = this.sizes.share("surface");
    const left = this.sizes.share("columns");
    const upper = this.sizes.share("rows");
    const tracks = { left: slices * left, middle: slices * (1 - left), upper: slices * upper, lower: slices * (1 - upper) };
    for (const [name, share] of Object.entries(tracks)) style.setProperty(`--${name}`, `${share}fr`);
  }

  /** The panel's usual width is the stylesheet's. */
  private shown(divider: DividerName): number {
    if (divider !== "panel" || this.sizes.isMoved(divider)) return this.sizes.share(divider);
    return this.stage.clientWidth / Math.max(document.body.clientWidth, 1);
  }

  private make(divider: DividerName): HTMLElement {
    const { sizes } = this;
    const element = el("div", {
      class: `separator divider-${divider}`,
      role: "separator",
      tabIndex: 0,
      title: "Drag, or arrow keys; double click or Enter: as it was",
      "aria-label": NAMES[divider],
      "aria-valuemin": String(100 * LEAST),
      "aria-valuemax": String(100 * MOST),
      "data-test": `divider-${divider}`,
      on: {
        pointerdown: (event) => {
          if (event.button === 0) element.setPointerCapture(event.pointerId);
        },
        pointermove: (event) => {
          if (element.hasPointerCapture(event.pointerId)) this.drag(divider, event);
        },
        dblclick: () => sizes.reset(divider),
        keydown: (event) => this.key(divider, event),
      },
    });
    return element;
  }

  private drag(divider: DividerName, { clientX, clientY }: PointerEvent): void {
    const [from, length] = this.range(divider);
    this.sizes.move(divider, ((this.isUpright(divider) ? clientX : clientY) - from) / length);
  }

  private key(divider: DividerName, event: KeyboardEvent): void {
    const [less, more] = this.isUpright(divider) ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    if (event.key === less) this.sizes.move(divider, this.shown(divider) - KEY_STEP);
    else if (event.key === more) this.sizes.move(divider, this.shown(divider) + KEY_STEP);
    else if (event.key === "Enter") this.sizes.reset(divider);
    else if (!event.key.startsWith("Arrow")) return; // the page's
    event.preventDefault();
    event.stopPropagation();
  }
}
