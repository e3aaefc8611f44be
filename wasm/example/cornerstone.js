// SPDX-License-Identifier: Apache-2.0
// kontur-wasm as Cornerstone3D's polySeg add-on: contours drawn on the phantom's CT become a label map and a surface, and the
// surface outlines on every slice. To be bundled into bundled/cornerstone.js, with kontur-wasm as it is.
import * as core from "@cornerstonejs/core";
import * as tools from "@cornerstonejs/tools";
import { Kontur, KonturWorker } from "kontur-wasm";
import { konturPolySeg } from "kontur-wasm/cornerstone";
import { kidneyGrid } from "./phantom.js";

const VOLUME = "phantom";
const SEGMENTATION = "kidney";
const { Labelmap, Surface, Contour } = tools.Enums.SegmentationRepresentations;
const byId = (id) => document.getElementById(id);
const module = await WebAssembly.compile(await (await fetch("./kontur-wasm/kontur.wasm")).arrayBuffer());
const here = await Kontur.load(module);
const worker = new KonturWorker(module, () => new Worker(new URL("./kontur-wasm/worker.js", document.baseURI), { type: "module" }));

const polySeg = konturPolySeg({ core, tools }, worker);
await core.init();
await tools.init({ addons: { polySeg } });

const grid = kidneyGrid(here.phantom("kidney_radial6").contours);
core.volumeLoader.createLocalVolume(VOLUME, {
  dimensions: grid.size,
  spacing: [2, 2, 2],
  origin: grid.indexToMm.map((row) => row[3]),
  direction: [1, 0, 0, 0, 1, 0, 0, 0, 1],
  scalarData: here.phantomImage(grid),
  metadata: {
    FrameOfReferenceUID: "2.25.1",
    Modality: "CT",
    BitsAllocated: 16,
    PixelRepresentation: 1,
    SamplesPerPixel: 1,
    PhotometricInterpretation: "MONOCHROME2",
  },
});

const engine = new core.RenderingEngine("engine");
engine.setViewports([
  {
    viewportId: "axial",
    type: core.Enums.ViewportType.ORTHOGRAPHIC,
    element: byId("axial"),
    defaultOptions: { orientation: core.Enums.OrientationAxis.AXIAL },
  },
  { viewportId: "whole", type: core.Enums.ViewportType.VOLUME_3D, element: byId("whole"), defaultOptions: { orientation: core.Enums.OrientationAxis.CORONAL } },
]);
const axial = engine.getViewport("axial");
for (const viewport of engine.getViewports()) await viewport.setVolumes([{ volumeId: VOLUME }]);
axial.setProperties({ voiRange: { lower: -100, upper: 250 } });
for (const { actor } of engine.getViewport("whole").getActors()) actor.setVisibility(false); // the surface alone

const group = tools.ToolGroupManager.createToolGroup("drawing");
const { toolName } = tools.PlanarFreehandContourSegmentationTool;
tools.addTool(tools.PlanarFreehandContourSegmentationTool);
group.addTool(toolName);
group.addViewport("axial", "engine");
group.setToolActive(toolName, { bindings: [{ mouseButton: tools.Enums.MouseBindings.Primary }] });
tools.segmentation.addSegmentations([
  { segmentationId: SEGMENTATION, representation: { type: Contour, data: { annotationUIDsMap: new Map(), geometryIds: [] } } },
]);
await tools.segmentation.addContourRepresentationToViewport("axial", [{ segmentationId: SEGMENTATION }]);
engine.render();

const slices = grid.size[2];
byId("slice").max = slices - 1;
byId("slice").value = axial.getSliceIndex();
byId("slice").oninput = () => core.utilities.jumpToSlice(byId("axial"), { imageIndex: Number(byId("slice").value) });

const data = () => tools.segmentation.state.getSegmentation(SEGMENTATION).representationData;

async function tell(work) {
  byId("told").textContent = "Computing";
  try {
    byId("told").textContent = await work();
  } catch (error) {
    byId("told").textContent = error.message;
  }
  engine.render();
}

/** Cornerstone3D asks the add-on for what it is to show and does not have. */
async function made(type) {
  while (!data()[type]) await new Promise((done) => setTimeout(done, 50));
  return data()[type];
}

byId("labelmap").onclick = () =>
  tell(async () => {
    tools.segmentation.addLabelmapRepresentationToViewport("axial", [{ segmentationId: SEGMENTATION }]);
    const { volumeId } = await made(Labelmap);
    const labels = core.cache.getVolume(volumeId).voxelManager.getCompleteScalarDataArray();
    return `${labels.reduce((sum, label) => sum + (label === 1 ? 1 : 0), 0)} voxels in the label map`;
  });
byId("surface").onclick = () =>
  tell(async () => {
    tools.segmentation.addSurfaceRepresentationToViewport("whole", [{ segmentationId: SEGMENTATION }]);
    const { geometryIds } = await made(Surface);
    return `${core.cache.getGeometry(geometryIds.get(1)).data.points.length / 3} points on the surface`;
  });
byId("outlines").onclick = () =>
  tell(async () => {
    const { annotationUIDsMap } = await polySeg.computeContourData(SEGMENTATION, { viewport: axial });
    return `${annotationUIDsMap.get(1).size} outlines`;
  });
byId("told").textContent = "Drag on the left.";
Object.assign(window, { core, tools, kontur: here, grid, axial, data }); // for trying things in the console
