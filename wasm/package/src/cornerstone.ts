// SPDX-License-Identifier: Apache-2.0
// kontur in Cornerstone3D, whose modules are given: nothing here imports them.
export { addContours, contoursOf, fillFromContours, fillLabelmap, volumeGrid } from "./cornerstone_contours.js";
export type * from "./cornerstone_types.js";
export { konturPolySeg, type PolySeg } from "./polyseg.js";
