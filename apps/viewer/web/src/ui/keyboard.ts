// SPDX-License-Identifier: Apache-2.0
import { COMMANDS, HELD_KEYS, PAN_KEY, type Command, type CommandServices, type HeldKey } from "./commands";

const COMMAND_OF_KEY: ReadonlyMap<string, Command> = new Map(COMMANDS.flatMap((command) => command.keys.map((key) => [key, command])));

/** The keys of the `?` sheet. Fields and dialogs keep theirs. */
export class Keyboard {
  private readonly held = new Set<HeldKey>();

  constructor(private readonly services: CommandServices) {
    window.addEventListener("keydown", (event) => this.down(event));
    window.addEventListener("keyup", (event) => this.release(({ key }) => key === letterOf(event)));
    window.addEventListener("blur", () => this.release(() => true)); // another window gets the keyup
  }

  get isPanning(): boolean {
    return this.held.has(PAN_KEY);
  }

  private down(event: KeyboardEvent): void {
    if (document.querySelector("dialog[open]") || isField(event.target)) return;
    if (event.key === "Escape" && document.querySelector(":popover-open")) return; // which it closes
    const presses =
      (event.target instanceof HTMLButtonElement && !event.altKey && (event.key === "Enter" || event.key === " ")) ||
      (isCheckbox(event.target) && event.key === " ");
    const { drawing, proposals } = this.services.editor;
    if (presses && !drawing.sketch && !(event.key === "Enter" && proposals.shown)) return;
    if (this.hold(event) || this.obey(event)) event.preventDefault();
  }

  private hold(event: KeyboardEvent): boolean {
    const key = HELD_KEYS.find((one) => one.key === keyOf(event));
    if (!key) return false;
    if (!this.held.has(key)) key.held?.(this.services, true);
    this.held.add(key);
    return true;
  }

  private release(isReleased: (key: HeldKey) => boolean): void {
    for (const key of [...this.held].filter(isReleased)) {
      this.held.delete(key);
      key.held?.(this.services, false);
    }
  }

  private obey(event: KeyboardEvent): boolean {
    const command = COMMAND_OF_KEY.get(keyOf(event));
    if (!command) return false;
    if (!command.edits || !this.services.editor.isAnotherTime()) command.run(this.services, event.shiftKey);
    return true;
  }
}

const letterOf = ({ key }: KeyboardEvent): string => (key.length === 1 ? key.toLowerCase() : key);
const ALT_KEYS = /^(Arrow.*|Enter)$/; // other keys type signs by it
const keyOf = (event: KeyboardEvent): string => {
  if (event.altKey && ALT_KEYS.test(event.key)) return `Alt+${event.key}`;
  return (event.ctrlKey || event.metaKey ? "Control+" : "") + letterOf(event);
};

const isCheckbox = (target: EventTarget | null): boolean => target instanceof HTMLInputElement && target.type === "checkbox";

function isField(target: EventTarget | null): boolean {
  if (target instanceof Element && target.closest("[popover]")) return true;
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && (target.type === "text" || target.type === "number");
}
