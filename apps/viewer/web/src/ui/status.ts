// SPDX-License-Identifier: Apache-2.0
import type { ConnectionState } from "../net/socket";
import type { Notice } from "../net/protocol";
import type { Remedy } from "../tools/services";
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { copyText } from "./copying";

/** The line at the bottom: cursor, what to do next, what is computed, whether all is saved. */
export class StatusBar {
  readonly element = el("footer", { class: "status" });
  private readonly cursor = el("span", { class: "cursor", "data-test": "cursor" });
  private readonly hint = el("span", { class: "hint" });
  private readonly work = el("span", { class: "work", "data-test": "work" });
  private readonly bar = el("progress", { max: 1, hidden: true });
  private readonly saved = el("span", { class: "saved", "data-test": "saved" });
  private project = "";
  private path = "";
  private readonly copy = button({
    icon: ICONS.copy,
    title: "Copy the place of the project",
    class: "icon-button small",
    test: "copy-path",
    click: () => void this.copyPath(),
  });
  private isReadOnly = false;
  private workTimer = 0;

  constructor() {
    this.element.append(this.cursor, this.hint, this.bar, this.work, this.saved, this.copy);
    this.copy.hidden = true;
    this.work.setAttribute("aria-live", "polite");
  }

  start(project: string, path: string, isReadOnly: boolean): void {
    this.project = project;
    this.path = path;
    this.saved.title = path;
    this.copy.hidden = false;
    this.isReadOnly = isReadOnly;
  }

  private async copyPath(): Promise<void> {
    this.setHint((await copyText(this.path)) ? `Copied: ${this.path}` : `The browser lets this page copy nothing. The project lies at ${this.path}`);
  }

  setCursor(text: string): void {
    this.cursor.textContent = text;
  }

  setHint(text: string): void {
    this.hint.textContent = text;
  }

  /** Work that is over within 0.15 s is not announced: a line that flickers tells nobody anything. */
  setWork(text: string, fraction: number | null): void {
    window.clearTimeout(this.workTimer);
    const show = () => {
      this.work.textContent = text;
      this.bar.hidden = text === "" || fraction === null;
      if (fraction !== null) this.bar.value = fraction;
    };
    if (text === "" || this.work.textContent !== "") show();
    else this.workTimer = window.setTimeout(show, 150);
  }

  /** `isMissing`: something that the user did is not in the project, nor on its way there. */
  setSaved(connection: ConnectionState, unsaved: number, isMissing: boolean): void {
    const isConnected = connection === "open" || connection === "silent";
    const state = !isConnected ? "lost" : connection === "silent" ? "silent" : unsaved > 0 ? "saving" : isMissing ? "unsaved" : "saved";
    const waits = unsaved > 0 ? "your last edit waits for it" : isMissing ? "not all is saved" : "the page waits for it";
    const texts = {
      silent: `kontur does not answer: ${waits}`,
      lost: isMissing ? "Not connected, not all is saved" : "Not connected",
      saving: "Saving…",
      unsaved: "Not all is saved",
      saved: `Saved in ${this.project}`,
    };
    const isAtRest = state === "saved" && this.isReadOnly;
    this.saved.textContent = isAtRest ? `Read only: ${this.project}` : texts[state];
    this.saved.dataset["state"] = isAtRest ? "read-only" : state;
  }
}

/** What kontur says of an image or an error begins small; names of files, and its own, stay as they are. */
export function asSentence(text: string): string {
  const word = /^[a-z]+(?=[ :,])/.exec(text)?.[0];
  return word && word !== "kontur" ? text.charAt(0).toUpperCase() + text.slice(1) : text;
}

const NOTICE_MS = 6000;
const REMEDY_MS = 15_000; // to read, and to reach for the button
const MOST_NOTICES = 4;

/** Sentences for the user, at the top of the views; errors, and warnings of what he can mend, stay until they are closed. */
export class Notices {
  readonly element = el("div", { class: "notices", role: "status" });

  /** Returns what takes the notice away. */
  show(level: Notice["level"], text: string, remedy?: Remedy): () => void {
    for (const old of this.element.querySelectorAll<HTMLElement>(".notice")) if (old.dataset["text"] === text) old.remove();
    const notice = el(
      "div",
      { class: `notice ${level}`, title: "Click to close", "data-text": text, on: { click: () => notice.remove() } },
      el("span", {}, asSentence(text)),
    );
    if (remedy) notice.append(button({ label: remedy.label, title: remedy.label, class: "choice", test: "remedy", click: remedy.act }));
    this.element.append(notice);
    while (this.element.children.length > MOST_NOTICES) this.leastImportant().remove();
    const stays = level === "error" || (level === "warning" && remedy);
    if (!stays) setTimeout(() => notice.remove(), remedy ? REMEDY_MS : NOTICE_MS);
    return () => notice.remove();
  }

  /** Of those that go by themselves the oldest, else the oldest of all. */
  private leastImportant(): Element {
    return this.element.querySelector(".notice.info, .notice.warning") ?? this.element.firstElementChild!;
  }

  /** Something that takes its time, with a button to end it. Returns what takes the notice away. */
  working(text: string, cancel: () => void): () => void {
    const stop = button({ label: "Cancel", title: "Cancel", class: "choice", test: "cancel", click: cancel });
    const notice = el("div", { class: "notice working" }, el("span", {}, text), stop);
    this.element.append(notice);
    return () => notice.remove();
  }
}
