// SPDX-License-Identifier: Apache-2.0
import { el } from "./dom";

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
