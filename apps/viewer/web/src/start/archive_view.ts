// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { ArchivedRequest, ArchivedSeries, ArchivedStudy } from "../net/protocol";
import { button, buttonPiece, el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";

interface ArchiveServices {
  open(request: ArchivedRequest): void;
  /** A sentence for the user; "": there is nothing to say. */
  problem(sentence: string): void;
}

const FIELDS = [
  { name: "name", label: "Name", title: "The patient's name begins so, family name first; * and ? stand for others" },
  { name: "id", label: "Number", title: "The patient's number; * and ? stand for others" },
  { name: "date", label: "Date", title: "YYYY-MM-DD, or FROM..TO" },
  { name: "modality", label: "Modality", title: "Such as CT or MR" },
] as const;

/** The studies of the archive that the command named, and the series of one of them. */
export class ArchiveView {
  readonly element = el("section", { class: "start-folder start-archive", "aria-label": "Archive", "data-test": "archive", hidden: true });
  private readonly title = el("h2", {});
  private readonly work = el("p", { class: "start-work", "aria-live": "polite", hidden: true });
  private readonly list = el("ul", { class: "start-list", "data-test": "studies" });
  private readonly series = el("div", { class: "volumes", "data-test": "archived-series" });
  private readonly fields = FIELDS.map(({ name, label, title }) => ({
    name,
    input: el("input", {
      type: "text",
      class: "start-filter",
      placeholder: label,
      title,
      "aria-label": `${label}: ${title}`,
      spellcheck: false,
      autocomplete: "off",
      "data-test": `archive-${name}`,
      on: { keydown: (event) => void (event.key === "Enter" && this.search()) },
    }),
  }));
  private request = new AbortController();

  constructor(
    private readonly http: Http,
    private readonly services: ArchiveServices,
  ) {
    const search = button({ label: "Search", title: "List the studies that fit", class: "choice", test: "archive-search", click: () => void this.search() });
    const way = el("div", { class: "start-way" }, ...this.fields.map(({ input }) => input), search);
    this.element.append(this.title, way, this.work, this.series, this.list);
  }

  /** `host` of the archive; "": there is none. */
  start(host: string): void {
    this.element.hidden = host === "";
    if (host === "") return;
    this.title.textContent = `Archive ${host}`;
    void this.search();
  }

  stop(): void {
    this.request.abort();
  }

  private search(): Promise<void> {
    const filled = this.fields.map(({ name, input }): [string, string] => [name, input.value.trim()]).filter(([, value]) => value !== "");
    return this.attempt("Asking the archive", async (signal) => {
      const { studies, has_more } = await this.http.archivedStudies(Object.fromEntries(filled), signal);
      render(this.series, []);
      const rows = studies.map((study) => this.studyRow(study));
      if (rows.length === 0) rows.push(piece("li", { class: "empty" }, "The archive has no study that fits."));
      if (has_more) rows.push(piece("li", { class: "empty" }, "There are more; fill in more of the fields."));
      render(this.list, rows);
    });
  }

  private studyRow(study: ArchivedStudy): Piece {
    const { uid, patient_name, patient_id, date, description, modalities, objects } = study;
    const name = patient_name || "Patient without a name";
    const row = buttonPiece(
      { title: "Show the series of this study", class: "start-row study", test: "study", click: () => void this.choose(study) },
      piece("strong", {}, [name, patient_id && `ID ${patient_id}`].filter(Boolean).join(" · ")),
      piece("span", { class: "start-date" }, date),
      piece("span", {}, [modalities.join(" "), description, objects > 0 && `${objects} objects`].filter(Boolean).join(" · ")),
    );
    return piece("li", { key: uid }, row);
  }

  private choose(study: ArchivedStudy): Promise<void> {
    return this.attempt("Asking for the series", async (signal) => {
      const all = await this.http.archivedSeries(study.uid, signal);
      const pictures: [HTMLImageElement, ArchivedSeries][] = [];
      const cards = all.filter((one) => one.shows_images).map((one) => this.card(study, one, (image) => void pictures.push([image, one])));
      const others = all.filter((one) => !one.shows_images).map(({ modality, description }) => [modality, description].filter(Boolean).join(" "));
      render(this.series, [
        el(
          "section",
          { "aria-label": study.patient_name },
          el("h3", {}, [study.patient_name || "Patient without a name", study.date, study.description].filter(Boolean).join(" · ")),
          cards.length > 0 ? el("ul", {}, ...cards) : el("p", { class: "empty" }, "No series of this study shows images."),
          others.length > 0
            ? el(
                "p",
                { class: "fine", "data-test": "archived-others" },
                `Also in this study: ${others.join(", ")}. Segmentations and structure sets come along.`,
              )
            : null,
        ),
      ]);
      this.say("");
      for (const [image, one] of pictures) await this.paint(image, study.uid, one.uid, signal);
    });
  }

  private card(study: ArchivedStudy, one: ArchivedSeries, keep: (image: HTMLImageElement) => void): HTMLElement {
    const image = el("img", { width: 76, height: 76, alt: "" });
    keep(image);
    const title = one.description || study.description || "Without a description";
    const request = { study: study.uid, series: one.uid, title: [study.patient_name, title].filter(Boolean).join(", ").slice(0, 200) };
    const card = button({ title: "Fetch and open this series", class: "volume", test: "archived-volume", click: () => this.services.open(request) });
    card.removeAttribute("aria-label"); // what it shows is its name
    const what = [one.modality || "Image", one.number && `series ${one.number}`, one.objects > 0 && `${one.objects} objects`].filter(Boolean).join(" · ");
    card.append(image, el("strong", {}, title), el("span", {}, what));
    return el("li", {}, card);
  }

  /** Without a picture the card is as good. */
  private async paint(image: HTMLImageElement, study: string, series: string, signal: AbortSignal): Promise<void> {
    if (signal.aborted) return;
    try {
      const address = URL.createObjectURL(await this.http.archivedPicture(study, series, signal));
      image.src = address;
      await image.decode();
      image.dataset["painted"] = "true";
      URL.revokeObjectURL(address);
    } catch {
      image.dataset["painted"] = "false";
    }
  }

  private say(text: string): void {
    this.work.hidden = text === "";
    this.work.textContent = text;
  }

  private async attempt(what: string, act: (signal: AbortSignal) => Promise<void>): Promise<void> {
    this.request.abort();
    const own = (this.request = new AbortController());
    this.services.problem("");
    this.say(`${what}…`);
    try {
      await act(own.signal);
    } catch (error) {
      if (!own.signal.aborted) this.services.problem(error instanceof Error ? error.message : String(error));
    } finally {
      if (this.request === own) this.say("");
    }
  }
}
