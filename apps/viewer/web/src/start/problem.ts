// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { OpenRequest } from "../net/protocol";
import { button, el } from "../dom/dom";
import { frameChoice } from "./frame_choice";
import { FramePictures } from "./frame_pictures";

/** Where a chooser of images says what stands in the way, and asks for what is missing. */
export class Problem {
  readonly element: HTMLElement;

  private readonly pictures: FramePictures;

  constructor(test: string, http: Http) {
    this.pictures = new FramePictures(http);
    this.element = el("p", { class: "start-problem", role: "alert", "data-test": test, hidden: true });
  }

  /** A sentence, whose first letter and full stop may be missing; "": there is nothing to say. */
  set(sentence: string): void {
    this.element.hidden = sentence === "";
    this.element.textContent = sentence && sentence.charAt(0).toUpperCase() + sentence.slice(1).replace(/[.?]?$/, (end) => end || ".");
  }

  /** What is said already stays. */
  add(sentence: string): void {
    const said = this.element.textContent ?? "";
    if (this.element.hidden) this.set(sentence);
    else if (!said.includes(sentence)) this.set(`${said} ${sentence}`);
  }

  /** A project's image is not where it was: asks for its new place. */
  askPlace(image: string, locate: () => void): void {
    this.set(`The image of this project is not at ${image} any more. If it has moved, show where it is now.`);
    const go = button({ label: "Locate the image", title: "Choose the image in its new place below", class: "choice", test: "locate", click: locate });
    this.element.append(" ", go);
    go.focus();
  }

  tell(error: unknown): void {
    this.set(error instanceof Error ? error.message : String(error));
  }

  /** Asks which of a file's frames `is` "to be opened", and goes on with that one. */
  askFrame(request: OpenRequest, frames: number, is: string, goOn: (request: OpenRequest) => void): void {
    const say = (sentence: string) => {
      this.set(sentence);
      this.element.append(choice.element);
    };
    const choice = frameChoice(frames, {
      choose: (frame) => goOn({ ...request, frame }),
      wrong: say,
      paint: (canvas, frame) => this.pictures.show(canvas, request.image ?? request.path, frame),
    });
    say(`${request.path} has ${frames} frames. Which one is ${is}?`);
    choice.focus();
  }

  /** Slices lie unevenly: offers to open them with others between them. */
  askResampling(sentence: string, request: OpenRequest, goOn: (request: OpenRequest) => void): void {
    this.set(sentence.replace(/;[^;]*$/, "")); // the rest names options of the command line
    const go = button({
      label: "Resample the slices",
      title: "Open them in even steps, interpolated between the slices that are there",
      class: "choice",
      test: "resample",
      click: () => goOn({ ...request, resample_slices: true }),
    });
    this.element.append(" ", go);
    go.focus();
  }

  /** Asks which of two that differ says where the image lies. */
  askTransform(request: OpenRequest, goOn: (request: OpenRequest) => void): void {
    this.set(
      `${request.path} says in two ways where it lies in the patient, which differ. Programs mostly go by the sform; the qform is what the scanner wrote.`,
    );
    const by = (prefer: "sform" | "qform") =>
      button({
        label: `By the ${prefer}`,
        title: `Open it by its ${prefer}`,
        class: "choice",
        test: `by-${prefer}`,
        click: () => goOn({ ...request, prefer }),
      });
    const first = by("sform");
    this.element.append(" ", first, " ", by("qform"));
    first.focus();
  }
}
