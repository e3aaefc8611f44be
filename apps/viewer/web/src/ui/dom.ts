// SPDX-License-Identifier: Apache-2.0

import { ICONS } from "./icons";

type Child = Node | string | null | undefined;

/** What is done at an event. Unlike a property `onclick`, a listener cannot cancel the event by what it returns. */
type Listeners = { [Type in keyof HTMLElementEventMap]?: (event: HTMLElementEventMap[Type]) => void };

interface Properties {
  on?: Listeners;
  [name: string]: unknown;
}

export function listen(element: HTMLElement, listeners: Listeners): void {
  for (const [type, listener] of Object.entries(listeners)) element.addEventListener(type, listener as EventListener);
}

/** An element with properties ("class" and "data-..." as attributes), listeners and children. */
export function el<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  { on = {}, ...properties }: Properties = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (value === undefined || value === null) continue;
    if (name === "class" || name.includes("-")) element.setAttribute(name, String(value));
    else (element as unknown as Record<string, unknown>)[name] = value;
  }
  listen(element, on);
  element.append(...children.filter((child): child is Node | string => child != null));
  return element;
}

const SVG = "http://www.w3.org/2000/svg";

/** A line icon of 20 x 20. */
export function icon(path: string): SVGSVGElement {
  const svg = document.createElementNS(SVG, "svg");
  svg.setAttribute("viewBox", "0 0 20 20");
  svg.setAttribute("aria-hidden", "true");
  const line = document.createElementNS(SVG, "path");
  line.setAttribute("d", path);
  svg.append(line);
  return svg;
}

export interface ButtonOptions {
  label?: string;
  icon?: string;
  title: string;
  class?: string;
  test?: string;
  part?: string; // names it among the buttons of its row
  click: (event: MouseEvent) => void;
}

export function button(options: ButtonOptions): HTMLButtonElement {
  return el(
    "button",
    {
      type: "button",
      class: options.class ?? "button",
      title: options.title,
      "aria-label": options.label ? undefined : options.title, // what is seen is its name, and the title describes it
      "data-test": options.test,
      "data-part": options.part,
      on: { click: options.click },
    },
    options.icon ? icon(options.icon) : null,
    options.label ? el("span", {}, options.label) : null,
  );
}

/** Shows or hides something. */
export function eye(visible: boolean, click: () => void): HTMLButtonElement {
  return button({
    icon: visible ? ICONS.eye : ICONS.eyeOff,
    title: visible ? "Hide" : "Show",
    class: "icon-button small" + (visible ? "" : " dimmed"),
    part: "eye",
    click,
  });
}
