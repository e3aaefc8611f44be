// SPDX-License-Identifier: Apache-2.0
// What the adapters take and give are the real types of niivue and Cornerstone3D: this is compiled, and never run.
import * as core from "@cornerstonejs/core";
import * as tools from "@cornerstonejs/tools";
import { Niivue } from "@niivue/niivue";
import type { Kontur, KonturWorker } from "kontur-wasm";
import { addContours, contoursOf, fillFromContours, fillLabelmap, konturPolySeg } from "kontur-wasm/cornerstone";
import { drawContours, fillDrawing } from "kontur-wasm/niivue";

declare const kontur: Kontur;
declare const worker: KonturWorker;
declare const viewport: core.VolumeViewport;

const nv = new Niivue();
await fillDrawing(nv, worker, { useImage: "auto" });
await drawContours(nv, kontur, contoursOf(tools.annotation.state.getAllAnnotations()), { label: 2 });
await tools.init({ addons: { polySeg: konturPolySeg({ core, tools }, worker) } });
await fillFromContours({ core, tools }, kontur, "segmentation", { volumeId: "volume" });
await fillLabelmap({ core, tools }, worker, "volume");
const made = kontur.segment({ contours: contoursOf([]) });
const plane: { origin: [number, number, number]; normal: [number, number, number] } = { origin: [0, 0, 0], normal: [0, 0, 1] };
const lines = made.outline(plane).map((line) => ({ line, plane }));
addContours({ core, tools }, lines, { segmentationId: "segmentation", segmentIndex: 1, element: viewport.element, FrameOfReferenceUID: "2.25.1" });
