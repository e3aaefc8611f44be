// SPDX-License-Identifier: Apache-2.0
// A surface as the server codes it (docs/viewer-protocol.md, "GET /api/mesh").
import type { Vec3 } from "../geometry/vec";

export interface CodedMesh {
  points: number;
  triangles: number;
  origin: Vec3;
  step_mm: Vec3;
}

const unzigzag = (code: number): number => (code >>> 1) ^ -(code & 1);

export function positionsOf({ points, origin, step_mm }: CodedMesh, bytes: Uint8Array): Float32Array {
  const positions = new Float32Array(3 * points);
  for (let axis = 0; axis < 3; ++axis) {
    const low = 2 * points * axis;
    const high = low + points;
    let number = 0;
    for (let n = 0; n < points; ++n) {
      number = (number + unzigzag(bytes[low + n]! | (bytes[high + n]! << 8))) & 0xffff;
      positions[3 * n + axis] = origin[axis]! + number * step_mm[axis]!;
    }
  }
  return positions;
}

/** Unit vectors, as far as eight bits for each half of the octahedron's square tell them. */
export function normalsOf({ points }: CodedMesh, bytes: Uint8Array): Float32Array {
  const normals = new Float32Array(bytes.length > 0 ? 3 * points : 0);
  let left = 0;
  let right = 0;
  for (let n = 0; 3 * n < normals.length; ++n) {
    left = (left + unzigzag(bytes[n]!)) & 0xff;
    right = (right + unzigzag(bytes[points + n]!)) & 0xff;
    const u = left / 127.5 - 1;
    const v = right / 127.5 - 1;
    const z = 1 - Math.abs(u) - Math.abs(v);
    const fold = Math.max(-z, 0);
    const x = u >= 0 ? u - fold : u + fold;
    const y = v >= 0 ? v - fold : v + fold;
    const scale = 1 / Math.sqrt(x * x + y * y + z * z); // Math.hypot and an array for each point take five times as long
    normals[3 * n] = x * scale;
    normals[3 * n + 1] = y * scale;
    normals[3 * n + 2] = z * scale;
  }
  return normals;
}

export function trianglesOf({ triangles }: CodedMesh, bytes: Uint8Array): Uint32Array {
  const indices = new Uint32Array(3 * triangles);
  let at = 0;
  const next = (): number => {
    let number = 0;
    let shift = 0;
    for (; bytes[at]! > 127; shift += 7) number |= (bytes[at++]! & 127) << shift;
    return unzigzag((number | (bytes[at++]! << shift)) >>> 0);
  };
  let first = 0;
  for (let n = 0; n < indices.length; n += 3) {
    first += next();
    indices[n] = first;
    indices[n + 1] = first + next();
    indices[n + 2] = first + next();
  }
  return indices;
}

/** Of bytes that count steps to both sides of 128: negative inside. */
export function distancesOf(step_mm: number, bytes: Uint8Array): Float32Array {
  return Float32Array.from(bytes, (steps) => (steps - 128) * step_mm);
}

/** Of bytes that count steps. */
export function widthsOf(step_mm: number, bytes: Uint8Array): Float32Array {
  return Float32Array.from(bytes, (steps) => steps * step_mm);
}
