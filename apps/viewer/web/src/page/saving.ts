// SPDX-License-Identifier: Apache-2.0
import { ServerError } from "../net/http";
import type { ConnectionState } from "../net/socket";
import type { Outbox } from "../tools/outbox";
import { shellWord } from "../model/shell";
import type { Remedy } from "../tools/services";
import type { Sketch } from "../tools/sketch";
import { copyText } from "../ui/copying";
import type { Notices, StatusBar } from "../ui/status";

const REFUSALS = new Set(["invalid_input", "not_found"]); // by which no work is lost: it could not be done

export interface SavingServices {
  status: StatusBar;
  notices: Notices;
  outbox(): Outbox;
  /** Where the project's file lies; undefined before one is open. */
  project(): string | undefined;
  token: string;
}

/** Whether all is saved, and what the user is told where it is not. */
export class Saving {
  connection: ConnectionState = "connecting";
  /** Edits that the server has not confirmed yet. */
  unsaved = 0;
  private editWasLost = false; // the last one
  private saidLost = false; // since the connection was open
  private readonly closeWhenConnected: (() => void)[] = [];
  private closeUnsavedNotice = () => {};

  constructor(private readonly services: SavingServices) {}

  connected(state: ConnectionState): void {
    if (state === "lost" && !this.saidLost) this.tellLost();
    if (state === "open") this.closeWhenConnected.splice(0).forEach((close) => close());
    this.saidLost = state === "lost" || (this.saidLost && state !== "open");
    this.connection = state;
    document.body.dataset["connection"] = state;
    this.tell();
  }

  countUnsaved(count: number, acknowledged: boolean): void {
    this.unsaved = count;
    if (acknowledged) this.editWasLost = false;
    this.tell();
  }

  /** In the status line. */
  tell(): void {
    const { hasUnsaved, isSending } = this.services.outbox();
    if (!hasUnsaved && !isSending) this.closeUnsavedNotice();
    this.services.status.setSaved(this.connection, isSending ? Math.max(this.unsaved, 1) : this.unsaved, hasUnsaved || this.editWasLost);
  }

  tellNotSaved(sketch: Sketch, why: string): void {
    this.closeUnsavedNotice();
    const stays = `${sketch.title} is not saved. It stays on its slice: Enter tries again, Esc gives it up.`;
    this.closeUnsavedNotice = this.services.notices.show("error", [why.replace(/\.?$/, "."), stays, this.rescueText()].join(" "), this.rescueCopy());
    this.tell();
  }

  /** While there is no connection only lost work is worth a word: that there is none has been said. Nor is what the page will be told anyway. */
  failed(error: unknown): void {
    if (error instanceof ServerError && error.kind === "gone") return;
    const isEdit = error instanceof ServerError && error.edits;
    if (isEdit && !REFUSALS.has(error.kind)) this.editWasLost = true;
    const isKnown = error instanceof ServerError && this.connection !== "open" && (!isEdit || error.kind === "lost");
    if (!isKnown) {
      const close = this.services.notices.show("error", error instanceof Error ? error.message : String(error));
      if (!isEdit) this.closeWhenConnected.push(close); // then what was asked for is asked for again
    }
    this.tell();
  }

  /** Whether nothing is on its way, and nothing waits to be. */
  get isDone(): boolean {
    const { hasUnsaved, isSending } = this.services.outbox();
    return this.unsaved === 0 && !isSending && !hasUnsaved;
  }

  /** Whoever starts kontur again gets another port and another key, so that this page cannot find it. */
  private tellLost(): void {
    const { notices, outbox } = this.services;
    const project = this.services.project();
    const text = project
      ? `The connection to kontur is lost. What was saved is in ${project}. While kontur runs this page connects again by itself; if kontur has ended, start it again with: kontur open ${shellWord(project)}, and use the address that it prints then.`
      : "No kontur answers at this address. If it was started again, use the address that it printed last.";
    const command = project && `kontur open ${shellWord(project)}`;
    this.closeWhenConnected.push(notices.show("error", text, command ? { label: "Copy the command", act: () => void copyText(command) } : undefined));
    if (this.unsaved > 0 && !outbox().isSending)
      notices.show(
        "error",
        "The connection was lost before kontur had confirmed your last edit: it may not be saved. Look for it when the page is connected again.",
      );
  }

  /** Only a kontur at this very address can take what this page alone still has. */
  private rescue(): string | null {
    const project = this.services.project();
    if (this.connection === "open" || project === undefined) return null;
    return `kontur open ${shellWord(project)} --port ${location.port} --token ${this.services.token}`;
  }

  private rescueText(): string {
    const command = this.rescue();
    return command ? `If kontur has ended, start it for this page: ${command}` : "";
  }

  private rescueCopy(): Remedy | undefined {
    const command = this.rescue();
    return command ? { label: "Copy the command", act: () => void copyText(command) } : undefined;
  }
}
