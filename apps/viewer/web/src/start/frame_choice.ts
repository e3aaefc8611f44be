// SPDX-License-Identifier: Apache-2.0
import { button, el, listen } from "../dom/dom";

/** Asks which of a file's frames is meant; kontur counts them from 0. */
export function frameChoice(frames: number, chosen: (frame: number) => void, wrong: (sentence: string) => void): { element: HTMLElement; focus: () => void } {
  const field = el("input", {
    type: "number",
    class: "number",
    min: "0",
    max: String(frames - 1),
    step: "1",
    value: "0",
    "aria-label": `Frame, from 0 to ${frames - 1}`,
    "data-test": "frame",
  });
  const choose = () => {
    const frame = field.valueAsNumber;
    if (Number.isInteger(frame) && frame >= 0 && frame < frames) return chosen(frame);
    wrong(`There is no frame ${field.value || "without a number"}; frames are numbered from 0 to ${frames - 1}`);
    field.focus();
  };
  listen(field, { keydown: (event) => void (event.key === "Enter" && choose()) });
  const element = el(
    "span",
    { class: "frame-choice" },
    ` Frame 0 to ${frames - 1}: `,
    field,
    button({ label: "Open", title: "Open this frame", class: "choice", test: "frame-open", click: choose }),
  );
  const focus = () => {
    field.select();
    field.focus();
  };
  return { element, focus };
}
