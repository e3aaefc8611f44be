// SPDX-License-Identifier: Apache-2.0

const CELLS = 64; // along the surface's longest side

/** The triangles that remain when all points in a cube of a grid count as one of them: a rough surface over the same points. */
export function coarseTriangles(positions: Float32Array, triangles: Uint32Array): Uint32Array {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let n = 0; n < positions.length; ++n) {
    low[n % 3] = Math.min(low[n % 3]!, positions[n]!);
    high[n % 3] = Math.max(high[n % 3]!, positions[n]!);
  }
  const cell = Math.max(...high.map((value, axis) => value - low[axis]!)) / CELLS || 1;
  const cells = high.map((value, axis) => Math.floor((value - low[axis]!) / cell) + 1);
  const pointOf = new Int32Array(cells[0]! * cells[1]! * cells[2]!).fill(-1);
  const stands = new Uint32Array(positions.length / 3); // for each point the one that stands for it
  const cellOf = (point: number, axis: number) => Math.floor((positions[3 * point + axis]! - low[axis]!) / cell);
  for (let point = 0; point < stands.length; ++point) {
    const at = cellOf(point, 0) + cells[0]! * (cellOf(point, 1) + cells[1]! * cellOf(point, 2));
    if (pointOf[at]! < 0) pointOf[at] = point;
    stands[point] = pointOf[at]!;
  }
  const kept = new Uint32Array(triangles.length);
  let count = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = stands[triangles[t]!]!;
    const b = stands[triangles[t + 1]!]!;
    const c = stands[triangles[t + 2]!]!;
    if (a === b || b === c || c === a) continue;
    kept[count++] = a;
    kept[count++] = b;
    kept[count++] = c;
  }
  return kept.slice(0, count);
}
