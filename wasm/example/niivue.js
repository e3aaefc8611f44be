// SPDX-License-Identifier: Apache-2.0
// kontur-wasm in niivue: the drawing layer, painted on a few slices of the phantom's CT, is filled between them.
import { NVImage, Niivue, SHOW_RENDER } from "@niivue/niivue";
import { Kontur, KonturWorker } from "kontur-wasm";
import { drawContours, fillDrawing } from "kontur-wasm/niivue";
import { kidneyGrid } from "./phantom.js";

const INT16 = 4; // NIfTI's code
const AXIAL = 2;
const byId = (id) => document.getElementById(id);
const module = await WebAssembly.compile(await (await fetch("./kontur-wasm/kontur.wasm")).arrayBuffer());
const here = await Kontur.load(module);
const worker = new KonturWorker(module, () => new Worker(new URL("./kontur-wasm/worker.js", import.meta.url), { type: "module" }));

const { contours } = here.phantom("kidney_radial6");
const grid = kidneyGrid(contours);
const ras = [...grid.indexToMm.map((row, n) => (n < 2 ? row.map((value) => -value) : row)), [0, 0, 0, 1]].flat();
const ct = NVImage.createNiftiArray(grid.size, [2, 2, 2], ras, INT16, here.phantomImage(grid));

const nv = new Niivue({ show3Dcrosshair: true, multiplanarShowRender: SHOW_RENDER.ALWAYS });
await nv.attachToCanvas(byId("canvas"));
await nv.loadFromArrayBuffer(ct.buffer, "phantom.nii");
nv.createEmptyDrawing();
nv.setDrawingEnabled(true);
nv.setPenValue(1, true); // a closed line is filled

const slices = nv.volumes[0].dimsRAS[3];
byId("slice").max = slices - 1;
byId("slice").value = Math.floor(slices / 2);
byId("slice").oninput = () => {
  nv.scene.crosshairPos[AXIAL] = (Number(byId("slice").value) + 0.5) / slices;
  nv.drawScene();
};

async function tell(work) {
  byId("told").textContent = "Filling";
  const start = performance.now();
  try {
    byId("told").textContent = `${await work()} in ${Math.round(performance.now() - start)} ms`;
  } catch (error) {
    byId("told").textContent = error.message;
  }
}

byId("fill").onclick = () =>
  tell(async () => {
    const { labels } = await fillDrawing(nv, worker);
    return labels.map(({ painted_voxels, added_voxels }) => `${painted_voxels} voxels painted, ${added_voxels} added`).join("; ");
  });
byId("contours").onclick = () => tell(async () => `${await drawContours(nv, worker, contours)} voxels of ${contours.planes.length} planes`);
byId("undo").onclick = () => nv.drawUndo();
byId("told").textContent = "Drag on an axial slice.";
Object.assign(window, { nv, kontur: here, grid, contours }); // for trying things in the console
