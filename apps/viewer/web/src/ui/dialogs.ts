// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import type { Project } from "../model/project";
import type { Editor } from "../tools/editor";
import { button, el } from "./dom";
import { ICONS } from "./icons";

/** A modal window; Esc and a click beside it close it. */
function openDialog(title: string, name: string, ...content: HTMLElement[]): HTMLDialogElement {
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

export interface ExportServices {
  http: Http;
  project: Project;
  editor: Editor;
}

/** What a user may believe to be in the file, and is not. */
function missing({ drawing }: Editor): HTMLElement[] {
  const { sketch } = drawing;
  const { hasUnsaved } = drawing.outbox;
  if (!sketch && !hasUnsaved) return [];
  const what = hasUnsaved ? "Something that you drew is not saved" : "The contour that you are drawing is not closed";
  return [el("p", { class: "warning-text", "data-test": "export-missing" }, `${what}: no export contains it.`)];
}

export function openExport({ http, project, editor }: ExportServices): void {
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
    const cancel = button({ label: "Cancel", title: "Cancel the export", class: "choice", test: "export-cancel", click: () => own.abort() });
    status.replaceChildren(`Preparing ${name} …`, cancel);
    let outcome: string;
    try {
      const file = await http.export(name, of, own.signal);
      download(file.blob, file.name);
      outcome = `${file.name} was handed to the browser's downloads.`;
    } catch (error) {
      outcome = error instanceof Error ? error.message : String(error); // a notice would lie behind the dialog
    }
    if (running === own) status.replaceChildren(outcome);
  };
  const entry = (name: string, label: string, extension: string, of: () => number | null): HTMLElement => {
    const element = button({ label, title: `Save as ${extension}`, class: "choice", test: `export-${name}`, click: () => void save(name, of()) });
    element.append(el("small", {}, extension));
    return element;
  };
  const groups = EXPORTS.map(([title, files]) =>
    el("div", { class: "export-group" }, el("h3", {}, title), el("div", { class: "choices" }, ...files.map(([name, label, extension]) => entry(name, label, extension, chosen)))),
  );
  const whole = el(
    "div",
    { class: "export-group" },
    el("h3", {}, "Project with its history"),
    el("div", { class: "choices" }, entry("project.kontur", "kontur project", ".kontur", () => null)),
  );
  const dialog = openDialog("Export", "export-dialog", ...missing(editor), el("label", { class: "field" }, "Structure", structure), ...groups, whole, status);
  dialog.addEventListener("close", () => running?.abort());
}

function download(blob: Blob, name: string): void {
  const link = el("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}

export interface ImportServices {
  http: Http;
  failed(error: unknown): void;
  imported(file: string, structures: number[]): void;
  /** Says so, with a button to cancel; returns what ends that. */
  working(text: string, cancel: () => void): () => void;
}

const CONTOUR_FILES = /\.(json|dcm)$/i;
const MASK_FILES = /\.(nii|nii\.gz|nrrd|mha)$/i;

export function openImport(services: ImportServices): void {
  const choose = () => {
    const file = input.files?.[0];
    dialog.close();
    if (file) importFile(file, services);
  };
  const input = el("input", { type: "file", accept: ".json,.dcm,.nii,.gz,.nrrd,.mha", title: "File to import", "data-test": "import-file", on: { change: choose } });
  const dialog = openDialog(
    "Import",
    "import-dialog",
    el("p", {}, "Contours (kontur or 3D Slicer JSON) become a new structure, each region of an RTSTRUCT one of its own. A mask (NIfTI, NRRD, MetaImage) is traced into contours. You can also drop a file onto the page."),
    input,
  );
}

export function importFile(file: File, services: ImportServices): void {
  if (CONTOUR_FILES.test(file.name)) void send("contours", file, {}, services);
  else if (MASK_FILES.test(file.name)) openMaskImport(file, services);
  else services.failed(new Error(`${file.name}: contours are imported from .json and .dcm, masks from .nii, .nii.gz, .nrrd and .mha.`));
}

function openMaskImport(file: File, services: ImportServices): void {
  const axes = el(
    "select",
    { title: "Directions of the planes" },
    el("option", { value: "axial,sagittal,coronal" }, "axial, sagittal and coronal"),
    el("option", { value: "axial" }, "axial only"),
  );
  const planes = el("input", { type: "number", min: "1", max: "200", value: "9", class: "number" });
  const go = button({
    label: "Trace into contours",
    title: "Import the mask",
    class: "primary",
    test: "import-mask",
    click: () => {
      dialog.close();
      void send("mask", file, { axes: axes.value, planes: planes.value }, services);
    },
  });
  const dialog = openDialog(
    `Import ${file.name}`,
    "mask-dialog",
    el("p", {}, "Each label of the mask becomes a structure, drawn by contours on planes through it."),
    el("label", { class: "field" }, "Planes", axes),
    el("label", { class: "field" }, "Planes along each axis", planes),
    el("div", { class: "dialog-buttons" }, go),
  );
}

async function send(what: "contours" | "mask", file: File, options: Record<string, string>, services: ImportServices): Promise<void> {
  const abort = new AbortController();
  const done = services.working(`Importing ${file.name} …`, () => abort.abort());
  try {
    const { structures, doubts } = await services.http.import(what, file, options, abort.signal);
    if (doubts.length === 0) services.imported(file.name, structures);
    else askDespite(doubts, file.name, () => void send(what, file, { ...options, anyway: "1" }, services));
  } catch (error) {
    if (!abort.signal.aborted) services.failed(error);
  }
  done();
}

/** Nothing has been imported yet: what lies elsewhere may be another patient's. */
function askDespite(doubts: string[], file: string, goOn: () => void): void {
  const close = (then?: () => void) => () => {
    dialog.close();
    then?.();
  };
  const dialog = openDialog(
    `Does ${file} belong to this image?`,
    "doubts-dialog",
    ...doubts.map((doubt) => el("p", { class: "warning-text" }, doubt)),
    el("p", {}, "Nothing has been imported yet. Of another patient, or of another scan, the contours would be in the wrong place."),
    el(
      "div",
      { class: "dialog-buttons" },
      button({ label: "Import all the same", title: "Import it as it is", class: "choice", test: "import-anyway", click: close(goOn) }),
      button({ label: "Do not import", title: "Leave the project as it is", class: "primary", test: "import-not", click: close() }),
    ),
  );
}

type KeyRow = [string, string];
const HELP: [string, KeyRow[]][] = [
  [
    "Look around",
    [
      ["Wheel, ↑ ↓", "scroll through slices (Page keys: ten at a time)"],
      ["Ctrl + wheel, + −", "zoom"],
      ["Middle drag, Space + drag", "pan"],
      ["Right drag", "window: width to the right, centre up and down"],
      ["Shift + move", "all views jump to the point under the pointer"],
      ["Click, drag", "move the crosshair (Edit)"],
      ["Drag a plane line", "move that plane; drag its dot to turn it"],
      ["1 2 3 4 5", "axial, sagittal, coronal, oblique, 3D alone; 0 all"],
      ["X, K", "plane lines on or off; all slices zoom and shift together"],
      ["Home", "all views back to where they began"],
    ],
  ],
  [
    "Draw",
    [
      ["L  F  S", "live-wire, freehand, spline; change in mid-contour as you like"],
      ["Left clicks", "place points"],
      ["Left drag", "draw by hand"],
      ["Click the first point, double click, Enter", "close the contour"],
      ["Backspace", "remove the last point"],
      ["Esc", "leave the contour or the tool"],
    ],
  ],
  [
    "Edit",
    [
      ["V", "edit tool"],
      ["F2, double click on a name", "rename the structure"],
      ["Drag a point or a line", "bend the contour"],
      ["Ctrl + click on a line", "insert a point"],
      ["Del", "delete the selected point, or the contour"],
      ["R", "redraw a piece: draw from the line back to the line"],
      ["M, Shift + drag", "move a contour"],
      ["C, Shift + C", "copy to the next, previous slice"],
      ["H", "hole on or off"],
      ["Ctrl + Z, Ctrl + Shift + Z", "undo, redo: every action, also after a restart"],
    ],
  ],
  [
    "3D",
    [
      ["Left, middle, right drag", "turn, zoom, shift"],
      ["Double click on the surface", "show that place in the slices"],
    ],
  ],
];

export function openHelp(version: string): void {
  const columns = HELP.map(([title, rows]) =>
    el("section", {}, el("h3", {}, title), el("dl", {}, ...rows.flatMap(([keys, what]) => [el("dt", {}, keys), el("dd", {}, what)]))),
  );
  openDialog("Mouse and keyboard", "help-dialog", el("div", { class: "help-columns" }, ...columns), el("p", { class: "fine" }, `kontur ${version}. Research software, not a medical device.`));
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
      el("li", {}, "Draw around it: Live-wire follows the edge between your clicks, Freehand follows your hand."),
      el("li", {}, "Draw a second contour in another view. The surface follows after every edit; correct where it is wrong."),
    ),
    el("p", { class: "fine" }, "Everything is saved as you go. Press ? for mouse and keyboard."),
    button({ label: "Start drawing", title: "Close this hint and take the live-wire tool", class: "primary", test: "hint-close", click: close }),
  );
}
