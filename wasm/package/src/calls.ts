// SPDX-License-Identifier: Apache-2.0
// What KonturWorker and its worker say to each other.
import type { Contours, ErrorKind, FillRequest, Mesh, Plane, Request } from "./types.js";

export type Call =
  | { name: "load"; module: WebAssembly.Module }
  | { name: "segment"; request: Request; tells: boolean }
  | { name: "fill"; request: FillRequest; tells: boolean }
  | { name: "preview" | "finish"; contours: Contours }
  | { name: "outlines"; mesh: Pick<Mesh, "points" | "triangles">; planes: Plane[] }
  | { name: "outline"; plane: Plane }
  | { name: "values"; points: Float64Array };

export interface Answer {
  id: number;
  result?: unknown;
  error?: { kind: ErrorKind; message: string };
  stage?: string;
  fraction?: number;
}
