// SPDX-License-Identifier: Apache-2.0
import { type Grid, KonturError, type Samples } from "./types.js";

/** By which typed arrays samples come and go. */
export const SAMPLES = { Uint8Array, Int16Array, Uint16Array, Int32Array, Float32Array };
export type SampleType = keyof typeof SAMPLES;

/** The name of an array's type, where it is one that can be taken and has a sample for each voxel. */
export function typed(samples: Samples, grid: Grid | undefined, what: string): string {
  const type = samples.constructor.name;
  if (!(type in SAMPLES)) throw new KonturError("unsupported", `${what} is a ${type}; it may be a ${Object.keys(SAMPLES).join(", ")}`);
  const voxels = grid?.size.reduce((product, size) => product * size, 1) ?? 0;
  if (samples.length !== voxels) throw new KonturError("invalid_input", `${what} has ${samples.length} samples, and its grid ${voxels} voxels`);
  return type;
}
