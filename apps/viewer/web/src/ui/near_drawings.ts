// SPDX-License-Identifier: Apache-2.0
import type { Project } from "../model/project";
import type { Http } from "../net/http";
import type { NearDrawing, Session } from "../net/protocol";
import { buttonPiece, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, render, type Piece } from "../dom/pieces";

const MOST_NAMED = 12; // a structure set for planning has dozens

interface NearServices {
  http: Http;
  project: Project;
  import(drawing: NearDrawing): void;
}

/** Structure sets and segmentations of others, in files near a DICOM image: offered as long as nothing is drawn on it. */
export class NearDrawings {
  readonly element = el("section", { class: "near-drawings", "aria-label": "Drawn on this image by others", "data-test": "near-drawings", hidden: true });
  found: readonly NearDrawing[] = [];
  private isDeclined = false;

  constructor(private readonly services: NearServices) {
    services.project.on(["contours", "structures"], () => this.update());
  }

  start({ has_dicom, read_only }: Pick<Session, "has_dicom" | "read_only">): void {
    if (has_dicom && !read_only) void this.look();
  }

  private async look(): Promise<void> {
    try {
      this.found = await this.services.http.drawings(new AbortController().signal);
    } catch {
      this.found = []; // a convenience: files can be imported by hand, too
    }
    this.update();
  }

  private update(): void {
    const { project } = this.services;
    this.element.hidden = this.found.length === 0 || this.isDeclined || [...project.structures.values()].some((one) => project.hasContent(one));
    if (this.element.hidden) return render(this.element, []);
    const decline = buttonPiece({
      icon: ICONS.close,
      title: "Do not offer them here; Import in the toolbar has them, too",
      class: "icon-button small",
      test: "near-decline",
      click: () => {
        this.isDeclined = true;
        this.update();
      },
    });
    render(this.element, [
      piece("div", { class: "near-title" }, piece("span", {}, "Drawn on this image by others"), decline),
      piece("ul", { class: "near-list" }, ...nearRows(this.found, (drawing) => this.services.import(drawing))),
    ]);
  }
}

/** One row for each file, with what its structures are called. */
export function nearRows(found: readonly NearDrawing[], choose: (drawing: NearDrawing) => void): Piece[] {
  return found.map((drawing) =>
    piece(
      "li",
      { key: drawing.file, "data-test": "near-drawing" },
      piece("strong", { title: drawing.file }, drawing.name),
      piece("span", {}, kindOf(drawing)),
      piece("span", { class: "near-names", title: drawing.structures.join(", ") }, named(drawing.structures)),
      buttonPiece({ label: "Import", title: `Import ${drawing.name}`, class: "choice", test: "near-import", click: () => choose(drawing) }),
    ),
  );
}

function kindOf({ modality, label, own_series }: NearDrawing): string {
  const kind = modality === "SEG" ? "Segmentation" : "Structure set";
  return [kind, label, own_series ? "" : "drawn on another series of the same frame of reference"].filter(Boolean).join(" · ");
}

/** "Liver, Spleen and 3 more" */
export function named(structures: readonly string[]): string {
  const names = structures.slice(0, MOST_NAMED).map((name) => name || "without a name");
  const more = structures.length - names.length;
  return more > 0 ? `${names.join(", ")} and ${more} more` : names.join(", ");
}
