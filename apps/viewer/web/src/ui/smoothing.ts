// SPDX-License-Identifier: Apache-2.0
import type { Maker } from "../net/calls";
import type { Project } from "../model/project";
import { el } from "../dom/dom";

/** The library's smoothing, on unit coordinates; null: what it chooses by itself, 1e-5. */
export const SMOOTHINGS: readonly (number | null)[] = [0, 1e-6, null, 1e-4, 1e-3, 1e-2];
const USUAL = SMOOTHINGS.indexOf(null);
const WORDS = ["follows every line exactly", "follows lines more closely", "usual", "smoother", "smoother still", "smooth"];

/** The step of the slider that is nearest to a smoothing, which an export or another page may have given. */
export function stepOf(smoothing: number | undefined): number {
  if (smoothing === undefined) return USUAL;
  const logarithm = (value: number) => Math.log(Math.max(value, 1e-8));
  const gaps = SMOOTHINGS.map((value) => Math.abs(logarithm(value ?? 1e-5) - logarithm(smoothing)));
  return gaps.indexOf(Math.min(...gaps));
}

const OWN_KEYS = /^(Arrow|Page|Home$|End$)/;

export interface SmoothingServices {
  project: Project;
  call: Maker;
}

/** How closely the active structure's surface follows its lines; hidden before it has any. */
export class SmoothingSlider {
  private sent: { structure: number; step: number } | null = null; // what the hand has chosen, and the project may not show yet
  private readonly words = el("span", { class: "smoothing-words" });
  private readonly input = el("input", {
    type: "range",
    min: "0",
    max: String(SMOOTHINGS.length - 1),
    step: "1",
    "aria-label": "Smoothing of the surface",
    "data-test": "smoothing",
    on: {
      input: () => this.tell(this.input.valueAsNumber),
      change: () => this.change(),
      blur: () => this.update(),
      keydown: (event) => {
        if (OWN_KEYS.test(event.key)) event.stopPropagation(); // with which the page scrolls
      },
    },
  });
  readonly element = el(
    "label",
    {
      class: "smoothing",
      hidden: true,
      title: "How closely the surface follows the drawn lines: exactly on the left, smooth on the right, where a hand's wobble is not followed",
    },
    this.input,
    this.words,
  );

  constructor(private readonly services: SmoothingServices) {
    services.project.on(["contours", "structures", "selection"], () => this.update());
    services.project.on(["refused"], () => {
      this.sent = null;
      this.update();
    });
  }

  private update(): void {
    const { project } = this.services;
    const structure = project.activeStructure;
    this.element.hidden = !structure || structure.mask !== undefined || project.contoursOf(structure.id).length === 0;
    if (!structure || this.input.matches(":active")) return; // a hand is at it
    const step = stepOf(structure.smoothing);
    const isOnItsWay = this.sent?.structure === structure.id && this.sent.step !== step && document.activeElement === this.input;
    if (isOnItsWay) return; // an answer to the key before must not take the next one back
    this.sent = null;
    this.input.value = String(step);
    this.tell(step);
  }

  private tell(step: number): void {
    this.words.textContent = `Surface: ${WORDS[step]}`;
    this.input.setAttribute("aria-valuetext", WORDS[step]!);
  }

  private change(): void {
    const structure = this.services.project.activeStructure;
    const step = this.input.valueAsNumber;
    if (!structure) return;
    this.sent = { structure: structure.id, step };
    this.services.call("structure.set", { id: structure.id, smoothing: SMOOTHINGS[step] ?? "usual" });
  }
}
