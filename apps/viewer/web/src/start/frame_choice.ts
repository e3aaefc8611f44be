// SPDX-License-Identifier: Apache-2.0
import { button, el, listen } from "../dom/dom";

export interface FrameChoiceServices {
  /** Of a frame, from 0, as the server counts. */
  choose(frame: number): void;
  wrong(sentence: string): void;
  /** Shows the frame, from 0, on the canvas. */
  paint(canvas: HTMLCanvasElement, frame: number): void;
}

/** Asks which of a file's frames is meant, with a picture of it. People count frames from 1, as the card of time does. */
export function frameChoice(frames: number, services: FrameChoiceServices): { element: HTMLElement; focus: () => void } {
  const canvas = el("canvas", { class: "frame-picture", width: 112, height: 112, "aria-hidden": "true", "data-test": "frame-picture" });
  const frame = () => field.valueAsNumber - 1;
  const isThere = () => Number.isInteger(frame()) && frame() >= 0 && frame() < frames;
  const choose = () => {
    if (isThere()) return services.choose(frame());
    services.wrong(`There is no frame ${field.value || "without a number"}; frames are numbered from 1 to ${frames}`);
    field.focus();
  };
  const field = el("input", {
    type: "number",
    class: "number",
    min: "1",
    max: String(frames),
    step: "1",
    value: "1",
    "aria-label": `Frame, from 1 to ${frames}`,
    "data-test": "frame",
  });
  listen(field, {
    keydown: (event) => void (event.key === "Enter" && choose()),
    input: () => void (isThere() && services.paint(canvas, frame())),
  });
  services.paint(canvas, 0);
  const element = el(
    "span",
    { class: "frame-choice" },
    `Frame 1 to ${frames}: `,
    field,
    button({ label: "Open", title: "Open this frame", class: "choice", test: "frame-open", click: choose }),
    canvas,
  );
  const focus = () => {
    field.select();
    field.focus();
  };
  return { element, focus };
}
