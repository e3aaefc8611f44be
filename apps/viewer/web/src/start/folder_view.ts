// SPDX-License-Identifier: Apache-2.0
import { ServerError, type Http } from "../net/http";
import type { Folder, ListedFile, OpenRequest, Place } from "../net/protocol";
import { button, buttonPiece, el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";
import { ICONS } from "../dom/icons";
import { VolumeCards } from "./volume_cards";

interface FolderServices {
  open(request: OpenRequest): void;
  /** A sentence for the user; "": there is nothing to say. */
  problem(sentence: string): void;
}

interface FolderWords {
  title: string;
  /** What a click on a series does. */
  open: string;
  onlyImages?: boolean; // no projects
  /** Series of this frame of reference come first, and all say how they lie to it. */
  frame?: string;
}

/** A chooser of what lies on the server's disk, as far as the server shows it: places, folders, images, DICOM volumes. */
export class FolderView {
  readonly element = el("section", { class: "start-folder", "aria-label": "Files and folders" });
  private readonly places = el("div", { class: "start-places", role: "group", "aria-label": "Places" });
  readonly path = el("input", {
    type: "text",
    class: "start-field",
    title: "Folder or file",
    "aria-label": "Folder or file",
    spellcheck: false,
    autocomplete: "off",
    "data-test": "path",
    on: { keydown: (event) => this.typed(event) },
  });
  private readonly filter = el("input", {
    type: "text",
    class: "start-filter",
    placeholder: "Filter",
    "aria-label": "Filter by name",
    spellcheck: false,
    autocomplete: "off",
    "data-test": "filter",
    on: { input: () => this.fill() },
  });
  private readonly up = button({ icon: ICONS.up, title: "The folder above", class: "icon-button", test: "folder-up", click: () => this.goUp() });
  private readonly work = el("p", { class: "start-work", "aria-live": "polite", hidden: true });
  private readonly list = el("ul", { class: "start-list", "data-test": "entries" });
  private readonly cards: VolumeCards;
  private shown: Folder | null = null;
  private request = new AbortController();

  constructor(
    private readonly http: Http,
    private readonly services: FolderServices,
    private readonly words: FolderWords = { title: "Open", open: "Open this series" },
  ) {
    this.cards = new VolumeCards(http, services.open, words.open, words.frame);
    this.element.append(
      el("h2", {}, words.title),
      this.places,
      el("div", { class: "start-way" }, this.up, this.path, this.filter),
      this.work,
      this.cards.element,
      this.list,
    );
  }

  start(places: Place[], folder: string): void {
    render(
      this.places,
      places.map(({ name, path }) => buttonPiece({ label: name, title: path, class: "choice", test: "place", click: () => void this.go(path) })),
    );
    const first = this.shown?.path ?? (folder || places[0]?.path);
    if (first) void this.go(first);
  }

  stop(): void {
    this.request.abort();
  }

  setWork(text: string, fraction: number | null): void {
    this.work.hidden = text === "";
    this.work.textContent = fraction === null ? text : `${text}: ${Math.floor(100 * fraction)} %`;
  }

  private typed(event: KeyboardEvent): void {
    if (event.key !== "Enter") return;
    void this.go(this.path.value.trim());
  }

  private goUp(): void {
    if (this.shown?.parent) void this.go(this.shown.parent);
  }

  /** Shows a folder; what is none is opened. */
  private async go(path: string): Promise<void> {
    this.request.abort();
    this.request = new AbortController();
    const { signal } = this.request;
    const typed = this.path.value;
    try {
      const folder = await this.http.folder(path, signal);
      this.show(folder);
      if (this.path.value === typed) this.path.value = folder.path; // else someone types
      await this.showVolumes(folder, signal);
    } catch (error) {
      if (signal.aborted) return;
      if (error instanceof ServerError && error.message.endsWith("is no folder")) return this.services.open({ path });
      this.services.problem(error instanceof Error ? error.message : String(error));
    }
  }

  private show(folder: Folder): void {
    this.services.problem("");
    this.shown = folder;
    this.filter.value = "";
    this.up.disabled = folder.parent === null;
    this.fill();
  }

  private fill(): void {
    if (!this.shown) return;
    const { folders, files, left_out, dicom } = this.shown;
    const wanted = this.filter.value.trim().toLowerCase();
    const fits = ({ name }: Place) => name.toLowerCase().includes(wanted);
    const images = files.filter((file) => file.kind === "image" && !file.name.toLowerCase().endsWith(".seg.nrrd"));
    const rows = [
      ...(dicom === "none" && images.length > 1 && left_out === 0 ? [this.framesRow(images.length)] : []),
      ...folders.filter(fits).map((one) => this.folderRow(one)),
      ...files.filter((file) => fits(file) && (file.kind === "image" || !this.words.onlyImages)).map((one) => this.fileRow(one)),
    ];
    const nothing = dicom === "none" ? "There is no image, project or folder here." : "";
    if (rows.length === 0) rows.push(piece("li", { class: "empty" }, wanted ? "No name contains this." : nothing));
    if (left_out > 0) rows.push(piece("li", { class: "empty" }, `${left_out} more ${left_out === 1 ? "is" : "are"} not shown.`));
    render(this.list, rows);
    this.list.dataset["folder"] = this.shown.path;
  }

  private folderRow({ name, path }: Place): Piece {
    const row = buttonPiece({ icon: ICONS.folder, label: name, title: path, class: "start-row folder", test: "folder", click: () => void this.go(path) });
    return piece("li", { key: path }, row);
  }

  /** Of a folder with a file for each frame. */
  private framesRow(count: number): Piece {
    const { path } = this.shown!;
    const label = `These ${count} images as frames over time`;
    const title = "Opens the folder: the files are frames of one image, in the order in which their names count";
    return piece(
      "li",
      { key: "frames" },
      buttonPiece({ icon: ICONS.play, label, title, class: "start-row frames", test: "frames", click: () => this.services.open({ path }) }),
    );
  }

  private fileRow(file: ListedFile): Piece {
    const { name, path, kind } = file;
    const row = buttonPiece(
      {
        icon: kind === "project" ? ICONS.surface : kind === "drawing" ? ICONS.openLine : ICONS.file,
        label: kind === "drawing" ? `${name} (structures; opens their images, too)` : name,
        title: path,
        class: "start-row file",
        test: "file",
        click: () => this.services.open({ path }),
      },
      piece("span", { class: "start-size" }, sizeText(file.bytes)),
      piece("span", { class: "start-date" }, new Date(1000 * file.modified).toLocaleDateString()),
    );
    return piece("li", { key: path }, row);
  }

  private async showVolumes(folder: Folder, signal: AbortSignal): Promise<void> {
    this.cards.clear();
    if (folder.dicom === "none") return;
    this.setWork("Looking through DICOM files", null);
    try {
      const volumes = await this.http.volumes(folder.path, signal);
      if (!signal.aborted) await this.cards.show(folder.path, volumes, signal);
    } finally {
      if (!signal.aborted) this.setWork("", null);
    }
  }
}

export function sizeText(bytes: number): string {
  const units = ["bytes", "kB", "MB", "GB"];
  const step = Math.min(units.length - 1, Math.max(0, Math.floor(Math.log10(Math.max(bytes, 1)) / 3)));
  const value = bytes / 1000 ** step;
  return `${value < 10 && step > 0 ? value.toFixed(1) : Math.round(value)} ${units[step]}`;
}
