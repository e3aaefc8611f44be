// SPDX-License-Identifier: Apache-2.0
import type { Filled, FillRequest, Grid, Mesh, Plane, Polyline, Request } from "./types.js";

type Made = { mask: Uint8Array; grid: Grid; mesh: Mesh; free?: () => void };

/** A `Kontur` or a `KonturWorker`. */
export interface Engine {
  segment(request: Request): Made | Promise<Made>;
  fill(request: FillRequest): Filled | Promise<Filled>;
  outlines(mesh: Pick<Mesh, "points" | "triangles">, planes: Plane[]): Polyline[][] | Promise<Polyline[][]>;
}

/** What `segment` makes, as a copy that stays when its memory is given back. */
export async function segmented(kontur: Engine, request: Request): Promise<{ mask: Uint8Array; mesh: Mesh | undefined }> {
  const made = await kontur.segment(request);
  const result = { mask: made.mask, mesh: request.options?.mesh === false ? undefined : made.mesh };
  made.free?.();
  return result;
}
