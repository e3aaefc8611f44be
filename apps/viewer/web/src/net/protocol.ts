// SPDX-License-Identifier: Apache-2.0
// The messages of docs/viewer-protocol.md. Names are the protocol's.
import type { PixelPlane, Plane } from "../geometry/plane";
import type { Vec3 } from "../geometry/vec";

export type ViewName = "axial" | "sagittal" | "coronal" | "oblique";
export const VIEW_NAMES: readonly ViewName[] = ["axial", "sagittal", "coronal", "oblique"];

export type StretchKind = "free" | "line" | "spline" | "wire";

export interface Window {
  center: number;
  width: number;
}

export interface Preset extends Window {
  name: string;
}

export interface ViewGeometry {
  plane: Plane;
  step_mm: number;
  width_mm: number;
  height_mm: number;
  range_mm: [number, number];
}

export interface Structure {
  id: number;
  name: string;
  color: string;
  visible: boolean;
}

export interface ControlPoint {
  at: Vec3;
  kind: StretchKind;
  index: number;
}

export interface Contour {
  id: number;
  structure: number;
  kind: "freehand" | "spline" | "livewire" | "mixed";
  plane: Plane;
  hole: boolean;
  visible: boolean;
  points: Vec3[];
  control: ControlPoint[];
  self_crossings: Vec3[];
}

export interface History {
  undo: string | null;
  redo: string | null;
}

export interface Conflict {
  at: Vec3;
  distance_mm: number;
  contours: [number, number];
}

export interface Surface {
  event?: "surface";
  structure: number;
  revision: number;
  stage: "preview" | "refined" | "outdated" | "none";
  triangles: number;
  volume_ml?: number;
  residual?: { max_mm: number; rms_mm: number; contour: number; at: Vec3 };
  conflicts?: Conflict[];
  warnings?: string[];
  uncertainty?: { known: boolean; planes: number; text: string };
}

/** Where to draw next, and the outline that is expected there. */
export interface Suggestion {
  plane: Plane;
  gain: number;
  lines: Vec3[][];
  expected_dice?: { value: number; low: number; high: number };
}

export interface ImageInfo {
  size: [number, number, number];
  spacing_mm: [number, number, number];
  corners: Vec3[];
  center: Vec3;
  unit: string;
  range: [number, number];
  notes: string[];
}

/** Whose image it is; of images that are no DICOM all is "". Dates as YYYY-MM-DD. */
export interface Identity {
  patient_name: string;
  patient_id: string;
  birth_date: string;
  study_date: string;
  study_description: string;
  series_number: string;
  series_description: string;
  modality: string;
}

export interface StructureStatistics {
  structure: number;
  name: string;
  contours: number;
  volume_ml: number;
  surface_cm2: number;
  diameter_mm: number;
  diameter: [Vec3, Vec3];
  extent_mm: [number, number, number];
  voxels: number;
  mean: number;
  deviation: number;
  range: [number, number];
}

export interface Statistics {
  unit: string;
  structures: StructureStatistics[];
}

export interface Session {
  event: "session";
  version: string;
  title: string;
  project: string;
  image: ImageInfo;
  identity: Identity;
  has_dicom: boolean;
  window: Window;
  presets: Preset[];
  views: Record<ViewName, ViewGeometry>;
  structures: Structure[];
  contours: Contour[];
  surfaces: Surface[];
  history: History;
  imports: ImportEndings;
  page: unknown;
}

/** What the names of files end with that can be imported, in small letters. */
export interface ImportEndings {
  contours: string[];
  masks: string[];
}

export interface Changed {
  event: "changed";
  structures?: { set?: Structure[]; removed?: number[] };
  contours?: { set?: Contour[]; removed?: number[] };
  history: History;
}

/** Where a surface cuts the planes of views, told before the `surface` event of the same revision. */
export interface Outlines {
  event: "outlines";
  structure: number;
  revision: number;
  views: { view: string; plane: PixelPlane; lines: number[][] }[]; // closed; column and row alternating
}

export interface Status {
  event: "status";
  text: string;
  fraction: number | null;
}

export interface Notice {
  event: "notice";
  level: "info" | "warning" | "error";
  text: string;
}

export type ServerEvent = Session | Changed | (Surface & { event: "surface" }) | Outlines | Status | Notice;

export interface SketchPoint {
  at: Vec3;
  kind: StretchKind;
  path?: Vec3[];
}

export interface PathResult {
  points: Vec3[];
  control: ControlPoint[];
}

/** What of the image is asked for: nothing, its shades in the window, or its values. */
export type Pixels = boolean | "values";

/** The values that codes from 1 on stand for; 0 is outside of the image. */
export interface Coding {
  first: number;
  step: number;
}

export interface SliceRequest {
  view: string;
  plane: PixelPlane;
  width: number;
  height: number;
  window: Window;
  pixels: Pixels;
  outlines: boolean;
}

export interface SliceHeader {
  width: number;
  height: number;
  letters: { left: string; right: string; top: string; bottom: string };
  outlines: { structure: number; revision: number; lines: { first: number; count: number; closed: boolean }[] }[];
  crossings: { contour: number; first: number; count: number }[];
  contours: number[];
  values?: Coding;
}
