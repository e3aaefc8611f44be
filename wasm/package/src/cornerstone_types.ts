// SPDX-License-Identifier: Apache-2.0
// What the adapter uses of @cornerstonejs/core and @cornerstonejs/tools.

export interface ImageVolume {
  volumeId: string;
  dimensions: ArrayLike<number>;
  spacing: ArrayLike<number>;
  /** Of the first, the second and the third axis: three numbers each. */
  direction: ArrayLike<number>;
  origin: ArrayLike<number>;
  voxelManager?: { getCompleteScalarDataArray?(): ArrayLike<number>; setCompleteScalarDataArray?(values: ArrayLike<number>): void } | undefined;
  modified(): void;
}

export interface Annotation {
  annotationUID?: string;
  childAnnotationUIDs?: string[];
  data: { contour?: { polyline?: number[][]; closed?: boolean }; [key: string]: unknown };
  metadata?: { viewPlaneNormal?: ArrayLike<number> } | undefined;
}

/** Where annotations go, and what else their metadata has: FrameOfReferenceUID at least. */
export interface AnnotationTemplate {
  segmentationId: string;
  segmentIndex: number;
  /** The viewport's. */
  element: unknown;
  FrameOfReferenceUID: string;
  [key: string]: unknown;
}

export interface Segmentation {
  segmentationId: string;
  representationData: {
    Contour?: { annotationUIDsMap?: Map<number, Set<string>> };
    Surface?: { geometryIds: Map<number, string> };
    Labelmap?: unknown;
  };
}

/** A volume viewport. */
export interface Viewport {
  id: string;
  element: unknown;
  getVolumeId?(): string;
  getFrameOfReferenceUID(): string;
  getCamera(): { viewPlaneNormal?: ArrayLike<number> };
  getSlicesClippingPlanes?(): { sliceIndex: number; planes: { origin: ArrayLike<number> }[] }[];
}

/** Points of three numbers; polygons: how many points, then which. */
export interface SurfaceData {
  points: ArrayLike<number>;
  polys: ArrayLike<number>;
  segmentIndex: number;
}

export interface Cornerstone {
  core: {
    cache: { getVolume(id: string): ImageVolume | undefined; getGeometry(id: string): { data: object } | undefined };
    volumeLoader: { createAndCacheDerivedLabelmapVolume(volumeId: string, options?: object): ImageVolume };
    geometryLoader: { createAndCacheGeometry(id: string, options: object): unknown };
    utilities: { uuidv4(): string };
    Enums: { GeometryType: { SURFACE: string } };
  };
  tools: {
    annotation: { state: { getAnnotation(uid: string): Annotation | undefined; addAnnotation(annotation: object, element: never): unknown } };
    segmentation: {
      state: { getSegmentation(id: string): Segmentation | undefined };
      config: { color: { getSegmentIndexColor(viewportId: string, segmentationId: string, segmentIndex: number): number[] | null } };
      triggerSegmentationEvents: { triggerSegmentationModified(id: string): void };
    };
    PlanarFreehandContourSegmentationTool: { toolName: string };
  };
}
