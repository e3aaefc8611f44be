// SPDX-License-Identifier: Apache-2.0
// kontur as Cornerstone3D's polySeg add-on: cornerstoneTools.init({ addons: { polySeg: konturPolySeg(...) } }). It makes label maps
// and surfaces of contours, and contours of surfaces; what starts from a label map is left to another add-on.
import { addContours, annotationsOf, contoursOf, fillFromContours, segmentationOf, segmentsOf } from "./cornerstone_contours.js";
import type { Cornerstone, SurfaceData, Viewport } from "./cornerstone_types.js";
import { type Engine, segmented } from "./engine.js";
import { KonturError, type Mesh, type Plane, type Polyline } from "./types.js";

type Asked = { segmentIndices?: number[]; viewport?: Viewport };
type Surface = SurfaceData & { id: string };
/** Points of three numbers, and lines: how many points, then which. */
type Cut = { points: number[]; lines: number[]; numberOfCells: number };
type Cuts = Map<number, Map<string, Cut>>;

/** What Cornerstone3D 5 calls of an add-on. */
export interface PolySeg {
  init(): void;
  canComputeRequestedRepresentation(segmentationId: string, type: string): boolean;
  computeLabelmapData(segmentationId: string, asked: Asked): Promise<object>;
  computeSurfaceData(segmentationId: string, asked: Asked): Promise<{ geometryIds: Map<number, string> }>;
  computeContourData(segmentationId: string, asked: Asked): Promise<{ annotationUIDsMap: Map<number, Set<string>> }>;
  updateSurfaceData(segmentationId: string, asked?: Asked): Promise<void>;
  clipAndCacheSurfacesForViewport(surfaces: Surface[], viewport: Viewport): Promise<Cuts>;
  extractContourData(cuts: Cuts): Map<number, Cut[]>;
  createAndAddContourSegmentationsFromClippedSurfaces(found: Map<number, Cut[]>, viewport: Viewport, segmentationId: string): Map<number, Set<string>>;
}

/** `other`, such as @cornerstonejs/polymorphic-segmentation, does what kontur does not. */
export function konturPolySeg(cs: Cornerstone, kontur: Engine, other?: PolySeg): PolySeg {
  const has = (id: string) => segmentationOf(cs, id).representationData;
  const own = (id: string, type: string) => (type === "Contour" ? has(id).Surface !== undefined : has(id).Contour !== undefined);
  const orOther = <Result>(id: string, type: string, ours: () => Promise<Result>, theirs: (add: PolySeg) => Promise<Result>): Promise<Result> => {
    if (own(id, type)) return ours();
    if (other) return theirs(other);
    return Promise.reject(new KonturError("unsupported", `segmentation ${id} has no ${type === "Contour" ? "surface" : "contours"} to make its ${type} from`));
  };
  const updated = updater(cs, kontur);
  const cut = (surfaces: Surface[], viewport: Viewport) => cutsOf(kontur, surfaces, viewport);
  const add = (found: Map<number, Cut[]>, viewport: Viewport, id: string) => addCuts(cs, found, viewport, id);
  return {
    init: () => other?.init(),
    canComputeRequestedRepresentation: (id, type) => own(id, type) || (other?.canComputeRequestedRepresentation(id, type) ?? false),
    computeLabelmapData: (id, asked) =>
      orOther(
        id,
        "Labelmap",
        () => labelmapOf(cs, kontur, id, asked),
        (add) => add.computeLabelmapData(id, asked),
      ),
    computeSurfaceData: (id, asked) =>
      orOther(
        id,
        "Surface",
        () => surfacesOf(cs, kontur, id, asked),
        (add) => add.computeSurfaceData(id, asked),
      ),
    computeContourData: (id, asked) =>
      orOther(
        id,
        "Contour",
        async () => ({
          annotationUIDsMap: add(extractCuts(await cut(knownSurfaces(cs, id, asked), viewportOf(asked))), viewportOf(asked), id),
          geometryIds: [],
        }),
        (add) => add.computeContourData(id, asked),
      ),
    updateSurfaceData: (id, asked = {}) => {
      if (own(id, "Surface")) return updated(id, asked);
      return other ? other.updateSurfaceData(id, asked) : Promise.resolve();
    },
    clipAndCacheSurfacesForViewport: cut,
    extractContourData: extractCuts,
    createAndAddContourSegmentationsFromClippedSurfaces: add,
  };
}

/** Cornerstone3D asks after every move of the pointer: while one update runs, others become a single one after it. */
function updater(cs: Cornerstone, kontur: Engine): (id: string, asked: Asked) => Promise<void> {
  const running = new Map<string, { again: boolean; done: Promise<void> }>();
  const update = async (id: string, asked: Asked) => {
    do {
      running.get(id)!.again = false;
      await surfacesOf(cs, kontur, id, asked);
    } while (running.get(id)!.again);
    cs.tools.segmentation.triggerSegmentationEvents.triggerSegmentationModified(id);
  };
  return (id, asked) => {
    const now = running.get(id);
    if (now) {
      now.again = true;
      return now.done;
    }
    const started = { again: false, done: Promise.resolve() };
    running.set(id, started);
    started.done = update(id, asked).finally(() => running.delete(id));
    return started.done;
  };
}

function viewportOf({ viewport }: Asked): Viewport {
  if (!viewport) throw new KonturError("invalid_input", "no viewport was given");
  return viewport;
}

async function labelmapOf(cs: Cornerstone, kontur: Engine, id: string, asked: Asked): Promise<object> {
  const referenced = viewportOf(asked).getVolumeId?.();
  if (!referenced) throw new KonturError("unsupported", "kontur makes label maps of volumes; the viewport shows none");
  const { volumeId } = cs.core.volumeLoader.createAndCacheDerivedLabelmapVolume(referenced);
  await fillFromContours(cs, kontur, id, { volumeId, segmentIndices: indicesOf(asked) });
  return { volumeId };
}

const indicesOf = ({ segmentIndices }: Asked) => (segmentIndices?.length ? segmentIndices : undefined);

async function surfacesOf(cs: Cornerstone, kontur: Engine, id: string, asked: Asked): Promise<{ geometryIds: Map<number, string> }> {
  const segmentation = segmentationOf(cs, id);
  const geometryIds = new Map<number, string>();
  for (const segmentIndex of indicesOf(asked) ?? segmentsOf(cs, segmentation)) {
    const { mesh } = await segmented(kontur, { contours: contoursOf(annotationsOf(cs, segmentation, segmentIndex)) });
    const geometryId = `segmentation_${id}_surface_${segmentIndex}`;
    const data = { points: mesh!.points, polys: polysOf(mesh!) };
    const before = cs.core.cache.getGeometry(geometryId);
    if (before) Object.assign(before.data, data);
    else
      await cs.core.geometryLoader.createAndCacheGeometry(geometryId, {
        type: cs.core.Enums.GeometryType.SURFACE,
        geometryData: {
          ...data,
          id: geometryId,
          segmentIndex,
          color: asked.viewport && cs.tools.segmentation.config.color.getSegmentIndexColor(asked.viewport.id, id, segmentIndex)?.slice(0, 3),
          frameOfReferenceUID: asked.viewport?.getFrameOfReferenceUID(),
        },
      });
    geometryIds.set(segmentIndex, geometryId);
  }
  const shown = segmentation.representationData.Surface?.geometryIds ?? new Map<number, string>();
  for (const [segmentIndex, geometryId] of shown)
    if (!indicesOf(asked) && !geometryIds.has(segmentIndex)) Object.assign(cs.core.cache.getGeometry(geometryId)?.data ?? {}, { points: [], polys: [] });
  for (const [segmentIndex, geometryId] of geometryIds) shown.set(segmentIndex, geometryId);
  return { geometryIds };
}

function knownSurfaces(cs: Cornerstone, id: string, asked: Asked): Surface[] {
  const ids = [...segmentationOf(cs, id).representationData.Surface!.geometryIds.values()];
  const surfaces = ids.map((geometryId) => ({ id: geometryId, ...dataOf(cs, geometryId) }));
  return surfaces.filter(({ segmentIndex }) => indicesOf(asked)?.includes(segmentIndex) ?? true);
}

function dataOf(cs: Cornerstone, geometryId: string): SurfaceData {
  const geometry = cs.core.cache.getGeometry(geometryId);
  if (!geometry) throw new KonturError("invalid_input", `there is no geometry ${geometryId}`);
  const { points, polys, segmentIndex } = geometry.data as SurfaceData;
  return { points, polys, segmentIndex };
}

/** VTK's list: how many points a triangle has, then which. */
function polysOf({ triangles }: Mesh): Uint32Array {
  const polys = new Uint32Array((triangles.length / 3) * 4);
  for (let t = 0; t < triangles.length / 3; t++) polys.set([3, ...triangles.subarray(3 * t, 3 * t + 3)], 4 * t);
  return polys;
}

function trianglesOf(polys: ArrayLike<number>): Uint32Array {
  return Uint32Array.from({ length: (polys.length / 4) * 3 }, (_, n) => polys[4 * Math.floor(n / 3) + 1 + (n % 3)]!);
}

async function cutsOf(kontur: Engine, surfaces: Surface[], viewport: Viewport): Promise<Cuts> {
  const slices = viewport.getSlicesClippingPlanes?.() ?? [];
  const normal = normalOf(viewport);
  const planes = slices.map(({ planes: [near, far] }) => ({ normal, origin: between(near!.origin, (far ?? near!).origin) }));
  const cuts: Cuts = new Map();
  for (const { segmentIndex, points, polys } of surfaces) {
    const found = await kontur.outlines({ points: Float32Array.from(points), triangles: trianglesOf(polys) }, planes);
    const named = found.map((lines, n): [string, Cut] => [`${viewport.id}-${normal.join()}-${slices[n]!.sliceIndex}`, cutOf(lines)]);
    cuts.set(segmentIndex, new Map(named.filter(([, { numberOfCells }]) => numberOfCells > 0)));
  }
  return cuts;
}

function normalOf(viewport: Viewport): Plane["normal"] {
  const { viewPlaneNormal } = viewport.getCamera();
  if (!viewPlaneNormal) throw new KonturError("invalid_input", `viewport ${viewport.id} has no plane`);
  return Array.from(viewPlaneNormal) as Plane["normal"];
}

/** The middle of a slab. */
function between(near: ArrayLike<number>, far: ArrayLike<number>): Plane["origin"] {
  return [0, 1, 2].map((axis) => (near[axis]! + far[axis]!) / 2) as Plane["origin"];
}

function cutOf(found: Polyline[]): Cut {
  const points: number[] = [];
  const lines: number[] = [];
  for (const line of found) {
    const [first, count] = [points.length / 3, line.points.length / 3];
    lines.push(count, ...Array.from({ length: count }, (_, n) => first + n));
    points.push(...line.points);
  }
  return { points, lines, numberOfCells: found.length };
}

function extractCuts(cuts: Cuts): Map<number, Cut[]> {
  return new Map([...cuts].map(([segmentIndex, slices]) => [segmentIndex, [...slices.values()]]));
}

function linesOf({ points, lines }: Cut): Polyline[] {
  const found: Polyline[] = [];
  for (let at = 0; at < lines.length; at += lines[at]! + 1) {
    const which = lines.slice(at + 1, at + 1 + lines[at]!);
    found.push({ closed: true, points: which.flatMap((n) => points.slice(3 * n, 3 * n + 3)) });
  }
  return found;
}

function addCuts(cs: Cornerstone, found: Map<number, Cut[]>, viewport: Viewport, segmentationId: string): Map<number, Set<string>> {
  const normal = normalOf(viewport);
  const template = { element: viewport.element, FrameOfReferenceUID: viewport.getFrameOfReferenceUID(), segmentationId };
  return new Map(
    [...found].map(([segmentIndex, cuts]) => {
      const lines = cuts.flatMap(linesOf).map((line) => ({ line, plane: { normal, origin: line.points.slice(0, 3) as Plane["origin"] } }));
      return [segmentIndex, new Set(addContours(cs, lines, { ...template, segmentIndex }))];
    }),
  );
}
