// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { normalsOf, positionsOf, trianglesOf, widthsOf, type CodedMesh } from "../../src/net/mesh_code";

const mesh: CodedMesh = { points: 3, triangles: 2, origin: [10, 20, 30], step_mm: [1, 2, 0] };

test("positions are differences of steps, which wrap around", () => {
  // x: 0, 300, 299; y: 65535, 0, 0; z: 0
  const x = [0, 600, 1];
  const y = [1, 2, 0];
  const z = [0, 0, 0];
  const bytes = [x, y, z].flatMap((codes) => [...codes.map((code) => code & 255), ...codes.map((code) => code >> 8)]);
  assert.deepEqual([...positionsOf(mesh, Uint8Array.from(bytes))], [10, 20 + 2 * 65535, 30, 310, 20, 30, 309, 20, 30]);
});

test("normals are unit vectors, in both halves of the octahedron", () => {
  const zigzag = (difference: number) => (difference < 0 ? -2 * difference - 1 : 2 * difference) & 255;
  const squares = [
    [255, 128],
    [128, 128],
    [255, 255],
  ]; // x, z, -z
  const codes = [0, 1].map((axis) => squares.map((square, n) => zigzag((((square[axis]! - (squares[n - 1]?.[axis] ?? 0)) & 255) << 24) >> 24)));
  const normals = normalsOf(mesh, Uint8Array.from(codes.flat()));
  for (const [n, wanted] of [
    [1, 0, 0],
    [0, 0, 1],
    [0, 0, -1],
  ].entries())
    wanted.forEach((value, axis) => assert.ok(Math.abs(normals[3 * n + axis]! - value) < 0.02, `${[...normals]}`));
  assert.equal(normalsOf(mesh, new Uint8Array(0)).length, 0);
});

test("triangles are numbers of seven bits and more", () => {
  // (5, 4, 205), (3, 5, 4)
  assert.deepEqual([...trianglesOf(mesh, Uint8Array.from([10, 1, 0x90, 0x03, 3, 4, 2]))], [5, 4, 205, 3, 5, 4]);
});

test("widths are steps", () => {
  assert.deepEqual([...widthsOf(0.5, Uint8Array.from([0, 3]))], [0, 1.5]);
});
