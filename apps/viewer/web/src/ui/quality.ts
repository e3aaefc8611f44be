// SPDX-License-Identifier: Apache-2.0
import { coincide } from "../geometry/plane";
import type { Vec3 } from "../geometry/vec";
import type { Contour, Surface } from "../net/protocol";
import { button, el } from "./dom";
import { ICONS } from "./icons";

const SAME_PLANE_MM = 0.01;

type GoTo = (p: Vec3) => void;

/** How well the surface fits its contours: figures, and places to go to where it does not. */
export function qualityOf(surface: Surface | undefined, contours: Contour[], goTo: GoTo): HTMLElement[] {
  return [...figures(surface, contours, goTo), ...selfCrossings(contours, goTo)];
}

function figures(surface: Surface | undefined, contours: Contour[], goTo: GoTo): HTMLElement[] {
  if (!surface || surface.stage === "none") {
    const found = surface ? troubles(surface, goTo) : [];
    return found.length > 0 ? found : [el("p", { class: "empty" }, "No surface yet.")];
  }
  const entries: HTMLElement[] = [];
  const guess = depthGuess(contours);
  if (surface.volume_ml !== undefined) entries.push(figure(guess ? "Volume (a guess)" : "Volume", `${volume(surface.volume_ml)} ml`, guess !== null));
  if (guess) entries.push(el("p", { class: "warning-text", "data-test": "depth-guess" }, guess));
  const { residual } = surface;
  if (residual) {
    entries.push(figure("Residual (rms)", `${residual.rms_mm.toFixed(2)} mm`));
    entries.push(place(`largest residual ${residual.max_mm.toFixed(2)} mm`, "Go to where the surface is farthest from a contour", "residual", () => goTo(residual.at)));
  }
  return [...entries, ...troubles(surface, goTo)];
}

function troubles({ conflicts = [], warnings = [] }: Surface, goTo: GoTo): HTMLElement[] {
  const title = "Go to where two contours contradict each other";
  return [
    ...warnings.map((text) => el("p", { class: "warning-text" }, text)),
    ...conflicts.map(({ at, distance_mm }) => place(`contours disagree by ${distance_mm.toFixed(1)} mm`, title, "conflict", () => goTo(at))),
  ];
}

function selfCrossings(contours: Contour[], goTo: GoTo): HTMLElement[] {
  const places = contours.flatMap((contour) => contour.self_crossings.slice(0, 1));
  return places.map((at) => place("a contour crosses itself", "Go to where it crosses itself", "self-crossing", () => goTo(at)));
}

function place(label: string, title: string, kind: "residual" | "conflict" | "self-crossing", click: () => void): HTMLElement {
  return button({ label, icon: kind === "residual" ? ICONS.lines : ICONS.warning, title, class: kind === "residual" ? "place" : "place warning", test: kind, click });
}

const volume = (ml: number): string => (ml >= 100 ? ml.toFixed(0) : ml.toPrecision(3));

/** What no line says of the object that these contours make; null where they say enough. */
function depthGuess(contours: readonly Contour[]): string | null {
  const [first] = contours;
  if (!first || !contours.every(({ plane }) => coincide(plane, first.plane, SAME_PLANE_MM))) return null;
  return `${contours.length === 1 ? "One contour" : "All contours lie in one plane"}: the depth is a guess. Draw another one across, or on another slice.`;
}

const figure = (label: string, value: string, isGuess = false): HTMLElement =>
  el("div", { class: isGuess ? "figure guess" : "figure" }, el("span", {}, label), el("strong", {}, value));
