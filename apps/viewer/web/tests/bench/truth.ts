// SPDX-License-Identifier: Apache-2.0
// What the users of the walks see: the true mask, and where its border runs in a plane.
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";

export type Vec3 = [number, number, number];
export type Place = [number, number];

const dot = (a: readonly number[], b: readonly number[]): number => a.reduce((sum, value, i) => sum + value * b[i]!, 0);
const cross = (a: Vec3, b: Vec3): Vec3 => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
export const along = (p: Vec3, d: Vec3, mm: number): Vec3 => p.map((value, i) => value + mm * d[i]!) as Vec3;

/** A plane as a view shows it. */
export interface Frame {
  middle: Vec3;
  u: Vec3;
  v: Vec3;
}

export const placeIn = ({ middle, u, v }: Frame, p: Vec3): Place => {
  const d = p.map((value, i) => value - middle[i]!) as Vec3;
  return [dot(d, u), dot(d, v)];
};

/** A mask of a NIfTI file of bytes, in LPS mm. */
export class Truth {
  private readonly bytes: Buffer;
  private readonly size: Vec3;
  private readonly columns: [Vec3, Vec3, Vec3];
  private readonly first: Vec3;
  private readonly inverse: [Vec3, Vec3, Vec3];

  constructor(path: string) {
    const packed = readFileSync(path);
    const file = path.endsWith(".gz") ? gunzipSync(packed) : packed;
    this.bytes = file.subarray(file.readFloatLE(108));
    this.size = [42, 44, 46].map((at) => file.readInt16LE(at)) as Vec3;
    const rows = [280, 296, 312].map((at, axis) => [0, 4, 8, 12].map((offset) => (axis < 2 ? -1 : 1) * file.readFloatLE(at + offset)));
    this.columns = [0, 1, 2].map((n) => rows.map((row) => row[n]!)) as [Vec3, Vec3, Vec3];
    this.first = rows.map((row) => row[3]!) as Vec3;
    const [a, b, c] = this.columns;
    const volume = dot(a, cross(b, c));
    this.inverse = [cross(b, c), cross(c, a), cross(a, b)].map((row) => row.map((value) => value / volume)) as [Vec3, Vec3, Vec3];
  }

  has(p: Vec3): boolean {
    const [i, j, k] = this.indexOf(p).map(Math.round) as Vec3;
    if ([i, j, k].some((value, axis) => value < 0 || value >= this.size[axis]!)) return false;
    return this.bytes[i + this.size[0] * (j + this.size[1] * k)] !== 0;
  }

  /** The voxel, whole or not, at a place. */
  indexOf(p: Vec3): Vec3 {
    const d = p.map((value, i) => value - this.first[i]!);
    return this.inverse.map((row) => dot(row, d)) as Vec3;
  }

  /** The place of a voxel, whole or not. */
  at(index: Vec3): Vec3 {
    return this.columns.reduce<Vec3>((p, column, n) => along(p, column, index[n]!), this.first);
  }

  /** Of the slices along the third axis: which hold something. */
  slices(): number[] {
    const area = this.size[0] * this.size[1];
    return Array.from({ length: this.size[2] }, (_, k) => k).filter((k) => this.bytes.subarray(k * area, (k + 1) * area).some((value) => value !== 0));
  }

  center(): Vec3 {
    const sum: Vec3 = [0, 0, 0];
    let count = 0;
    for (let k = 0, at = 0; k < this.size[2]; ++k)
      for (let j = 0; j < this.size[1]; ++j)
        for (let i = 0; i < this.size[0]; ++i, ++at) if (this.bytes[at]) ([i, j, k].forEach((index, axis) => (sum[axis]! += index)), ++count);
    return this.at(sum.map((value) => value / count) as Vec3);
  }

  /** The borders of the pieces of the mask in a plane, in mm from its middle; the largest first. */
  outlines(frame: Frame, reach_mm = 120, step_mm = 0.6): Place[][] {
    const n = Math.round(reach_mm / step_mm);
    const side = 2 * n + 1;
    const mm = (index: number) => (index - n) * step_mm;
    const isIn = Array.from({ length: side * side }, (_, at) =>
      this.has(along(along(frame.middle, frame.u, mm(at % side)), frame.v, mm(Math.floor(at / side)))),
    );
    const piece = new Int32Array(side * side);
    const traced: Place[][] = [];
    for (let at = 0, found = 0; at < isIn.length; ++at) {
      if (!isIn[at] || piece[at]) continue;
      fill(isIn, piece, side, at, ++found);
      traced.push(
        trace((x, y) => x >= 0 && y >= 0 && x < side && y < side && piece[x + side * y] === found, at % side, Math.floor(at / side)).map(([x, y]) => [
          mm(x),
          mm(y),
        ]),
      );
    }
    return traced.filter((line) => line.length > 12).sort((a, b) => b.length - a.length);
  }
}

function fill(isIn: readonly boolean[], piece: Int32Array, side: number, from: number, number: number): void {
  for (const open = [from]; open.length > 0;) {
    const at = open.pop()!;
    if (!isIn[at] || piece[at]) continue;
    piece[at] = number;
    for (const next of [at - 1, at + 1, at - side, at + side]) if (next >= 0 && next < isIn.length) open.push(next);
  }
}

/** Moore's walk around a piece, from its first place in reading order. */
function trace(has: (x: number, y: number) => boolean, startX: number, startY: number): Place[] {
  const AROUND: readonly Place[] = [
    [-1, 0],
    [-1, -1],
    [0, -1],
    [1, -1],
    [1, 0],
    [1, 1],
    [0, 1],
    [-1, 1],
  ];
  const line: Place[] = [];
  let [x, y] = [startX, startY];
  let came = 0;
  do {
    line.push([x, y]);
    let turn = 0;
    while (turn < 8 && !has(x + AROUND[(came + turn) % 8]![0], y + AROUND[(came + turn) % 8]![1])) ++turn;
    if (turn === 8) break;
    const way = (came + turn) % 8;
    [x, y] = [x + AROUND[way]![0], y + AROUND[way]![1]];
    came = (way + 5) % 8;
  } while ((x !== startX || y !== startY) && line.length < 100_000);
  return line;
}
