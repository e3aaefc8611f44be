// SPDX-License-Identifier: Apache-2.0
import { ServerError, type Http } from "../net/http";
import type { FurtherImage, OpenRequest, Place } from "../net/protocol";
import { openDialog } from "../ui/dialogs";
import { buttonPiece, el } from "../dom/dom";
import { piece, render } from "../dom/pieces";
import { FolderView } from "./folder_view";
import { Problem } from "./problem";

export interface AddImageServices {
  http: Http;
  places: Place[];
  /** Where to begin to look. */
  folder: string;
  /** Frame of reference of the project's own image, or "". */
  frame: string;
  /** The one whose place it takes. */
  present: FurtherImage | null;
}

/** Chooses what is seen over the project's own image. It closes when that is there. */
export class AddImageDialog {
  private readonly problem: Problem;
  private readonly status = el("p", { class: "dialog-status", "aria-live": "polite", "data-test": "add-image-status" });
  private readonly folders: FolderView;
  private readonly dialog: HTMLDialogElement;
  private reading: AbortController | null = null;

  constructor(private readonly services: AddImageServices) {
    const { http, places, folder, frame, present } = services;
    this.problem = new Problem("add-image-problem", http);
    const words = { title: "An image of the same patient, on the same frame of reference", open: "Show this series over the image", onlyImages: true, frame };
    this.folders = new FolderView(http, { open: (request) => void this.add(request), problem: (sentence) => this.problem.set(sentence) }, words);
    const replaces = present && el("p", { class: "fine" }, `It takes the place of ${present.title}.`);
    this.dialog = openDialog(
      "Add a second image",
      "add-image-dialog",
      ...(replaces ? [replaces] : []),
      this.problem.element,
      this.folders.element,
      this.status,
    );
    this.dialog.classList.add("add-image");
    this.dialog.addEventListener("close", () => {
      this.reading?.abort();
      this.folders.stop();
    });
    this.folders.start(places, folder);
    this.folders.path.focus();
  }

  /** How far the server is with what it looks through, or reads. */
  setWork(text: string, fraction: number | null): void {
    if (!this.reading) return this.folders.setWork(text, fraction);
    const line = this.status.querySelector("span");
    if (line && text) line.textContent = fraction === null ? text : `${text}: ${Math.floor(100 * fraction)} %`;
  }

  private async add(request: OpenRequest): Promise<void> {
    this.reading?.abort();
    const own = (this.reading = new AbortController());
    this.problem.set("");
    const cancel = buttonPiece({ label: "Cancel", title: "Do not add it", class: "choice", test: "add-image-cancel", click: () => own.abort() });
    render(this.status, [piece("span", {}, "Reading…"), cancel]);
    try {
      await this.services.http.putImage(request, own.signal);
      this.dialog.close();
    } catch (error) {
      if (this.reading === own) this.failed(error, request);
    } finally {
      if (this.reading === own) {
        this.reading = null;
        render(this.status, []);
      }
    }
  }

  private failed(error: unknown, request: OpenRequest): void {
    const known = error instanceof ServerError ? error : null;
    if (known?.choices.frames !== undefined) return this.problem.askFrame(request, known.choices.frames, "to be shown", (chosen) => void this.add(chosen));
    if (known?.choices.transforms) return this.problem.askTransform(request, (chosen) => void this.add(chosen));
    if (known?.choices.uneven) return this.problem.askResampling(known.message, request, (chosen) => void this.add(chosen));
    if (known?.kind === "cancelled") this.problem.set("");
    else this.problem.tell(error);
  }
}
