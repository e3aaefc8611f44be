// SPDX-License-Identifier: Apache-2.0
import type { Answer, Call } from "./calls.js";
import {
  type Contours,
  type Filled,
  type FillRequest,
  type Grid,
  KonturError,
  type Mesh,
  type Plane,
  type Polyline,
  type Progress,
  type Request,
} from "./types.js";

interface Waiting {
  resolve(result: unknown): void;
  reject(error: Error): void;
  progress: Progress | undefined;
}

/** A Worker of browsers or of Node (worker_threads). */
export interface AnyWorker {
  postMessage(message: unknown): void;
  terminate(): unknown;
  addEventListener?(event: "message", handle: (event: { data: unknown }) => void): void;
  on?(event: "message", handle: (message: unknown) => void): void;
}

/** kontur in a worker of its own: calls do not hold the page up, and `cancel` ends one at once. */
export class KonturWorker {
  private worker: AnyWorker | undefined;
  private calls = 0;
  private readonly waiting = new Map<number, Waiting>();

  /** `start` makes a worker of worker.js, such as `() => new Worker(new URL("kontur-wasm/worker", import.meta.url), { type: "module" })`. */
  constructor(
    private readonly module: WebAssembly.Module,
    private readonly start: () => AnyWorker,
  ) {}

  segment(request: Request, progress?: Progress): Promise<{ mask: Uint8Array; grid: Grid; report: Record<string, unknown>; mesh: Mesh }> {
    return this.call({ name: "segment", request, tells: progress !== undefined }, progress) as Promise<never>;
  }

  fill(request: FillRequest, progress?: Progress): Promise<Filled> {
    return this.call({ name: "fill", request, tells: progress !== undefined }, progress) as Promise<never>;
  }

  preview(contours: Contours): Promise<{ mesh: Mesh }> {
    return this.call({ name: "preview", contours }) as Promise<never>;
  }

  finish(contours: Contours): Promise<{ mesh: Mesh }> {
    return this.call({ name: "finish", contours }) as Promise<never>;
  }

  /** Where each plane cuts a mesh, anyone's. */
  outlines(mesh: Pick<Mesh, "points" | "triangles">, planes: Plane[]): Promise<Polyline[][]> {
    return this.call({ name: "outlines", mesh, planes }) as Promise<never>;
  }

  /** Where a plane cuts the surface that was made last. */
  outline(plane: Plane): Promise<Polyline[]> {
    return this.call({ name: "outline", plane }) as Promise<never>;
  }

  values(points: Float64Array): Promise<Float64Array> {
    return this.call({ name: "values", points }) as Promise<never>;
  }

  /** Ends what is being computed: its promise is rejected with the kind "cancelled". The next call starts a worker anew. */
  cancel(): void {
    this.worker?.terminate();
    this.worker = undefined;
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    for (const { reject } of waiting) reject(new KonturError("cancelled", "cancelled by the caller"));
  }

  private started(): AnyWorker {
    if (this.worker) return this.worker;
    const worker = this.start();
    if (worker.addEventListener) worker.addEventListener("message", (event) => this.take(event.data as Answer));
    else worker.on?.("message", (message) => this.take(message as Answer));
    this.worker = worker;
    void this.post(worker, { name: "load", module: this.module }).catch(() => undefined);
    return worker;
  }

  private call(call: Call, progress?: Progress): Promise<unknown> {
    return this.post(this.started(), call, progress);
  }

  private post(worker: AnyWorker, call: Call, progress?: Progress): Promise<unknown> {
    const id = ++this.calls;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve, reject, progress });
      worker.postMessage({ id, call });
    });
  }

  private take({ id, result, error, stage, fraction }: Answer): void {
    const waiting = this.waiting.get(id);
    if (!waiting) return;
    if (stage !== undefined) return void waiting.progress?.(stage, fraction ?? 0);
    this.waiting.delete(id);
    if (error) waiting.reject(new KonturError(error.kind, error.message));
    else waiting.resolve(result);
  }
}
