// SPDX-License-Identifier: Apache-2.0
import { el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";
import { volumeText } from "../model/volumes";
import type { VolumeCurve } from "../net/protocol";

const HEIGHT = 100; // of the drawing's own units
const ROOM = 8; // above and below the line

const SVG = "http://www.w3.org/2000/svg";

function svg(name: string, attributes: Record<string, string>): SVGElement {
  const element = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  return element;
}

/** The volume over time as a line; a click goes to the time below it. */
export class CurveView {
  readonly element = el("div", { class: "curve absent", "data-test": "curve", role: "img" });
  private readonly drawing = svg("svg", { preserveAspectRatio: "none" });
  private count = 1;

  constructor(go: (time: number) => void) {
    this.element.append(this.drawing);
    this.element.addEventListener("click", (event) => {
      const box = this.drawing.getBoundingClientRect();
      const share = (event.clientX - box.left) / box.width;
      go(Math.min(this.count - 1, Math.max(0, Math.round(share * (this.count - 1)))));
    });
  }

  show(curve: VolumeCurve | undefined, time: number, color: string): void {
    this.element.classList.toggle("absent", !curve); // its place is kept: views must not move under a hand that draws
    if (!curve) return;
    const { volumes_ml, largest, smallest, intervals_ml = [] } = curve;
    this.count = volumes_ml.length;
    const most = Math.max(volumes_ml[largest]!, ...intervals_ml.map(([, high]) => high));
    const least = Math.min(volumes_ml[smallest]!, 0.98 * most, ...intervals_ml.map(([low]) => low));
    const y = (ml: number) => HEIGHT - ROOM - ((HEIGHT - 2 * ROOM) * (ml - least)) / (most - least || 1);
    const path = (points: [number, number][]) => points.map(([n, ml], k) => `${k === 0 ? "M" : "L"}${n} ${y(ml).toFixed(2)}`).join(" ");
    const line = path(volumes_ml.map((ml, n) => [n, ml]));
    const highs = intervals_ml.map(([, high], n): [number, number] => [n, high]);
    const lows = intervals_ml.map(([low], n): [number, number] => [n, low]);
    this.drawing.setAttribute("viewBox", `0 0 ${Math.max(1, this.count - 1)} ${HEIGHT}`);
    const marks = [largest, smallest].map((n) => svg("path", { d: `M${n} 0V${HEIGHT}`, class: "curve-mark" }));
    this.drawing.replaceChildren(
      svg("path", { d: path([...highs, ...lows.reverse()]), class: "curve-band", fill: color }),
      ...marks,
      svg("path", { d: `M${time} 0V${HEIGHT}`, class: "curve-now" }),
      svg("path", { d: line, class: "curve-line", stroke: color }),
    );
    this.element.setAttribute("aria-label", `Volume over ${this.count} frames: ${curveText(curve)}`);
  }
}

/** "12.3 % (10.1 to 14.5)", the latter where it is known. */
export function fractionText({ ejection_fraction, ejection_interval }: VolumeCurve): string {
  const percent = (share: number) => (100 * share).toFixed(1);
  const within = ejection_interval ? ` (${percent(ejection_interval[0])} to ${percent(ejection_interval[1])})` : "";
  return `${percent(ejection_fraction)} %${within}`;
}

/** "largest (end-diastole) frame 1, 149 ml; ...". */
export function curveText(curve: VolumeCurve): string {
  const { volumes_ml, largest, smallest, stroke_ml } = curve;
  const at = (n: number) => `frame ${n + 1}, ${volumeText(volumes_ml[n]!)}`;
  const share = `ejection fraction ${fractionText(curve)}`;
  return `end-diastole ${at(largest)}; end-systole ${at(smallest)}; stroke volume ${volumeText(stroke_ml)}; ${share}`;
}

/** The same as figures, whose frames can be gone to. */
export function showFigures(target: HTMLElement, curve: VolumeCurve | undefined, go: (time: number) => void): void {
  target.hidden = !curve;
  if (!curve) return;
  const { volumes_ml, largest, smallest, stroke_ml } = curve;
  const place = (title: string, test: string, n: number): Piece =>
    piece(
      "button",
      {
        type: "button",
        class: "choice",
        "data-test": test,
        title: `Go to frame ${n + 1}, where the volume is ${n === largest ? "largest" : "smallest"}`,
        on: { click: () => go(n) },
      },
      `${title} ${n + 1}: ${volumeText(volumes_ml[n]!)}`,
    );
  render(target, [
    place("End-diastole", "largest", largest),
    place("End-systole", "smallest", smallest),
    piece("span", { "data-test": "stroke" }, `Stroke volume ${volumeText(stroke_ml)}`),
    piece("span", { "data-test": "ejection", title: "In parentheses: the true one lies within in 90 %" }, `Ejection fraction ${fractionText(curve)}`),
  ]);
}
