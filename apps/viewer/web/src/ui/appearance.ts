// SPDX-License-Identifier: Apache-2.0
import { FILL_RANGE, WIDTH_RANGE, type Appearance, type SavedAppearance } from "../model/appearance";
import { THEMES, type Theme, type ThemeName } from "../model/theme";
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";

/** A button of the toolbar, and what it opens: how strongly outlines are filled, how wide lines are, and the page's colours. */
export function appearanceButton(appearance: Appearance, theme: Theme): HTMLElement[] {
  const fields = { fill: slider("fill", "Filling of outlines", FILL_RANGE, appearance), width: slider("width", "Width of lines", WIDTH_RANGE, appearance) };
  const sheet = el(
    "div",
    { class: "popover", popover: "auto", "data-test": "appearance-sheet" },
    ...Object.values(fields).map(({ label }) => label),
    themeField(theme),
  );
  const opener = button({
    icon: ICONS.appearance,
    title: "Filling of outlines, width of lines, colours of the page",
    class: "icon-button",
    test: "appearance",
    click: () => undefined,
  });
  opener.popoverTargetElement = sheet;
  appearance.on(["changed"], () => {
    fields.fill.input.value = String(appearance.fill);
    fields.width.input.value = String(appearance.width);
  });
  return [opener, sheet];
}

function themeField(theme: Theme): HTMLElement {
  const options = THEMES.map(({ name, label }) => el("option", { value: name, selected: name === theme.name }, label));
  const choice = el("select", { "data-test": "theme", on: { change: () => theme.choose(choice.value as ThemeName) } }, ...options);
  return el("label", { class: "field" }, "Colours of the page", choice);
}

function slider(name: keyof SavedAppearance, words: string, [min, max]: readonly [number, number], appearance: Appearance) {
  const set = () => appearance.set({ [name]: input.valueAsNumber });
  const input = el("input", { type: "range", min: String(min), max: String(max), step: "0.01", "data-test": `appearance-${name}`, on: { input: set } });
  input.value = String(appearance[name]);
  return { input, label: el("label", { class: "field" }, words, input) };
}
