// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { OpenRequest, Volume } from "../net/protocol";
import { button, el } from "../dom/dom";
import { render } from "../dom/pieces";
import { paintThumbnail } from "./thumbnails";

/** The volumes of a DICOM folder by patient and study, each with a picture of its middle slice. */
export class VolumeCards {
  readonly element = el("div", { class: "volumes", "data-test": "volumes" });

  constructor(
    private readonly http: Http,
    private readonly open: (request: OpenRequest) => void,
    private readonly title: string,
    /** Of the image that one is to be seen over; "": any will do. */
    private readonly frame = "",
  ) {}

  clear(): void {
    render(this.element, []);
  }

  /** Settles when all pictures are there. */
  async show(folder: string, volumes: Volume[], signal: AbortSignal): Promise<void> {
    const pictures: [HTMLCanvasElement, Volume][] = [];
    const groups = groupsOf(inOrderOfFrame(volumes, this.frame)).map(([title, members]) =>
      el(
        "section",
        { "aria-label": title },
        el("h3", {}, title),
        el("ul", {}, ...members.map((volume) => this.card(folder, volume, (canvas) => void pictures.push([canvas, volume])))),
      ),
    );
    if (groups.length === 0) groups.push(el("section", {}, el("p", { class: "empty" }, "The DICOM files here hold no images.")));
    render(this.element, groups);
    for (const [canvas, volume] of pictures) {
      if (signal.aborted) return;
      await paintThumbnail(canvas, () => this.http.thumbnail(volume.picture.file, volume.picture.frame, signal));
    }
  }

  private card(folder: string, volume: Volume, keep: (canvas: HTMLCanvasElement) => void): HTMLElement {
    const { series, volume: number } = volume;
    const canvas = el("canvas", { width: 112, height: 112, "aria-hidden": "true" });
    keep(canvas);
    const [title = "", ...lines] = volumeLines(volume);
    const card = button({ title: this.title, class: "volume", test: "volume", click: () => this.open({ path: folder, series, volume: number }) });
    card.removeAttribute("aria-label"); // what it shows is its name
    card.append(canvas, el("strong", {}, title), ...lines.map((line) => el("span", {}, line)));
    if (this.frame) card.append(el("span", { class: "frame-of-reference" }, frameWords(volume, this.frame)));
    return el("li", {}, card);
  }
}

/** By patient and day, in the order of their first volume. */
export function groupsOf(volumes: Volume[]): [string, Volume[]][] {
  const groups = new Map<string, Volume[]>();
  for (const volume of volumes) {
    const { patient_name, patient_id, study_date } = volume;
    const title = [patient_name || "Patient without a name", patient_id && `ID ${patient_id}`, study_date].filter(Boolean).join(" · ");
    groups.set(title, [...(groups.get(title) ?? []), volume]);
  }
  return [...groups];
}

/** Those of the frame of reference first. */
export const inOrderOfFrame = (volumes: readonly Volume[], frame: string): Volume[] => [
  ...volumes.filter(({ frame_of_reference_uid }) => frame_of_reference_uid === frame),
  ...volumes.filter(({ frame_of_reference_uid }) => frame_of_reference_uid !== frame),
];

/** How a series lies to the image that it is to be seen over. */
export function frameWords({ frame_of_reference_uid }: Pick<Volume, "frame_of_reference_uid">, frame: string): string {
  if (frame_of_reference_uid === "") return "no frame of reference";
  return frame_of_reference_uid === frame ? "same frame of reference: lies as the image does" : "another frame of reference";
}

/** What a series is, line by line. */
export function volumeLines({ modality, series_number, description, distinction, study_description, slices, columns, rows }: Volume): string[] {
  const what = [modality || "Image", series_number && `series ${series_number}`].filter(Boolean).join(" · ");
  return [
    description || study_description || "Without a description",
    distinction,
    what,
    `${slices} ${slices === 1 ? "slice" : "slices"} of ${columns} × ${rows}`,
  ].filter((line) => line !== "");
}
