// SPDX-License-Identifier: Apache-2.0

import { ICONS } from "./icons";
import { iconPiece, make, piece, type Child, type Listeners, type Piece, type Properties } from "./pieces";

type Tag = keyof HTMLElementTagNameMap;

export function listen<T extends Tag>(element: HTMLElementTagNameMap[T], listeners: Listeners<T>): void {
  for (const [type, listener] of Object.entries(listeners)) element.addEventListener(type, listener as EventListener);
}

/** An element that is never described anew. */
export function el<T extends Tag>(tag: T, properties: Properties<T> = {}, ...children: Child[]): HTMLElementTagNameMap[T] {
  return make(piece(tag, properties, ...children));
}

export interface ButtonOptions {
  label?: string;
  icon?: string;
  title: string;
  class?: string;
  test?: string;
  part?: string; // names it among the buttons of its row
  more?: Properties<"button">;
  click: (event: MouseEvent) => void;
}

export function buttonPiece(options: ButtonOptions, ...more: Child[]): Piece<"button"> {
  const { on = {}, ...properties } = options.more ?? {};
  return piece(
    "button",
    {
      key: options.part ?? options.test,
      type: "button",
      class: options.class ?? "button",
      title: options.title,
      "aria-label": options.label ? undefined : options.title, // what is seen is its name, and the title describes it
      "data-test": options.test,
      "data-part": options.part,
      ...properties,
      on: { click: options.click, ...on },
    },
    options.icon ? iconPiece(options.icon) : null,
    options.label ? piece("span", {}, options.label) : null,
    ...more,
  );
}

export const button = (options: ButtonOptions): HTMLButtonElement => make(buttonPiece(options));

/** Shows or hides something. */
export function eye(visible: boolean, click: () => void): Piece<"button"> {
  return buttonPiece({
    icon: visible ? ICONS.eye : ICONS.eyeOff,
    title: visible ? "Hide" : "Show",
    class: "icon-button small" + (visible ? "" : " dimmed"),
    part: "eye",
    click,
  });
}
