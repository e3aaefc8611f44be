// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { Project } from "../model/project";
import type { Editor } from "../tools/editor";
import { button, buttonPiece, el } from "../dom/dom";
import { download } from "./download";
import { ICONS } from "../dom/icons";
import { LabelTable } from "./label_table";
import { render } from "../dom/pieces";
import { Sending } from "./sending";

/** A modal window; Esc and a click beside it close it. */
export function openDialog(title: string, name: string, ...content: HTMLElement[]): HTMLDialogElement {
  const dialog = el("dialog", {
    class: "dialog",
    "data-test": name,
    on: {
      click: (event) => {
        if (event.target === dialog) dialog.close();
      },
      close: () => dialog.remove(),
    },
  });
  const close = button({ icon: ICONS.close, title: "Close (Esc)", class: "icon-button small", click: () => dialog.close() });
  dialog.append(el("div", { class: "dialog-title" }, el("h2", {}, title), close), ...content);
  document.body.append(dialog);
  dialog.showModal();
  return dialog;
}

const EXPORTS: [string, [string, string, string][]][] = [
  [
    "Mask on the image's grid",
    [
      ["mask.nii.gz", "NIfTI", ".nii.gz"],
      ["mask.nrrd", "NRRD", ".nrrd"],
      ["mask.seg.nrrd", "3D Slicer segmentation", ".seg.nrrd"],
      ["mask.mha", "MetaImage", ".mha"],
    ],
  ],
  [
    "Surface",
    [
      ["mesh.stl", "STL", ".stl"],
      ["mesh.ply", "PLY", ".ply"],
      ["mesh.obj", "OBJ", ".obj"],
    ],
  ],
  [
    "Contours",
    [
      ["contours.json", "kontur", ".json"],
      ["contours.mrk.json", "3D Slicer curves", ".mrk.json"],
    ],
  ],
  ["Picture", [["picture.png", "PNG", ".png"]]],
];

/** Of a structure that was drawn in several frames. */
const OF_ALL_FRAMES: [string, string, string][] = [
  ["masks.nii.gz", "Masks of all frames, NIfTI", ".nii.gz"],
  ["volumes.csv", "Volumes", ".csv"],
];

/** One file with all structures, or one archive. Those of DICOM refer to the images. */
const OF_ALL: [string, string, string][] = [
  ["labels.nii.gz", "Label map, NIfTI", ".nii.gz"],
  ["labels.seg.nrrd", "3D Slicer segmentation", ".seg.nrrd"],
  ["meshes.stl.zip", "Surfaces, STL", ".zip"],
  ["meshes.ply.zip", "Surfaces, PLY", ".zip"],
  ["views.png", "All views as they are seen", ".png"],
];
const LABEL_FRAMES: [string, string, string] = ["label_frames.nii.gz", "Label map of all frames, NIfTI", ".nii.gz"];
const SEEN = "views.png";
const OF_ALL_IN_DICOM: [string, string, string][] = [
  ["seg.dcm", "DICOM SEG", ".dcm"],
  ["rtstruct.dcm", "DICOM RTSTRUCT", ".dcm"],
];

export interface ExportServices {
  http: Http;
  /** Whether the image is a DICOM series, to which other objects can refer. */
  hasDicom(): boolean;
  /** Host of the archive that the image came from, and that takes what is made on it; undefined: none. */
  archive(): string | undefined;
  /** A picture of what is seen. */
  snapshot(): Promise<Blob>;
  project: Project;
  editor: Editor;
  /** Throws where the server refuses. */
  setLabel(structure: number, value: number | "automatic"): Promise<void>;
}

/** What a user may believe to be in the file, and is not. */
function missing({ drawing }: Editor): HTMLElement[] {
  const { sketch } = drawing;
  const { hasUnsaved } = drawing.outbox;
  if (!sketch && !hasUnsaved) return [];
  const what = hasUnsaved ? "Something that you drew is not saved" : "The contour that you are drawing is not closed";
  return [el("p", { class: "warning-text", "data-test": "export-missing" }, `${what}: no export contains it.`)];
}

export function openExport({ http, project, editor, hasDicom, archive, snapshot, setLabel }: ExportServices): void {
  const structure = el("select", { title: "Structure to export", "data-test": "export-structure" });
  for (const { id, name } of project.structures.values())
    structure.append(el("option", { value: String(id), selected: id === project.activeStructure?.id }, name));
  const chosen = () => (structure.value ? Number(structure.value) : null);
  const status = el("p", { class: "dialog-status" });
  let running: AbortController | null = null;
  /** One at a time; another one, "Cancel" and closing the dialog end it. */
  const save = async (name: string, of: number | null): Promise<void> => {
    running?.abort();
    const own = (running = new AbortController());
    const cancel = buttonPiece({ label: "Cancel", title: "Cancel the export", class: "choice", test: "export-cancel", click: () => own.abort() });
    render(status, [`Preparing ${name} …`, cancel]);
    let outcome: string;
    try {
      const file = name === SEEN ? { blob: await snapshot(), name: SEEN } : await http.export(name, of, own.signal);
      download(file.blob, file.name);
      outcome = `${file.name} was handed to the browser's downloads.`;
    } catch (error) {
      outcome = error instanceof Error ? error.message : String(error); // a notice would lie behind the dialog
    }
    if (running === own) render(status, [outcome]);
  };
  const entry = (name: string, label: string, extension: string, of: () => number | null): HTMLElement => {
    const element = button({ label, title: `Save as ${extension}`, class: "choice", test: `export-${name}`, click: () => void save(name, of()) });
    element.append(el("small", {}, extension));
    return element;
  };
  const groups = EXPORTS.map(([title, files]) =>
    el(
      "div",
      { class: "export-group" },
      el("h3", {}, title),
      el("div", { class: "choices" }, ...files.map(([name, label, extension]) => entry(name, label, extension, chosen))),
    ),
  );
  const frames = el(
    "div",
    { class: "export-group", "data-test": "export-frames" },
    el("h3", {}, "All frames"),
    el("p", { class: "fine" }, `It moves: its mask, surface and picture are those of frame ${project.time + 1}, which is seen.`),
    el("div", { class: "choices" }, ...OF_ALL_FRAMES.map(([name, label, extension]) => entry(name, label, extension, chosen))),
  );
  const showFrames = () => void (frames.hidden = !project.motions.has(chosen() ?? 0));
  structure.addEventListener("change", showFrames);
  showFrames();
  const files = [...OF_ALL, ...(project.motions.size > 0 ? [LABEL_FRAMES] : []), ...(hasDicom() ? OF_ALL_IN_DICOM : [])];
  const all = el(
    "div",
    { class: "export-group" },
    el("h3", {}, "All structures at once"),
    el("div", { class: "choices" }, ...files.map(([name, label, extension]) => entry(name, label, extension, () => null))),
  );
  const host = archive();
  const sending = host === undefined ? null : new Sending(http, host);
  const labels = new LabelTable({ project, setLabel, failed: (sentence) => render(status, [sentence]) });
  const whole = el(
    "div",
    { class: "export-group" },
    el("h3", {}, "Project with its history"),
    el(
      "div",
      { class: "choices" },
      entry("project.kontur", "kontur project", ".kontur", () => null),
    ),
  );
  const dialog = openDialog(
    "Export",
    "export-dialog",
    ...missing(editor),
    all,
    ...(sending ? [sending.element] : []),
    labels.element,
    el("label", { class: "field" }, "One structure", structure),
    ...groups,
    frames,
    whole,
    status,
  );
  dialog.addEventListener("close", () => {
    running?.abort();
    labels.close();
    sending?.close();
  });
}

/** Shown once per project. */
export function firstHint(close: () => void): HTMLElement {
  return el(
    "div",
    { class: "first-hint", "data-test": "first-hint" },
    el("h2", {}, "Segment in three steps"),
    el(
      "ol",
      {},
      el("li", {}, "Scroll to the structure with the wheel. Shift + move brings the other views along."),
      el("li", {}, "Draw around it: drag along its border and back to where you began, or click on it, and the line follows the edge between the clicks."),
      el("li", {}, "Draw a second contour in another view. The surface follows after every edit; correct where it is wrong."),
    ),
    el("p", { class: "fine" }, "Everything is saved as you go. Press ? for mouse and keyboard."),
    button({ label: "Start drawing", title: "Close this hint and take the live-wire tool", class: "primary", test: "hint-close", click: close }),
  );
}
