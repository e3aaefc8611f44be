// SPDX-License-Identifier: Apache-2.0
import type { LineRun, SliceHeader } from "../net/protocol";
import type { Outline } from "../tools/free_outlines";

export type Outlines = Map<number, Outline>; // by structure

/** Of lines that the server told unasked. */
export function toldOutline(structure: number, revision: number, told: number[][], withoutImage?: number[][]): Outline {
  const points: number[] = [];
  const run = (line: number[]): LineRun => {
    const first = points.length / 2;
    points.push(...line);
    return { first, count: line.length / 2, closed: true };
  };
  const outline: Outline = { structure, revision, points, lines: told.map(run) };
  if (withoutImage) outline.without_image = withoutImage.map(run);
  return outline;
}

/** Those of a slice that was asked for, but where newer ones have been told meanwhile, those. */
export function newestOutlines(asked: SliceHeader["outlines"], points: Float32Array, told: Outlines | null): Outlines {
  return new Map(
    asked.map((outline) => {
      const known = told?.get(outline.structure);
      return [outline.structure, known && known.revision > outline.revision ? known : { ...outline, points }];
    }),
  );
}
