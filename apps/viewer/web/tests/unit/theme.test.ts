// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Theme, THEMES, type ThemeStore } from "../../src/model/theme";
import { least, VISION } from "./colors";

function system(isLight: boolean, hasContrast = false) {
  const listeners: (() => void)[] = [];
  const colors = { isLight, prefersLight: () => colors.isLight, prefersContrast: () => hasContrast, onChange: (act: () => void) => void listeners.push(act) };
  return { colors, change: (light: boolean) => ((colors.isLight = light), listeners.forEach((act) => act())) };
}

function store(kept = ""): ThemeStore {
  return { read: () => kept, write: (name) => void (kept = name) };
}

test("without a choice, or with one that is not known, the theme is the system's, and changes with it", () => {
  for (const kept of ["", "pink"]) {
    const { colors, change } = system(true, true);
    const theme = new Theme(colors, store(kept));
    assert.deepEqual([theme.name, theme.scheme, theme.contrast], ["system", "light", "more"]);
    let changes = 0;
    theme.on(["changed"], () => ++changes);
    change(false);
    assert.deepEqual([theme.scheme, changes], ["dark", 1]);
  }
});

test("a choice counts for more than the system's wish, and outlasts the page", () => {
  const kept = store();
  const theme = new Theme(system(false, true).colors, kept);
  for (const { name, scheme, contrast } of THEMES.slice(1)) {
    theme.choose(name);
    const next = new Theme(system(scheme === "dark").colors, kept);
    for (const one of [theme, next]) assert.deepEqual([one.name, one.scheme, one.contrast], [name, scheme, contrast]);
  }
});

/** The light and the dark colour of this name: first the usual one, then the one of high contrast. */
function colorsOf(name: string): string[] {
  const css = readFileSync("src/themes.css", "utf8");
  return [...css.matchAll(new RegExp(`--${name}: light-dark\\((#[0-9a-f]{6}), (#[0-9a-f]{6})\\)`, "g"))].flatMap(([, light, dark]) => [light!, dark!]);
}

test("colours that mean something differ in every theme for readers of any colour vision", () => {
  const [accent, warn, error] = ["accent", "warn", "error"].map(colorsOf);
  assert.equal(accent!.length, 4);
  for (const [name, vision] of Object.entries(VISION))
    accent!.forEach((color, theme) => {
      for (const other of [warn, error])
        assert.ok(least([color, other![theme]!], vision) > 18, `${name}, theme ${theme}: ${color} ${other![theme]} ${least([color, other![theme]!], vision)}`);
    });
});
