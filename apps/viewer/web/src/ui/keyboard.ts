// SPDX-License-Identifier: Apache-2.0
import type { Navigation, PaneName } from "../model/navigation";
import type { Project } from "../model/project";
import type { ViewName } from "../net/protocol";
import type { Editor, ToolName } from "../tools/editor";

export interface KeyboardServices {
  navigation: Navigation;
  project: Project;
  editor: Editor;
  /** The view that keys are for. */
  focused(): ViewName;
  toggleSingle(pane: PaneName): void;
  undo(): void;
  redo(): void;
  help(): void;
  leave(): void;
  rename(): void;
}

const TOOL_KEYS: Record<string, ToolName> = { v: "edit", l: "wire", f: "freehand", s: "spline", r: "redraw", m: "move" };
const PANE_KEYS: Record<string, PaneName> = { "1": "axial", "2": "sagittal", "3": "coronal", "4": "oblique", "5": "surface" };
const SCROLL_KEYS: Record<string, number> = { ArrowUp: -1, ArrowDown: 1, ArrowLeft: -1, ArrowRight: 1, PageUp: -10, PageDown: 10 };
const KEY_ZOOM = 1.2;

/** The keys of the `?` sheet. Fields and dialogs keep theirs. */
export class Keyboard {
  spaceHeld = false;

  constructor(private readonly services: KeyboardServices) {
    window.addEventListener("keydown", (event) => this.down(event));
    window.addEventListener("keyup", (event) => {
      if (event.key === " ") this.spaceHeld = false;
    });
    window.addEventListener("blur", () => {
      this.spaceHeld = false;
    });
  }

  private down(event: KeyboardEvent): void {
    if (document.querySelector("dialog[open]") || isField(event.target)) return;
    const presses = event.target instanceof HTMLButtonElement && (event.key === "Enter" || event.key === " ");
    if (presses && !this.services.editor.drawing.sketch) return;
    const handled = event.ctrlKey || event.metaKey ? this.withControl(event) : this.plain(event);
    if (handled) event.preventDefault();
  }

  private withControl(event: KeyboardEvent): boolean {
    const key = event.key.toLowerCase();
    if (key === "z" && event.shiftKey) this.services.redo();
    else if (key === "z") this.services.undo();
    else if (key === "y") this.services.redo();
    else return false;
    return true;
  }

  private plain(event: KeyboardEvent): boolean {
    const { editor, navigation, focused, toggleSingle } = this.services;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const tool = TOOL_KEYS[key];
    const pane = PANE_KEYS[key];
    const steps = SCROLL_KEYS[key];
    if (tool) editor.choose(tool);
    else if (pane) toggleSingle(pane);
    else if (steps !== undefined) navigation.scroll(focused(), steps);
    else return this.action(key, event);
    return true;
  }

  private action(key: string, event: KeyboardEvent): boolean {
    const { editor, navigation, focused } = this.services;
    const { drawing, edits } = editor;
    switch (key) {
      case " ":
        this.spaceHeld = true;
        return true;
      case "Enter":
        drawing.close();
        return true;
      case "Escape":
        this.services.leave();
        return true;
      case "Backspace":
        if (drawing.sketch) drawing.removeLastPoint();
        else edits.deleteSelected();
        return true;
      case "Delete":
        edits.deleteSelected();
        return true;
      case "c":
        void edits.copySelected(focused(), event.shiftKey ? -1 : 1);
        return true;
      case "h":
        this.toggleHole();
        return true;
      case "k":
        navigation.toggleLinked();
        return true;
      case "x":
        editor.toggleLines();
        return true;
      case "+":
      case "=":
        navigation.zoomAt(focused(), navigation.crosshair, KEY_ZOOM);
        return true;
      case "-":
        navigation.zoomAt(focused(), navigation.crosshair, 1 / KEY_ZOOM);
        return true;
      case "0":
        navigation.setLayout("overview");
        return true;
      case "Home":
        navigation.resetAll();
        return true;
      case "F2":
        this.services.rename();
        return true;
      case "?":
        this.services.help();
        return true;
      default:
        return false;
    }
  }

  private toggleHole(): void {
    const { editor, project } = this.services;
    const contour = project.selectedContour;
    if (contour) editor.edits.make("contour.set", { id: contour.id, hole: !contour.hole });
  }
}

function isField(target: EventTarget | null): boolean {
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && (target.type === "text" || target.type === "number");
}
