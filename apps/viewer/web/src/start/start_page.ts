// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { Failed, OpeningState, OpenRequest, RecentProject, Start } from "../net/protocol";
import type { ConnectionState } from "../net/socket";
import { button, buttonPiece, el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";
import { ArchiveView } from "./archive_view";
import { ArrivingView } from "./arriving_view";
import { FolderView } from "./folder_view";
import { Problem } from "./problem";

const ENDED = "There is no connection to kontur. If it has ended, start it again and open the address that it prints.";

/** What is seen while no image is open: what was worked on last, a chooser of files and folders, and how far reading is. */
export class StartPage {
  readonly element = el("dialog", { class: "start", "aria-label": "Open an image", "data-test": "start" });
  private readonly version = el("span", { class: "fine" });
  private readonly problem: Problem;
  private readonly recent = el("ul", { class: "start-list" });
  private readonly archive: ArchiveView;
  private readonly folders: FolderView;
  private readonly opening = el("section", { class: "opening", "aria-label": "Opening", "data-test": "opening", hidden: true });
  private readonly openingTitle = el("h2", {});
  private readonly openingStage = el("p", { "aria-live": "polite" });
  private readonly arriving: ArrivingView;
  private readonly openingBar = el("progress", { max: 1, "aria-label": "Read so far" });
  private example = "";
  private asked: OpenRequest | null = null;
  private locating: string | null = null; // the project whose image is looked for

  constructor(private readonly http: Http) {
    this.problem = new Problem("start-problem", http);
    this.folders = new FolderView(http, { open: (request) => void this.open(request), problem: (sentence) => this.problem.set(sentence) });
    this.archive = new ArchiveView(http, {
      open: (request) => void this.attempt(() => this.http.openArchived(request)),
      problem: (sentence) => this.problem.set(sentence),
    });
    this.arriving = new ArrivingView(http);
    const cancel = button({
      label: "Cancel",
      title: "Do not open it",
      class: "choice",
      test: "opening-cancel",
      click: () => void this.attempt(() => this.http.cancelOpening()),
    });
    const example = button({
      label: "Try the example",
      title: "A synthetic abdomen: draw in it what you like",
      class: "choice",
      test: "example",
      click: () => void this.open({ path: this.example }),
    });
    this.opening.append(this.openingTitle, this.arriving.element, this.openingStage, this.openingBar, cancel);
    this.element.append(
      el("header", { class: "start-head" }, el("h1", {}, "kontur"), this.version, el("span", { class: "spring" }), example),
      this.problem.element,
      el(
        "div",
        { class: "start-columns" },
        el("section", { class: "start-recent", "aria-label": "Recent projects" }, el("h2", {}, "Go on with"), this.recent),
        this.archive.element,
        this.folders.element,
      ),
      this.opening,
      el("p", { class: "fine" }, "Research software, not a medical device."),
    );
    this.element.addEventListener("cancel", (event) => event.preventDefault()); // Esc closes a dialog, and there is nothing behind this one
  }

  show(start: Start): void {
    this.version.textContent = start.version;
    this.example = start.example;
    render(this.recent, this.recentRows(start.recent));
    this.problem.set(start.sentence);
    this.setOpening(start.opening);
    if (!this.element.open) this.element.showModal();
    (this.recent.querySelector("button") ?? this.folders.path).focus();
    this.folders.start(start.places, start.folder);
    this.archive.start(start.archive);
  }

  hide(): void {
    this.folders.stop();
    this.archive.stop();
    this.arriving.stop();
    this.element.close();
  }

  setOpening(state: OpeningState | null): void {
    this.opening.hidden = state === null;
    if (!state) return this.arriving.stop();
    this.problem.set("");
    this.openingTitle.textContent = `Opening ${state.title}`;
    this.openingStage.textContent = stageText(state);
    if (state.fraction > 0) this.openingBar.value = state.fraction;
    else this.openingBar.removeAttribute("value");
    if (state.stage === "fetch") void this.arriving.update();
  }

  failed({ kind, message, frames, transforms, uneven, moved }: Failed["error"]): void {
    this.setOpening(null);
    if (moved !== undefined && this.asked) return this.askPlace(this.asked.path, moved);
    if (frames !== undefined && this.asked) return this.problem.askFrame(this.asked, frames, "to be opened", (chosen) => void this.open(chosen));
    if (transforms && this.asked) return this.problem.askTransform(this.asked, (chosen) => void this.open(chosen));
    if (uneven && this.asked) return this.problem.askResampling(message, this.asked, (chosen) => void this.open(chosen));
    this.problem.set(kind === "cancelled" ? "" : message);
  }

  setWork(text: string, fraction: number | null): void {
    this.folders.setWork(text, fraction);
  }

  connected(state: ConnectionState): void {
    if (state !== "lost" || !this.element.open) return;
    this.setOpening(null);
    this.problem.add(ENDED); // why has been said, if it was for the image
  }

  private recentRows(projects: RecentProject[]): Piece[] {
    if (projects.length === 0) return [piece("li", { class: "empty" }, "What you open is listed here, with all that was drawn in it.")];
    return projects.map(({ path, title, image, second, time }) => {
      const row = buttonPiece(
        {
          title: `${path}, drawn on ${image}${second && `, with ${second}`}`,
          class: "start-row",
          test: "recent",
          click: () => void this.open({ path }),
          more: { "aria-label": `${title}${second && `, with ${second}`}, ${path}` },
        },
        piece("strong", {}, title),
        piece("span", {}, whenText(time)),
        second ? piece("span", { class: "start-second" }, `with ${second}`) : null,
        piece("span", { class: "start-path" }, image),
      );
      return piece("li", { key: path }, row);
    });
  }

  private askPlace(project: string, image: string): void {
    this.problem.askPlace(image, () => {
      this.locating = project;
      this.problem.set(`Choose the image of ${project} below, in its new place. A project that is chosen is opened instead.`);
      this.folders.path.focus();
    });
  }

  /** An image that is chosen while a project's is looked for is that project's. */
  private located(request: OpenRequest): OpenRequest {
    const project = this.locating;
    this.locating = null;
    const isProject = request.path.endsWith(".kontur") || request.path === this.example;
    return project && !isProject ? { ...request, path: project, image: request.path } : request;
  }

  private open(wanted: OpenRequest): Promise<void> {
    const request = this.located(wanted);
    this.asked = request;
    this.problem.set("");
    return this.attempt(() => this.http.open(request));
  }

  private async attempt(act: () => Promise<void>): Promise<void> {
    try {
      await act();
    } catch (error) {
      this.problem.tell(error);
    }
  }
}

const STAGES: Record<string, string> = {
  fetch: "Fetching from the archive",
  "read headers": "Looking at the files",
  "read slices": "Reading slices",
  "read voxels": "Reading",
  "look at values": "Looking at the values",
};

function stageText({ stage, fraction }: OpeningState): string {
  const text = STAGES[stage] ?? (stage ? stage.charAt(0).toUpperCase() + stage.slice(1) : "Reading");
  return fraction > 0 && fraction < 1 ? `${text}: ${Math.floor(100 * fraction)} %` : `${text}…`;
}

function whenText(time: string): string {
  const then = new Date(time);
  if (Number.isNaN(then.getTime())) return "";
  const isToday = then.toDateString() === new Date().toDateString();
  return isToday ? `today ${then.toLocaleTimeString([], { hour: "2-digit", minute: "2-digit" })}` : then.toLocaleDateString();
}
