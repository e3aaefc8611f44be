// SPDX-License-Identifier: Apache-2.0
import type { Preset } from "../net/protocol";
import { el } from "../dom/dom";
import { piece, type Piece } from "../dom/pieces";

/** A number of a window that can be typed. `update` shows again what counts: what is no window is not kept. */
export function windowField(title: string, typed: () => void, update: () => void): HTMLInputElement {
  const field = el("input", {
    type: "number",
    class: "number",
    title,
    step: "any",
    on: {
      change: typed,
      blur: update,
      keydown: (event) => {
        if (event.key === "Enter") field.blur(); // keys are the tools' again
      },
    },
  });
  return field;
}

/** Windows to choose, by their number; "" is one that is none of them. */
export const presetOptions = (presets: readonly Preset[]): Piece[] => [
  ...presets.map(({ name }, i) => piece("option", { value: String(i) }, name)),
  piece("option", { value: "", hidden: true }, "Custom"),
];
