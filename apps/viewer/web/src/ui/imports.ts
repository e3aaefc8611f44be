// SPDX-License-Identifier: Apache-2.0
import type { Http } from "../net/http";
import { volumeText } from "../model/volumes";
import type { ImportEndings, ImportReply, NearDrawing, TracedMask } from "../net/protocol";
import { openDialog } from "./dialogs";
import { button, el } from "../dom/dom";
import { accepted, importKind, sentence } from "./endings";
import { nearRows } from "./near_drawings";

export interface ImportServices {
  http: Http;
  endings: ImportEndings;
  failed(error: unknown): void;
  imported(file: string, structures: number[]): void;
  /** Says so, with a button to cancel; returns what ends that. */
  working(text: string, cancel: () => void): () => void;
}

export function openImport(services: ImportServices, near: readonly NearDrawing[]): void {
  const choose = () => {
    const file = input.files?.[0];
    dialog.close();
    if (file) void importFile(file, services);
  };
  const input = el("input", { type: "file", accept: accepted(services.endings), title: "File to import", "data-test": "import-file", on: { change: choose } });
  const dialog = openDialog(
    "Import",
    "import-dialog",
    el(
      "p",
      {},
      "Contours (kontur or 3D Slicer JSON, VTK's lines) become a new structure. A mask (NIfTI, NRRD, MetaImage, FreeSurfer's MGH), a DICOM SEG and an RTSTRUCT come in to be corrected, or as contours. You can also drop a file onto the page.",
    ),
    input,
  );
  if (near.length === 0) return;
  const go = (drawing: NearDrawing) => {
    dialog.close();
    importNear(drawing, services);
  };
  dialog.append(el("h3", {}, "Near this image"), el("ul", { class: "near-list" }, ...nearRows(near, go)));
}

/** What others have drawn on the image, by a file near it. */
export function importNear({ file, name, modality }: NearDrawing, services: ImportServices): void {
  const ask: Ask = (options, signal) => services.http.importNear(file, options, signal);
  openPurpose(name, ask, modality === "SEG", services);
}

export async function importFile(file: File, services: ImportServices): Promise<void> {
  const kind = importKind(file.name, services.endings);
  const ask =
    (what: "contours" | "mask"): Ask =>
    (options, signal) =>
      services.http.import(what, file, options, signal);
  if (kind === "mask") openPurpose(file.name, ask("mask"), true, services);
  else if (kind === "contours" && file.name.toLowerCase().endsWith(".dcm")) openPurpose(file.name, ask("contours"), await isSegmentation(file), services);
  else if (kind === "contours") void send(file.name, ask("contours"), {}, services);
  else services.failed(new Error(`${file.name}: ${sentence(services.endings)}`));
}

/** Whether a DICOM file says at its start that it holds voxels in place of contours. */
async function isSegmentation(file: File): Promise<boolean> {
  const SEGMENTATION_STORAGE = /1\.2\.840\.10008\.5\.1\.4\.1\.1\.66\.[47]/;
  return SEGMENTATION_STORAGE.test(await file.slice(0, 4096).text());
}

type Purpose = "correct" | "contours";

/** Asks what becomes of what others segmented; and where voxels are to be cut into contours, with what these would keep of them. */
function openPurpose(name: string, ask: Ask, hasVoxels: boolean, services: ImportServices): void {
  let purpose: Purpose = "correct";
  const choose = (chosen: Purpose) => () => {
    purpose = chosen;
    preview.forget();
    tracing.hidden = purpose === "correct" || !hasVoxels;
    go.textContent = GO[purpose];
  };
  const choice = (value: Purpose, label: string, title: string) =>
    el(
      "label",
      { class: "purpose", title },
      el("input", {
        type: "radio",
        name: "purpose",
        value,
        "data-test": `import-as-${value}`,
        ...(value === purpose && { checked: "" }),
        on: { change: choose(value) },
      }),
      label,
    );
  const GO = { correct: "Import to be corrected", contours: hasVoxels ? "Trace into contours" : "Import the contours" };
  const axes = el(
    "select",
    { title: "Directions of the planes", "data-test": "mask-axes", on: { change: () => preview.forget() } },
    el("option", { value: "axial,sagittal,coronal" }, "axial, sagittal and coronal"),
    el("option", { value: "axial" }, "axial only"),
  );
  const confirm = () => {
    if (purpose === "contours" && !planes.reportValidity()) return;
    dialog.close();
    void send(name, ask, purpose === "correct" ? { as: "correct" } : hasVoxels ? wanted() : {}, services);
  };
  const wanted = () => ({ axes: axes.value, planes: planes.value });
  const preview = new TracingPreview((signal) => ask({ ...wanted(), preview: "1" }, signal));
  const onEnter = (event: KeyboardEvent) => {
    if (event.key !== "Enter") return;
    event.preventDefault(); // or it presses the button that has the focus once the dialog is closed
    confirm();
  };
  const planes = el("input", {
    type: "number",
    min: "1",
    max: "200",
    value: "9",
    required: "",
    class: "number",
    on: { keydown: onEnter, input: () => preview.forget() },
  });
  const go = button({
    label: GO.correct,
    title: "Import it",
    class: "primary",
    test: "import-mask",
    click: confirm,
  });
  const tracing = el(
    "div",
    { hidden: true },
    el("label", { class: "field" }, "Planes", axes),
    el("label", { class: "field" }, "Planes along each axis", planes),
    preview.element,
    button({
      label: "Preview",
      title: "Say what these planes keep of the voxels; nothing is imported",
      class: "choice",
      test: "import-preview",
      click: () => void (planes.reportValidity() && preview.show()),
    }),
  );
  const dialog = openDialog(
    `Import ${name}`,
    "mask-dialog",
    choice("correct", "To be corrected", "It stays as it is, voxel by voxel, but for where you draw, and near that"),
    choice(
      "contours",
      "As contours",
      hasVoxels ? "Each label or segment is drawn by contours on planes through it" : "Each region becomes a structure with its contours",
    ),
    tracing,
    el("div", { class: "dialog-buttons" }, go),
  );
  go.focus();
  dialog.addEventListener("close", () => preview.forget());
}

const LITTLE_KEPT = 0.9; // Dice: below it the difference is seen at a glance

/** What contours make of masks again. */
class TracingPreview {
  readonly element = el("div", { class: "tracing-preview", role: "status", "data-test": "tracing-preview" });
  private running: AbortController | null = null;

  constructor(private readonly ask: (signal: AbortSignal) => Promise<ImportReply>) {}

  /** What is asked is not of interest any more. */
  forget(): void {
    this.running?.abort();
    this.running = null;
    this.element.replaceChildren();
  }

  async show(): Promise<void> {
    this.forget();
    const own = (this.running = new AbortController());
    this.element.append("Fitting surfaces to these contours …");
    try {
      const { traced = [], notes } = await this.ask(own.signal);
      if (this.running === own) this.element.replaceChildren(...traced.map(keptLine), ...notes.map((note) => el("p", {}, note)));
    } catch (error) {
      if (this.running === own) this.element.replaceChildren(el("p", { class: "warning-text" }, error instanceof Error ? error.message : String(error)));
    }
  }
}

function keptLine({ name, volume_ml, traced_ml, dice }: TracedMask): HTMLElement {
  const text = `${name}: ${volumeText(volume_ml)} in the file, ${volumeText(traced_ml)} from these contours; the two agree to ${dice.toFixed(3)} (Dice).`;
  const more = " More planes keep more of it.";
  return el("p", { class: dice < LITTLE_KEPT ? "warning-text" : "kept" }, dice < LITTLE_KEPT ? text + more : text);
}

type Options = Record<string, string>;
type Ask = (options: Options, signal: AbortSignal) => Promise<ImportReply>;

async function send(name: string, ask: Ask, options: Options, services: ImportServices): Promise<void> {
  const abort = new AbortController();
  const done = services.working(`Importing ${name} …`, () => abort.abort());
  try {
    const { structures, doubts, notes } = await ask(options, abort.signal);
    if (doubts.length === 0) services.imported(name, structures);
    if (notes.length > 0) tellNotes(name, notes);
    if (doubts.length > 0) askDespite(doubts, name, () => void send(name, ask, { ...options, anyway: "1" }, services));
  } catch (error) {
    if (!abort.signal.aborted) services.failed(error);
  }
  done();
}

/** What was left out of a file, or had to be decided: in a dialog, for notices go by themselves, and of many only the last ones are seen. */
function tellNotes(file: string, notes: readonly string[]): void {
  openDialog(`What became of ${file}`, "import-notes", el("ul", { class: "import-notes" }, ...notes.map((note) => el("li", {}, note))));
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
