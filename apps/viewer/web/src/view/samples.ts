// SPDX-License-Identifier: Apache-2.0
import type { Coding, Samples } from "../net/protocol";

/** Values of an image on a slice of `width` x `height` pixels: no more of them than the image has. */
export interface SampledSlice {
  codes: Uint16Array;
  coding: Coding;
  samples: Samples;
  width: number;
  height: number;
}

/** For pixels along one side: the sample before each of them and how far it is on the way to the next one; -1 beyond the samples. */
function places(pixels: number, count: number, first: number, step: number): { from: Int32Array; share: Float32Array } {
  const from = new Int32Array(pixels).fill(-1),
    share = new Float32Array(pixels);
  for (let pixel = 0; pixel < pixels; ++pixel) {
    const at = (pixel - first) / step;
    if (at < -0.5 || at > count - 0.5) continue; // as far as the outermost voxels reach
    const inside = Math.min(Math.max(at, 0), count - 1);
    from[pixel] = Math.floor(inside);
    share[pixel] = inside - from[pixel]!;
  }
  return { from, share };
}

/** Between two codes, of which 0 stands for no value: there is nothing between that and a value. */
const between = (a: number, b: number, t: number): number => (a === 0 || b === 0 ? (t < 0.5 ? a : b) : a + t * (b - a));

/** The colours of all pixels, `colors` being those of the codes. Values are interpolated, and not their colours: an edge stays where it is in every window. */
export function spread({ codes, samples, width, height }: SampledSlice, colors: Uint32Array, into: Uint32Array): void {
  const { columns, rows, first, step } = samples;
  if (columns === width && rows === height && [...first, ...step].join() === "0,0,1,1") {
    for (let i = 0; i < codes.length; ++i) into[i] = colors[codes[i]!]!;
    return;
  }
  const across = places(width, columns, first[0], step[0]),
    down = places(height, rows, first[1], step[1]);
  const line = new Float32Array(columns + 1); // one more, so that the last one has a next
  const isWhole = !codes.includes(0);
  for (let row = 0, pixel = 0; row < height; ++row, pixel += width) {
    const from = down.from[row]!;
    if (from < 0) into.fill(colors[0]!, pixel, pixel + width);
    else {
      blendRows(codes, from * columns, Math.min(from + 1, rows - 1) * columns, down.share[row]!, line);
      (isWhole ? spreadWhole : spreadRow)(line, across.from, across.share, colors, into.subarray(pixel, pixel + width));
    }
  }
}

function blendRows(codes: Uint16Array, above: number, below: number, t: number, line: Float32Array): void {
  const last = line.length - 1;
  for (let i = 0; i < last; ++i) line[i] = between(codes[above + i]!, codes[below + i]!, t);
  line[last] = line[last - 1]!;
}

function spreadRow(line: Float32Array, from: Int32Array, share: Float32Array, colors: Uint32Array, into: Uint32Array): void {
  for (let x = 0; x < into.length; ++x) {
    const i = from[x]!;
    into[x] = i < 0 ? colors[0]! : colors[(between(line[i]!, line[i + 1]!, share[x]!) + 0.5) | 0]!;
  }
}

/** The same where all samples are values: nine of ten slices, and a pixel costs half. */
function spreadWhole(line: Float32Array, from: Int32Array, share: Float32Array, colors: Uint32Array, into: Uint32Array): void {
  for (let x = 0; x < into.length; ++x) {
    const i = from[x]!;
    const a = line[i]!;
    into[x] = i < 0 ? colors[0]! : colors[(a + share[x]! * (line[i + 1]! - a) + 0.5) | 0]!;
  }
}
