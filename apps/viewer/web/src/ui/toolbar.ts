// SPDX-License-Identifier: Apache-2.0
import type { Appearance } from "../model/appearance";
import type { LayoutName, Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { Theme } from "../model/theme";
import type { Preset, Session } from "../net/protocol";
import type { Editor } from "../tools/editor";
import { TOOLS, type ToolName } from "../tools/registry";
import { appearanceButton } from "./appearance";
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { Overflow } from "./overflow";
import { render, setValue } from "../dom/pieces";
import { presetOptions, windowField } from "./window_field";

export interface ToolbarServices {
  navigation: Navigation;
  appearance: Appearance;
  theme: Theme;
  project: Project;
  editor: Editor;
  undo(): void;
  redo(): void;
  /** Back to the start page. */
  openAnother(): void;
  /** Chooses an image to see over this one. */
  addImage(): void;
  openExport(): void;
  openImport(): void;
  openHelp(): void;
}

const LAYOUTS: [LayoutName, string, string][] = [
  ["overview", ICONS.overview, "Four slices beside the 3D view"],
  ["big-slice", ICONS.bigSlice, "One view big, the others beside it"],
  ["big-surface", ICONS.bigSurface, "The 3D view big"],
  ["single", ICONS.single, "One view alone"],
];

const USUAL_DIGITS = 5; // for which a field of the window has room

export class Toolbar {
  readonly element = el("header", { class: "toolbar", role: "toolbar", "aria-label": "Tools" });
  private readonly tools = new Map<ToolName, HTMLButtonElement>();
  private readonly layouts = new Map<LayoutName, HTMLButtonElement>();
  private readonly undo: HTMLButtonElement;
  private readonly redo: HTMLButtonElement;
  private readonly openLines: HTMLButtonElement;
  private readonly link: HTMLButtonElement;
  private readonly another: HTMLButtonElement;
  private readonly addImage: HTMLButtonElement;
  private readonly presets = el("select", { title: "Window presets", class: "presets", "data-test": "presets", on: { change: () => this.choosePreset() } });
  private readonly center = windowField(
    "Window: centre (drag with the right button over a slice)",
    () => this.typeWindow(),
    () => this.update(),
  );
  private readonly width = windowField(
    "Window: width",
    () => this.typeWindow(),
    () => this.update(),
  );
  private readonly title = el("span", { class: "file-title" });
  private readonly overflow: Overflow;
  private areLong = false; // the numbers of the window, for which their fields become wider
  private presetList: Preset[] = [];

  constructor(private readonly services: ToolbarServices) {
    const { navigation, editor } = services;
    for (const { id, label, key, title, icon, isMinor } of TOOLS)
      this.tools.set(
        id,
        button({
          icon,
          label,
          title: `${title} (${key.toUpperCase()})`,
          class: isMinor ? "tool minor" : "tool",
          test: `tool-${id}`,
          click: () => editor.choose(id),
        }),
      );
    for (const [layout, path, title] of LAYOUTS)
      this.layouts.set(layout, button({ icon: path, title, class: "icon-button", test: `layout-${layout}`, click: () => navigation.setLayout(layout) }));
    this.openLines = button({
      icon: ICONS.openLine,
      title: "Draw open lines: stretches of the border that do not close (Shift+U)",
      class: "icon-button",
      test: "open-lines",
      click: () => editor.drawing.setEndsOpen(!editor.drawing.endsOpen),
    });
    this.undo = button({ icon: ICONS.undo, title: "Undo", class: "icon-button", test: "undo", click: services.undo });
    this.redo = button({ icon: ICONS.redo, title: "Redo", class: "icon-button", test: "redo", click: services.redo });
    this.link = button({
      icon: ICONS.link,
      title: "Zoom and shift all slices together (K)",
      class: "icon-button",
      test: "link",
      click: () => navigation.toggleLinked(),
    });
    this.another = button({
      icon: ICONS.open,
      title: "Open another image or project; this one is kept as it is",
      class: "icon-button",
      test: "another",
      click: services.openAnother,
    });
    this.addImage = button({
      icon: ICONS.second,
      title: "Add a second image, to see it over this one",
      class: "icon-button",
      test: "add-image",
      click: services.addImage,
    });
    const windows = group(el("label", { class: "window-label" }, "Window"), this.presets, this.center, this.width);
    const layouts = group(...this.layouts.values());
    const looks = group(
      button({ icon: ICONS.lines, title: "Show or hide the plane lines (X)", class: "icon-button", test: "lines", click: () => editor.toggleLines() }),
      this.link,
      ...appearanceButton(services.appearance, services.theme),
    );
    const files = group(
      button({ icon: ICONS.import, title: "Import contours or a mask", class: "icon-button", test: "import", click: services.openImport }),
      button({
        icon: ICONS.export,
        label: "Export",
        title: "Export mask, mesh, contours, project or picture",
        class: "tool minor",
        test: "export",
        click: services.openExport,
      }),
      button({ icon: ICONS.help, title: "Mouse and keyboard (?)", class: "icon-button", test: "help", click: services.openHelp }),
    );
    this.element.append(
      el("span", { class: "brand" }, "kontur"),
      this.another,
      this.addImage,
      this.title,
      group(...this.tools.values(), this.openLines),
      group(this.undo, this.redo),
      el("span", { class: "spring" }),
      windows,
      layouts,
      looks,
      files,
    );
    this.overflow = new Overflow(this.element, [looks, layouts, files, windows]);
    editor.on(["tool"], () => this.update());
    editor.drawing.on(["points"], () => this.update());
    navigation.on(["layout", "window"], () => this.update());
    services.project.on(["history"], () => this.update());
  }

  start({ title, presets, can_close }: Pick<Session, "title" | "presets" | "can_close">): void {
    this.another.hidden = this.addImage.hidden = !can_close;
    this.title.textContent = title;
    this.title.title = title;
    this.presetList = presets;
    render(this.presets, presetOptions(presets));
    this.update();
    this.overflow.fit(true);
  }

  private update(): void {
    const { editor, navigation, project } = this.services;
    for (const [tool, element] of this.tools) press(element, tool === editor.tool.id);
    for (const [layout, element] of this.layouts) press(element, layout === navigation.layout);
    const { undo, redo } = project.history;
    const { drawing } = editor;
    describe(this.undo, drawing.undoLabel ?? undo, "Undo", "Ctrl+Z");
    describe(this.redo, drawing.redoLabel ?? (drawing.sketch ? null : redo), "Redo", "Ctrl+Shift+Z");
    press(this.openLines, drawing.endsOpen);
    press(this.link, navigation.linked);
    const { center, width } = navigation.window;
    setValue(this.center, short(center));
    setValue(this.width, short(width));
    const areLong = Math.max(this.center.value.length, this.width.value.length) > USUAL_DIGITS;
    if (areLong !== this.areLong) this.overflow.fit(true);
    this.areLong = areLong;
    const preset = this.presetList.findIndex((entry) => short(entry.center) === short(center) && short(entry.width) === short(width));
    this.presets.value = preset < 0 ? "" : String(preset);
  }

  private choosePreset(): void {
    const preset = this.presetList[Number(this.presets.value)];
    if (preset) this.services.navigation.setWindow({ center: preset.center, width: preset.width });
    this.presets.blur();
  }

  private typeWindow(): void {
    const center = this.center.valueAsNumber;
    const width = this.width.valueAsNumber;
    if (Number.isFinite(center) && width > 0) this.services.navigation.setWindow({ center, width });
  }
}

const group = (...children: HTMLElement[]): HTMLElement => el("div", { class: "group" }, ...children);

const short = (value: number): string => (Math.abs(value) >= 10 ? value.toFixed(0) : value.toPrecision(3));

function press(element: HTMLElement, pressed: boolean): void {
  element.setAttribute("aria-pressed", String(pressed));
}

function describe(element: HTMLButtonElement, what: string | null, verb: string, keys: string): void {
  element.disabled = what === null;
  element.title = what === null ? `Nothing to ${verb.toLowerCase()}` : `${verb}: ${what} (${keys})`;
}
