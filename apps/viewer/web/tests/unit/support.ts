// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import type { Axes } from "../../src/geometry/plane";
import { cross, normalized, type Vec3 } from "../../src/geometry/vec";
import { Navigation } from "../../src/model/navigation";
import type { Contour, Session, ViewGeometry } from "../../src/net/protocol";

export function near(actual: readonly number[], expected: readonly number[], tolerance = 1e-9): void {
  assert.equal(actual.length, expected.length);
  actual.forEach((value, i) => assert.ok(Math.abs(value - expected[i]!) <= tolerance, `${actual} is not ${expected}`));
}

export function axes(u: Vec3, v: Vec3): Axes {
  return { u, v, normal: cross(u, v) };
}

export const AXIAL = axes([1, 0, 0], [0, 1, 0]);
export const SAGITTAL = axes([0, 1, 0], [0, 0, -1]);
export const CORONAL = axes([1, 0, 0], [0, 0, -1]);
/** No axis of it is parallel to one of the patient's. */
export const SKEW = ((): Axes => {
  const normal = normalized([1, 2, 3]);
  const u = normalized(cross([0, 0, 1], normal));
  return { u, v: cross(normal, u), normal };
})();

const view = (title: string, frame: Axes, range_mm: [number, number]): ViewGeometry => ({
  title,
  plane: { ...frame, origin: [0, 0, 0] },
  step_mm: 2,
  width_mm: 200,
  height_mm: 100,
  range_mm,
});

/** An image of 200 x 160 x 101 mm around the origin. */
export function session(changes: Partial<Session> = {}): Session {
  const corners = Array.from({ length: 8 }, (_, k): Vec3 => [k & 1 ? 100 : -100, k & 2 ? 80 : -80, k & 4 ? 50.5 : -50.5]);
  return {
    event: "session",
    version: "1",
    title: "image",
    project: "image.kontur",
    project_path: "/home/user/image.kontur",
    frame_of_reference_uid: "",
    read_only: false,
    image: { size: [100, 80, 51], spacing_mm: [2, 2, 2], corners, center: [0, 0, 0], unit: "HU", range: [-1000, 1000], times: 1, time: 0, notes: [] },
    images: [],
    identity: {
      patient_name: "",
      patient_id: "",
      birth_date: "",
      study_date: "",
      study_description: "",
      series_number: "",
      series_description: "",
      modality: "",
    },
    has_dicom: false,
    window: { center: 40, width: 400 },
    presets: [],
    views: {
      axial: view("Axial", AXIAL, [-50, 50]),
      sagittal: view("Sagittal", SAGITTAL, [-100, 100]),
      coronal: view("Coronal", CORONAL, [-80, 80]),
      oblique: view("Oblique", SKEW, [-90, 90]),
    },
    first_view: "axial",
    structures: [{ id: 1, name: "Liver", color: "#e8b04a", visible: true }],
    contours: [],
    surfaces: [],
    motions: [],
    cycle_frames: null,
    history: { undo: null, redo: null },
    borders: { shared: false, rules: [] },
    border_pairs: [],
    use_image: true,
    imports: { contours: [".mrk.json", ".json"], masks: [".nii.gz", ".nii", ".mgz"] },
    page: null,
    opening: "1",
    can_close: true,
    arrangement: { modality: "CT", state: null },
    places: [],
    folder: "",
    ...changes,
  };
}

export function started(): Navigation {
  const navigation = new Navigation();
  navigation.start(session(), null);
  return navigation;
}

/** A square with 20 mm sides around the origin, with its corners as control points. */
export function square(id: number, changes: Partial<Contour> = {}): Contour {
  const points: Vec3[] = [
    [-10, -10, 0],
    [10, -10, 0],
    [10, 10, 0],
    [-10, 10, 0],
  ];
  return {
    id,
    structure: 1,
    kind: "spline",
    plane: { ...AXIAL, origin: [0, 0, 0] },
    closed: true,
    hole: false,
    visible: true,
    points,
    control: points.map((at, index) => ({ at, kind: "line", index })),
    self_crossings: [],
    ...changes,
  };
}
