// SPDX-License-Identifier: Apache-2.0

/** Voxel centres: index (i, j, k), from 0, maps to mm (LPS) by three rows of four numbers. */
export interface Grid {
  size: [number, number, number];
  indexToMm: [number[], number[], number[]];
}

export interface Plane {
  origin: [number, number, number];
  normal: [number, number, number];
}

/** kontur's contour file (docs/formats.md), as an object. */
export interface Contours {
  frame: "LPS mm" | "RAS mm";
  structure?: string;
  planes: ContourPlane[];
  [key: string]: unknown;
}

export interface ContourPlane extends Plane {
  u?: [number, number, number];
  v?: [number, number, number];
  contours: { closed?: boolean; hole?: boolean; points: number[][]; [key: string]: unknown }[];
}

/** Samples on the grid of the request, i fastest. */
export type Samples = Uint8Array | Int16Array | Uint16Array | Int32Array | Float32Array;

/** As of `kontur segment`; what is left out is as there. */
export interface Options {
  kernel?: "screened" | "triharmonic" | "biharmonic";
  normals?: "surface" | "in_plane";
  conflicts?: "reconcile" | "newest_wins" | "exact";
  fillRule?: "even_odd" | "declared";
  corners?: "rounded" | "faithful";
  useImage?: "auto" | "off";
  normalOffsetMm?: number;
  smoothing?: number;
  toleranceMm?: number;
  /** Fraction of each contour's points that the fit uses, above 0 to 1. */
  quality?: number;
  /** Also make the surface; true where left out. */
  mesh?: boolean;
}

export interface Request {
  contours: Contours;
  /** Of the mask; left out: around the contours, in voxels of `spacingMm`. */
  grid?: Grid;
  /** Left out: a 128th of the contours' diagonal. */
  spacingMm?: number;
  options?: Options;
  /** Tells how the surface runs between the contours, where it helps; needs a grid. */
  image?: Samples;
}

/** As of `kontur fill`; what is left out is as there. */
export interface FillOptions {
  ends?: "closed" | "half" | "open";
  useImage?: "auto" | "off";
  jointly?: boolean;
  shapeWeight?: number;
  smoothingVoxels?: number;
  /** Only these; left out: all. */
  labels?: number[];
}

/** A label map of which some slices are painted, across any axes of the grid. */
export interface FillRequest {
  labels: Samples;
  grid: Grid;
  /** Tells how labels run between their slices, where it helps. */
  image?: Samples;
  options?: FillOptions;
}

/** The label map with what was between the slices. */
export interface Filled {
  labels: Samples;
  /** As `kontur fill --report` writes it, but for the image and the times. */
  report: {
    labels: { label: number; slices: [number, number, number]; painted_voxels: number; added_voxels: number; warnings: string[] }[];
    contested_voxels: number;
    closed_voxels: number;
  };
}

export interface Mesh {
  /** mm (LPS), three numbers to a point. */
  points: Float32Array;
  /** Outward unit normals, three numbers to a point. */
  normals: Float32Array;
  /** Three points each, counter-clockwise seen from outside. */
  triangles: Uint32Array;
}

export interface Polyline {
  closed: boolean;
  /** mm (LPS), three numbers to a point. */
  points: number[];
}

export type Progress = (stage: string, fraction: number) => boolean | void;

export type ErrorKind = "invalid_input" | "unsupported" | "corrupt_file" | "io" | "singular_system" | "too_large" | "cancelled" | "internal";

/** What kontur refuses: one sentence that names the thing, the number and the limit. */
export class KonturError extends Error {
  constructor(
    readonly kind: ErrorKind,
    message: string,
  ) {
    super(message);
    this.name = "KonturError";
  }
}
