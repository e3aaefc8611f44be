// SPDX-License-Identifier: Apache-2.0
// The adapters in Node, with stand-ins for niivue and Cornerstone3D: what pages do not show.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { before, describe, test } from "node:test";
import { pathToFileURL } from "node:url";

const part = (name) => import(pathToFileURL(join(process.env.KONTUR_WASM, `${name}.js`)));
const { Kontur } = await part("index");
const { drawingGrid, drawContours, fillDrawing } = await part("niivue");
const { contoursOf, fillFromContours, fillLabelmap, konturPolySeg, volumeGrid } = await part("cornerstone");

let kontur;
before(async () => {
  kontur = await Kontur.load(readFileSync(join(process.env.KONTUR_WASM, "kontur.wasm")));
});

const circle = (z, radius, [x, y] = [0, 0], count = 40) =>
  Array.from({ length: count }, (_, n) => [x + radius * Math.cos((2 * Math.PI * n) / count), y + radius * Math.sin((2 * Math.PI * n) / count), z]);
const annotation = (polyline, metadata) => ({ data: { contour: { polyline, closed: true } }, metadata });
const counted = (labels, label) => labels.reduce((sum, value) => sum + (value === label ? 1 : 0), 0);

/** A volume of 40 x 40 x 40 voxels of 1 mm around the origin, its axes turned by a third. */
function volume() {
  let labels = new Uint8Array(40 ** 3);
  const voxelManager = { getCompleteScalarDataArray: () => labels, setCompleteScalarDataArray: (values) => (labels = Uint8Array.from(values)) };
  return {
    volumeId: "map",
    dimensions: [40, 40, 40],
    spacing: [1, 1, 1],
    direction: [0, 1, 0, 0, 0, 1, 1, 0, 0],
    origin: [-20, -20, -20],
    voxelManager,
    modified() {},
  };
}

function cornerstone(annotations, map = volume()) {
  const all = new Map(annotations.map((one, n) => [one.annotationUID ?? `${n}`, one]));
  const outer = [...all].filter(([, { parentAnnotationUID }]) => !parentAnnotationUID);
  const segments = new Map();
  for (const [uid, { segment = 1 }] of outer) segments.set(segment, (segments.get(segment) ?? new Set()).add(uid));
  const segmentation = { segmentationId: "s", representationData: { Contour: { annotationUIDsMap: segments } } };
  return {
    core: { cache: { getVolume: (id) => (id === "map" ? map : undefined) } },
    tools: {
      annotation: { state: { getAnnotation: (uid) => all.get(uid) } },
      segmentation: { state: { getSegmentation: (id) => (id === "s" ? segmentation : undefined) } },
    },
    map,
    segmentation,
  };
}

describe("Cornerstone3D", () => {
  test("contours of one plane come together, whichever side they were seen from", () => {
    const { frame, planes } = contoursOf([
      annotation(circle(3, 10), { viewPlaneNormal: [0, 0, -1] }),
      annotation(circle(3, 4).reverse(), { viewPlaneNormal: [0, 0, 1] }),
      annotation(circle(8, 10)),
      { data: {} },
    ]);
    assert.equal(frame, "LPS mm");
    assert.deepEqual(
      planes.map(({ contours, normal }) => [contours.length, ...normal.map((value) => Math.round(value) + 0)]),
      [
        [2, 0, 0, 1],
        [1, 0, 0, 1],
      ],
    );
  });

  test("a hole is left out, on axes that are turned", async () => {
    const heights = [-8, -4, 0, 4, 8];
    const outer = heights.map((z) => ({ ...annotation(circle(z, 12)), annotationUID: `o${z}`, childAnnotationUIDs: [`i${z}`] }));
    const inner = heights.map((z) => ({ ...annotation(circle(z, 6)), annotationUID: `i${z}`, parentAnnotationUID: `o${z}` }));
    const cs = cornerstone([...outer, ...inner]);
    const voxels = await fillFromContours(cs, kontur, "s", { volumeId: "map" });
    const labels = cs.map.voxelManager.getCompleteScalarDataArray();
    assert.equal(voxels.get(1), counted(labels, 1));
    const { size, indexToMm } = volumeGrid(cs.map);
    labels.forEach((label, n) => {
      const index = [n % size[0], Math.floor(n / size[0]) % size[1], Math.floor(n / (size[0] * size[1]))];
      const [x, y, z] = indexToMm.map((row) => row[3] + index.reduce((sum, value, axis) => sum + value * row[axis], 0));
      const radius = Math.hypot(x, y);
      if (Math.abs(z) < 7 && radius > 7.5 && radius < 10.5) assert.equal(label, 1, `${[x, y, z]}`);
      if (radius < 4.5 || radius > 13.5 || Math.abs(z) > 14) assert.equal(label, 0, `${[x, y, z]}`);
    });
  });

  test("a voxel that two segments claim goes to the first", async () => {
    const both = [1, 2].flatMap((segment) => [-6, 0, 6].map((z) => ({ ...annotation(circle(z, 10, [segment === 1 ? -4 : 4, 0])), segment })));
    const cs = cornerstone(both);
    const voxels = await fillFromContours(cs, kontur, "s", { volumeId: "map" });
    const alone = await fillFromContours(cs, kontur, "s", { volumeId: "map", segmentIndices: [2] });
    assert.ok(voxels.get(1) > voxels.get(2) && voxels.get(2) > 0 && alone.get(2) > voxels.get(2));
  });

  test("a label map painted by a brush is filled", async () => {
    const cs = cornerstone([]);
    const labels = Uint8Array.from({ length: 40 ** 3 }, (_, n) => {
      const [i, j, k] = [n % 40, Math.floor(n / 40) % 40, Math.floor(n / 1600)];
      return k % 6 === 2 && Math.hypot(i - 20, j - 20, k - 20) < 14 ? 5 : 0;
    });
    cs.map.voxelManager.setCompleteScalarDataArray(labels);
    const { labels: told } = await fillLabelmap(cs, kontur, "map");
    const filled = cs.map.voxelManager.getCompleteScalarDataArray();
    assert.ok(labels.every((label, n) => label === 0 || filled[n] === 5));
    assert.equal(counted(filled, 5), told[0].painted_voxels + told[0].added_voxels);
    assert.ok(told[0].added_voxels > told[0].painted_voxels);
  });

  test("what kontur does not make is left to another add-on, or refused", async () => {
    const cs = cornerstone([annotation(circle(0, 5))]);
    const alone = konturPolySeg(cs, kontur);
    assert.deepEqual(
      ["Labelmap", "Surface", "Contour"].map((type) => alone.canComputeRequestedRepresentation("s", type)),
      [true, true, false],
    );
    await assert.rejects(alone.computeContourData("s", {}), { kind: "unsupported", message: /no surface/ });
    await assert.rejects(alone.computeLabelmapData("s", {}), { kind: "invalid_input" });
    await assert.rejects(alone.computeLabelmapData("s", { viewport: {} }), { kind: "unsupported" });
    cs.segmentation.representationData = { Labelmap: {} };
    const calls = [];
    const other = {
      init: () => calls.push("init"),
      canComputeRequestedRepresentation: () => true,
      computeSurfaceData: async () => "theirs",
      updateSurfaceData: async () => calls.push("update"),
    };
    const both = konturPolySeg(cs, kontur, other);
    both.init();
    assert.ok(both.canComputeRequestedRepresentation("s", "Surface") && !alone.canComputeRequestedRepresentation("s", "Surface"));
    assert.equal(await both.computeSurfaceData("s", {}), "theirs");
    await both.updateSurfaceData("s");
    assert.deepEqual(calls, ["init", "update"]);
  });

  test("surfaces follow their contours: one update at a time, of what is drawn to its end", async () => {
    const annotations = [-6, 0, 6].map((z) => annotation(circle(z, 10)));
    for (const segment of [1, 2]) annotations.push({ data: { contour: { polyline: [[0, 0, 3]], closed: false } }, segment });
    const cs = cornerstone(annotations);
    const surface = { data: { points: [], polys: [], segmentIndex: 1 } };
    let told = 0;
    cs.core.cache.getGeometry = () => surface;
    cs.tools.segmentation.triggerSegmentationEvents = { triggerSegmentationModified: () => told++ };
    cs.segmentation.representationData.Surface = { geometryIds: new Map([[1, "surface"]]) };
    let calls = 0;
    const counting = { segment: async (request) => (calls++, kontur.segment(request)) };
    const polySeg = konturPolySeg(cs, counting);
    await Promise.all(Array.from({ length: 5 }, () => polySeg.updateSurfaceData("s")));
    assert.deepEqual([calls, told], [2, 1]);
    const { mesh } = kontur.segment({ contours: contoursOf(annotations.slice(0, 3)) });
    assert.deepEqual(surface.data.points, mesh.points);
    assert.deepEqual(Array.from(surface.data.polys.slice(0, 4)), [3, ...mesh.triangles.slice(0, 3)]);
    Object.assign(annotations[4].data.contour, { polyline: circle(3, 5), closed: true });
    await polySeg.updateSurfaceData("s");
    assert.deepEqual([...cs.segmentation.representationData.Surface.geometryIds.keys()], [1, 2]);
    for (const drawn of cs.segmentation.representationData.Contour.annotationUIDsMap.values()) drawn.clear();
    await polySeg.updateSurfaceData("s");
    assert.deepEqual([surface.data.points, surface.data.polys], [[], []]);
  });

  test("what is not there is named", async () => {
    await assert.rejects(fillFromContours(cornerstone([]), kontur, "t", { volumeId: "map" }), { message: "there is no segmentation t" });
    await assert.rejects(fillLabelmap(cornerstone([]), kontur, "lost"), { message: "there is no volume lost" });
  });
});

describe("niivue", () => {
  const nv = (drawBitmap) => ({
    volumes: [{ dimsRAS: [3, 30, 30, 30], matRAS: [1, 0, 0, -15, 0, 1, 0, -15, 0, 0, 1, -15, 0, 0, 0, 1], img2RAS: () => new Float64Array(30 ** 3) }],
    drawBitmap,
    createEmptyDrawing() {
      this.drawBitmap = new Uint8Array(30 ** 3);
    },
    drawAddUndoBitmap() {},
    refreshDrawing() {},
  });
  const contours = { frame: "RAS mm", planes: [-5, 0, 5].map((z) => ({ origin: [0, 0, z], normal: [0, 0, 1], contours: [{ points: circle(z, 8) }] })) };

  test("its affine is RAS, kontur's grid LPS", () => {
    const [x, y, z] = drawingGrid(nv()).indexToMm.map((row) => [...row].map((value) => value + 0));
    assert.deepEqual(
      [x, y, z],
      [
        [-1, 0, 0, 15],
        [0, -1, 0, 15],
        [0, 0, 1, -15],
      ],
    );
  });

  test("contours are drawn over what is there, with a label", async () => {
    const view = nv(new Uint8Array(30 ** 3).fill(3, 0, 900)); // the lowest slice
    const voxels = await drawContours(view, kontur, contours, { label: 2 });
    assert.equal(counted(view.drawBitmap, 2), voxels);
    assert.ok(voxels > 1000 && counted(view.drawBitmap, 3) === 900);
  });

  test("an image of doubles is taken, where it is asked for", async () => {
    const view = nv();
    await drawContours(view, kontur, contours);
    view.drawBitmap = view.drawBitmap.map((label, n) => (Math.floor(n / 900) % 4 === 2 ? label : 0));
    const report = await fillDrawing(view, kontur, { useImage: "auto" });
    assert.equal(counted(view.drawBitmap, 1), report.labels[0].painted_voxels + report.labels[0].added_voxels);
  });

  test("what is not there is told", async () => {
    await assert.rejects(fillDrawing({ ...nv(), volumes: [] }, kontur), { message: "there is no volume to draw on" });
    await assert.rejects(fillDrawing(nv(null), kontur), { message: /nothing is painted/ });
  });
});
