// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { SendRequest } from "../net/protocol";
import { button, buttonPiece, el } from "../dom/dom";
import { render, type Child } from "../dom/pieces";

const OBJECTS: readonly [SendRequest["name"], string][] = [
  ["seg.dcm", "DICOM SEG"],
  ["rtstruct.dcm", "DICOM RTSTRUCT"],
];

/** What was made goes to the archive that the image came from, as new objects of its study. */
export class Sending {
  readonly element: HTMLElement;
  private readonly said = el("p", { class: "dialog-status", role: "status", "data-test": "sent" });
  private running: AbortController | null = null;

  constructor(
    private readonly http: Http,
    private readonly host: string,
  ) {
    const choices = OBJECTS.map(([name, label]) =>
      button({
        label,
        title: `Send all structures as ${label} to ${host}`,
        class: "choice",
        test: `send-${name}`,
        click: () => void this.send(name, label, false),
      }),
    );
    this.element = el(
      "div",
      { class: "export-group", "data-test": "sending" },
      el("h3", {}, `Send to ${host}`),
      el("p", { class: "fine" }, "As a new object of the image's study; nothing there is changed."),
      el("div", { class: "choices" }, ...choices),
      this.said,
    );
  }

  /** Ends what is on its way. */
  close(): void {
    this.running?.abort();
  }

  private async send(name: SendRequest["name"], label: string, again: boolean): Promise<void> {
    this.running?.abort();
    const own = (this.running = new AbortController());
    render(this.said, [`Sending ${label} to ${this.host} …`, this.choice("Cancel", "send-cancel", () => own.abort())]);
    let outcome: Child[];
    try {
      const { text } = await this.http.send(name, again, own.signal);
      outcome = [`${label}: ${text}`];
    } catch (error) {
      const why = error instanceof Error ? error.message : String(error);
      outcome = [`${label} was not sent: ${why}`, this.choice("Try again", "send-again", () => void this.send(name, label, true))];
    }
    if (this.running === own) render(this.said, outcome);
  }

  private choice(label: string, test: string, click: () => void): Child {
    return buttonPiece({ label, title: label, class: "choice", test, click });
  }
}
