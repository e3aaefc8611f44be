// SPDX-License-Identifier: Apache-2.0
import { Theme, type SystemColors, type ThemeStore } from "../model/theme";

const KEPT_S = 365 * 24 * 3600;

const LIGHT = window.matchMedia("(prefers-color-scheme: light)");
const CONTRAST = window.matchMedia("(prefers-contrast: more)");

const system: SystemColors = {
  prefersLight: () => LIGHT.matches,
  prefersContrast: () => CONTRAST.matches,
  onChange: (act) => [LIGHT, CONTRAST].forEach((query) => void query.addEventListener("change", act)),
};

/** A cookie: the browser's own storage is another one for each port, and each start of kontur has its own port. */
const store: ThemeStore = {
  read: () => /(?:^|; )kontur-theme=([a-z-]+)/.exec(document.cookie)?.[1] ?? "",
  write: (name) => void (document.cookie = `kontur-theme=${name}; path=/; max-age=${KEPT_S}; SameSite=Strict`),
};

/** Of the whole document, which follows it from now on. */
export function themeOfPage(): Theme {
  const theme = new Theme(system, store);
  const apply = () => {
    const { dataset } = document.documentElement;
    dataset["theme"] = theme.scheme;
    dataset["contrast"] = theme.contrast;
  };
  theme.on(["changed"], apply);
  apply();
  return theme;
}
