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
  title: string;
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
  /** In which nothing of it is seen; absent: none. */
  empty_planes?: Plane[];
  /** Of the fit, on unit coordinates; absent: the usual one. */
  smoothing?: number;
}

export interface ControlPoint {
  at: Vec3;
  kind: StretchKind;
  index: number;
  image?: number; // whose edges a wire follows; absent: the project's own
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

/** How two structures lie to each other. Of "inside" the first lies in the second. */
export type Relation = "exclusive" | "inside" | "overlap";

export interface BorderRule {
  first: number;
  second: number;
  relation: Relation;
}

/** Whether structures share borders, and the rules that the user gave. */
export interface Borders {
  shared: boolean;
  rules: BorderRule[];
}

/** How two that touch lie to each other, or two that a rule is about. */
export interface BorderPair extends BorderRule {
  share: number; // of the smaller one that both have
  given: boolean; // by a rule
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
  stage: "preview" | "asking" | "refined" | "outdated" | "none";
  triangles: number;
  volume_ml?: number;
  residual?: { max_mm: number; rms_mm: number; contour: number; at: Vec3 };
  conflicts?: Conflict[];
  warnings?: string[];
  uncertainty?: { known: boolean; planes: number; text: string };
  /** What became of the image; absent where it was not asked. */
  image?: { verdict: "labels" | "unknown" | "no_help" | "astray" | "used"; text: string };
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

/** An image that is shown over the one that the project is drawn on. */
export interface FurtherImage {
  image: number; // its number, from 1
  key: string; // the same as long as it is the same image
  title: string;
  size: [number, number, number];
  spacing_mm: [number, number, number];
  unit: string;
  range: [number, number];
  notes: string[];
  identity: Identity;
  emission: boolean; // of a tracer: from 0 on, and what is high matters
  window: Window;
  presets: Preset[];
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

/** Of the masks of two structures, each fitted by itself; distances of their surfaces, null where one is empty. */
export interface Comparison {
  first: number;
  second: number;
  dice: number;
  jaccard: number;
  volumes_ml: [number, number];
  mean_mm: number | null;
  percentile_95_mm: number | null;
  largest_mm: number | null;
}

/** How pages for images of one modality were arranged last: the server keeps it, and knows nothing of it. */
export interface SavedArrangement {
  layout?: string;
  big?: string;
  sizes?: Partial<Record<string, number>>;
}

export interface Session {
  event: "session";
  version: string;
  title: string;
  project: string;
  image: ImageInfo;
  images: FurtherImage[];
  identity: Identity;
  has_dicom: boolean;
  window: Window;
  presets: Preset[];
  views: Record<ViewName, ViewGeometry>;
  first_view: ViewName;
  structures: Structure[];
  contours: Contour[];
  surfaces: Surface[];
  history: History;
  borders: Borders;
  border_pairs: BorderPair[];
  use_image: UseImage;
  imports: ImportEndings;
  page: unknown;
  opening: string; // names this session among those that the server has had
  can_close: boolean; // whether there is a start page to go back to
  arrangement: { modality: string; state: SavedArrangement | null };
  places: Place[];
  folder: string; // of the image, or ""
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
  borders?: Borders;
  use_image?: UseImage;
}

export interface FurtherImages {
  event: "images";
  images: FurtherImage[];
}

/** Whether the image is asked between the contours; null: it cannot tell borders. */
export type UseImage = boolean | null;

export interface FoundBorders {
  event: "borders";
  pairs: BorderPair[];
}

/** Where a surface cuts the planes of views, told before the `surface` event of the same revision. */
export interface Outlines {
  event: "outlines";
  structure: number;
  revision: number;
  views: { view: string; plane: PixelPlane; lines: number[][]; without_image?: number[][] }[]; // closed; column and row alternating
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

/** Nothing is open yet. */
export interface Start {
  event: "start";
  version: string;
  example: string; // what stands for the built-in image
  places: Place[];
  recent: RecentProject[];
  folder: string; // to begin with, or ""
  sentence: string; // why the last one could not be opened, or ""
  opening: OpeningState | null;
}

export interface Place {
  name: string;
  path: string;
}

export interface RecentProject {
  path: string;
  title: string;
  image: string;
  second: string; // title of the image beside it, or ""
  time: string;
}

export interface OpeningState {
  title: string;
  stage: string;
  fraction: number;
}

export interface Failed {
  event: "failed";
  error: { kind: string; message: string; frames?: number }; // frames: how many there are, and one has to be chosen
}

export interface ListedFile extends Place {
  kind: "image" | "project";
  bytes: number;
  modified: number; // seconds since 1970
}

export interface Folder extends Place {
  parent: string | null;
  folders: Place[];
  files: ListedFile[];
  dicom: "here" | "below" | "none";
  left_out: number;
}

/** One volume of a DICOM folder. */
export interface Volume {
  series: string;
  volume: number; // of the series, from 1
  modality: string;
  description: string;
  distinction: string;
  slices: number;
  columns: number;
  rows: number;
  patient_name: string;
  patient_id: string;
  study_date: string;
  study_description: string;
  series_number: string;
  picture: { file: string; frame: number };
}

/** What to open: a path, and which of its volumes. */
export interface OpenRequest {
  path: string;
  series?: string;
  volume?: number;
  frame?: number; // from 0
}

export type StartEvent = Start | ({ event: "opening" } & OpeningState) | Failed | { event: "opened" } | { event: "closed" };

export type ServerEvent = StartEvent | Session | Changed | FurtherImages | (Surface & { event: "surface" }) | FoundBorders | Outlines | Status | Notice;

export interface SketchPoint {
  at: Vec3;
  kind: StretchKind;
  path?: Vec3[];
  image?: number; // whose edges a wire follows; absent: the project's own
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
  image?: number; // absent: the project's own
  window?: Window; // for shades
  pixels: Pixels;
  outlines: boolean;
}

/** Points of an outline among all. */
export interface LineRun {
  first: number;
  count: number;
  closed: boolean;
}

export interface SliceHeader {
  width: number;
  height: number;
  letters: { left: string; right: string; top: string; bottom: string };
  outlines: { structure: number; revision: number; lines: LineRun[]; without_image?: LineRun[] }[];
  crossings: { contour: number; first: number; count: number }[];
  contours: number[];
  values?: Coding;
}
