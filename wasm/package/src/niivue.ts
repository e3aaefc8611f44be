// SPDX-License-Identifier: Apache-2.0
// niivue's drawing layer, painted on a few slices, to a smooth whole: nothing here imports niivue.
import { type Engine, segmented } from "./engine.js";
import { SAMPLES } from "./samples.js";
import { type Contours, type Filled, type FillOptions, type Grid, KonturError, type Options, type Samples } from "./types.js";

/** What is used of niivue's NVImage. */
export interface Volume {
  /** The size in its last three numbers, and rows of the affine in mm (RAS): both of axes turned to R, A and S. */
  dimsRAS?: number[];
  matRAS?: ArrayLike<number>;
  img2RAS(): ArrayLike<number> & { constructor: { name: string } };
}

/** What is used of a Niivue. */
export interface Niivue {
  volumes: Volume[];
  drawBitmap: Uint8Array | null;
  createEmptyDrawing(): void;
  drawAddUndoBitmap(): void;
  refreshDrawing(): void;
}

export type DrawingOptions = Options & {
  /** The label of the drawing; 1 where left out. */
  label?: number;
};

/** The grid of the drawing: of the first volume, with axes turned to R, A and S as niivue turns them. */
export function drawingGrid(nv: Niivue): Grid {
  const { dimsRAS, matRAS } = firstVolume(nv);
  if (!dimsRAS || !matRAS) throw new KonturError("invalid_input", "the first volume is not loaded");
  const row = (n: number) => Array.from({ length: 4 }, (_, column) => (n < 2 ? -1 : 1) * matRAS[4 * n + column]!);
  return { size: [dimsRAS[1]!, dimsRAS[2]!, dimsRAS[3]!], indexToMm: [row(0), row(1), row(2)] };
}

/** Fills the drawing between its painted slices, which stay as they are. niivue's undo takes it back. */
export async function fillDrawing(nv: Niivue, kontur: Engine, options: FillOptions = {}): Promise<Filled["report"]> {
  const grid = drawingGrid(nv);
  if (!nv.drawBitmap) throw new KonturError("invalid_input", "nothing is painted: there is no drawing");
  const image = options.useImage === "auto" ? samples(firstVolume(nv)) : undefined;
  const filled = await kontur.fill({ labels: nv.drawBitmap, grid, options, ...(image && { image }) });
  show(nv, Uint8Array.from(filled.labels));
  return filled.report;
}

/** Draws the inside of contours over what is drawn already. Returns how many voxels it has. */
export async function drawContours(nv: Niivue, kontur: Engine, contours: Contours, options: DrawingOptions = {}): Promise<number> {
  const { label = 1, ...rest } = options;
  const { mask } = await segmented(kontur, { contours, grid: drawingGrid(nv), options: { ...rest, mesh: false } });
  if (!nv.drawBitmap) nv.createEmptyDrawing();
  const drawn = Uint8Array.from(nv.drawBitmap!, (before, n) => (mask[n] ? label : before));
  show(nv, drawn);
  return mask.reduce((sum, value) => sum + value, 0);
}

function firstVolume(nv: Niivue): Volume {
  const [volume] = nv.volumes;
  if (!volume) throw new KonturError("invalid_input", "there is no volume to draw on");
  return volume;
}

/** The first frame's, in types that kontur takes. */
function samples(volume: Volume): Samples {
  const all = volume.img2RAS();
  const [, i = 0, j = 0, k = 0] = volume.dimsRAS ?? [];
  const first = (all as Samples).subarray(0, i * j * k);
  return all.constructor.name in SAMPLES ? first : Float32Array.from(first);
}

function show(nv: Niivue, drawing: Uint8Array): void {
  nv.drawBitmap = drawing;
  nv.refreshDrawing();
  nv.drawAddUndoBitmap();
}
