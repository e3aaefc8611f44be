// SPDX-License-Identifier: Apache-2.0
import { Emitter } from "./emitter";

export type Scheme = "dark" | "light";

/** What can be chosen; what is not set is as the system has it. */
export const THEMES = [
  { name: "system", label: "As the system has them", scheme: null, contrast: null },
  { name: "dark", label: "Dark", scheme: "dark", contrast: "usual" },
  { name: "light", label: "Light", scheme: "light", contrast: "usual" },
  { name: "dark-contrast", label: "Dark, high contrast", scheme: "dark", contrast: "more" },
  { name: "light-contrast", label: "Light, high contrast", scheme: "light", contrast: "more" },
] as const;
export type ThemeName = (typeof THEMES)[number]["name"];

/** What the system, or the browser, asks of all pages. */
export interface SystemColors {
  prefersLight(): boolean;
  prefersContrast(): boolean;
  onChange(act: () => void): void;
}

/** Where the choice outlasts the page; "" where there is none. */
export interface ThemeStore {
  read(): string;
  write(name: ThemeName): void;
}

/** The page's colours: as the user chose them in this browser, for all projects. Slices are black in all of them. */
export class Theme extends Emitter<"changed"> {
  private chosen: (typeof THEMES)[number];

  constructor(
    private readonly system: SystemColors,
    private readonly store: ThemeStore,
  ) {
    super();
    const kept = store.read();
    this.chosen = THEMES.find(({ name }) => name === kept) ?? THEMES[0];
    system.onChange(() => this.emit("changed"));
  }

  get name(): ThemeName {
    return this.chosen.name;
  }

  get scheme(): Scheme {
    return this.chosen.scheme ?? (this.system.prefersLight() ? "light" : "dark");
  }

  get contrast(): "usual" | "more" {
    return this.chosen.contrast ?? (this.system.prefersContrast() ? "more" : "usual");
  }

  choose(name: ThemeName): void {
    this.chosen = THEMES.find((theme) => theme.name === name)!;
    this.store.write(name);
    this.emit("changed");
  }
}
