// SPDX-License-Identifier: Apache-2.0
import { COMMANDS, type Command, type CommandServices } from "./commands";

const COMMAND_OF_KEY: ReadonlyMap<string, Command> = new Map(COMMANDS.flatMap((command) => command.keys.map((key) => [key, command])));

/** The keys of the `?` sheet. Fields and dialogs keep theirs. */
export class Keyboard {
  spaceHeld = false;

  constructor(private readonly services: CommandServices) {
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
    if (event.key === " ") this.spaceHeld = true;
    else if (!this.obey(event)) return;
    event.preventDefault();
  }

  private obey(event: KeyboardEvent): boolean {
    const command = COMMAND_OF_KEY.get(keyOf(event));
    command?.run(this.services, event.shiftKey);
    return command !== undefined;
  }
}

function keyOf({ key, ctrlKey, metaKey }: KeyboardEvent): string {
  return (ctrlKey || metaKey ? "Control+" : "") + (key.length === 1 ? key.toLowerCase() : key);
}

function isField(target: EventTarget | null): boolean {
  if (target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement) return true;
  return target instanceof HTMLInputElement && (target.type === "text" || target.type === "number");
}
