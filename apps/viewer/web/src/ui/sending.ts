// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { SendRequest } from "../net/protocol";
import { button, buttonPiece, el } from "../dom/dom";
import { render, type Child } from "../dom/pieces";
import type { Notices } from "./status";

const OBJECTS: readonly [SendRequest["name"], string][] = [
  ["seg.dcm", "DICOM SEG"],
  ["rtstruct.dcm", "DICOM RTSTRUCT"],
];

/** As people call it. */
export const objectLabel = (name: SendRequest["name"]): string => OBJECTS.find(([one]) => one === name)![1];

/** Says what was made before and did not arrive, and offers to send it again. */
export async function offerWaiting(http: Http, host: string, notices: Pick<Notices, "show">): Promise<void> {
  const names = await http.waitingForArchive().catch(() => []);
  for (const name of names) {
    const label = objectLabel(name);
    const again = () => {
      close();
      http.send(name, true, new AbortController().signal).then(
        ({ outcome, text }) => notices.show(outcome === "stored" ? "info" : "warning", `${label}: ${text}`),
        (error: unknown) => notices.show("error", `${label} was not sent: ${error instanceof Error ? error.message : String(error)}`),
      );
    };
    const close = notices.show("warning", `${label} was made before and did not arrive at ${host}.`, { label: "Try again", act: again });
  }
}

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
    void this.tellWaiting();
  }

  /** Ends what is on its way. */
  close(): void {
    this.running?.abort();
  }

  /** Of what did not arrive before, perhaps in another run of kontur. */
  private async tellWaiting(): Promise<void> {
    const names = await this.http.waitingForArchive().catch(() => []);
    const [name] = names;
    if (!name || this.running) return;
    const label = names.map(objectLabel).join(" and ");
    render(this.said, [`${label} did not arrive before.`, ...names.map((one) => this.again(one))]);
  }

  private again(name: SendRequest["name"]): Child {
    const label = objectLabel(name);
    return buttonPiece({
      label: "Try again",
      title: `Send ${label} as it was`,
      class: "choice",
      part: `again-${name}`,
      test: "send-again",
      click: () => void this.send(name, label, true),
    });
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
      outcome = [`${label} was not sent: ${why}`, this.again(name)];
    }
    if (this.running === own) render(this.said, outcome);
  }

  private choice(label: string, test: string, click: () => void): Child {
    return buttonPiece({ label, title: label, class: "choice", test, click });
  }
}
