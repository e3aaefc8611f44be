// SPDX-License-Identifier: Apache-2.0
import type { Identity, ImageInfo, Session } from "../net/protocol";
import { el } from "../dom/dom";
import { piece, render } from "../dom/pieces";

/** Whose image it is and what it shows, line by line: what no reader may have to guess. */
export function identityLines({ identity, title, image }: Pick<Session, "identity" | "title" | "image">): string[] {
  if (identity.modality === "") return [title, sizeLine(image)];
  return [patientLine(identity), studyLine(identity), seriesLine(identity), sizeLine(image)].filter((line) => line !== "");
}

/** What an image's values are, and its voxels. */
export function sizeLine({ size, spacing_mm, unit }: Pick<ImageInfo, "size" | "spacing_mm" | "unit">): string {
  const values = unit === "" ? "values without a unit" : `values in ${unit}`;
  return `${values} · ${size.join(" × ")}, ${spacing_mm.map((mm) => Number(mm.toPrecision(3))).join(" × ")} mm`;
}

function patientLine({ patient_name, patient_id, birth_date }: Identity): string {
  return [patient_name || "Patient without a name", patient_id && `ID ${patient_id}`, birth_date && `born ${birth_date}`].filter(Boolean).join(" · ");
}

const studyLine = ({ study_date, study_description }: Identity): string => [study_date, study_description].filter(Boolean).join(" · ");

function seriesLine({ modality, series_number, series_description }: Identity): string {
  return [modality, series_number && `series ${series_number}`, series_description].filter(Boolean).join(" · ");
}

/** Stays in sight at every width of the page. */
export class IdentityCard {
  readonly element = el("section", { class: "identity", "aria-label": "Image", "data-test": "identity" });

  start(session: Session): void {
    const [first = "", ...others] = identityLines(session);
    render(this.element, [piece("strong", { title: first }, first), ...others.map((line) => piece("span", { title: line }, line))]);
  }
}
