// SPDX-License-Identifier: Apache-2.0
import { drawnSlices } from "../model/drawn_slices";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { ViewName } from "../net/protocol";
import { el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";

/** Which slice a view shows, beside it: to drag, with a tick at each slice on which something is drawn. */
export class SliceSlider {
  readonly element: HTMLElement;
  private readonly input = el("input", {
    type: "range",
    class: "slice-slider",
    title: "Slice (mouse wheel, arrow keys); a tick marks each drawn slice (N, Shift + N)",
    on: { input: () => this.slid() },
  });
  private readonly ticks = el("div", { class: "slice-ticks", "aria-hidden": "true" });

  constructor(
    private readonly view: ViewName,
    private readonly navigation: Navigation,
    private readonly project: Project,
  ) {
    this.element = el("div", { class: "slice-place" }, this.ticks, this.input);
  }

  update(): void {
    const { from, to, at } = this.navigation.depth(this.view);
    Object.assign(this.input, { min: String(from), max: String(to), step: String(this.navigation.step(this.view)) });
    this.input.value = String(at);
    render(this.ticks, this.ticksBetween(from, to));
  }

  /** A slice with contours of several structures has the active one's colour, or else the first one's. */
  private ticksBetween(from: number, to: number): Piece[] {
    const { structures, activeStructure } = this.project;
    return drawnSlices(this.view, this.navigation, this.project).flatMap(({ depth_mm, structures: drawn }) => {
      const at = (depth_mm - from) / (to - from);
      const shown = drawn.find((id) => id === activeStructure?.id) ?? drawn[0]!;
      return at >= -1e-6 && at <= 1 + 1e-6 ? [piece("span", { style: { "--at": String(at), background: structures.get(shown)!.color } })] : [];
    });
  }

  private slid(): void {
    this.navigation.scrollTo(this.view, Number(this.input.value));
  }
}
