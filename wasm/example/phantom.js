// SPDX-License-Identifier: Apache-2.0

/** The voxels of 2 mm around the phantom's kidney. */
export function kidneyGrid({ planes }) {
  const points = planes.flatMap((plane) => plane.contours.flatMap((contour) => contour.points));
  const least = [0, 1, 2].map((axis) => Math.min(...points.map((point) => point[axis])) - 20);
  const most = [0, 1, 2].map((axis) => Math.max(...points.map((point) => point[axis])) + 20);
  return {
    size: least.map((from, axis) => Math.ceil((most[axis] - from) / 2)),
    indexToMm: [0, 1, 2].map((row) => [0, 1, 2].map((axis) => (axis === row ? 2 : 0)).concat(least[row])),
  };
}
