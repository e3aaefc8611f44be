// SPDX-License-Identifier: Apache-2.0
// kontur in a worker: what KonturWorker starts. Answers one call after the other.
import type { Call } from "./calls.js";
import { Kontur, type Surface } from "./kontur.js";
import { KonturError } from "./types.js";

export interface Port {
  postMessage(message: unknown, transfer?: Transferable[]): void;
}

type Mine = { surface?: Surface; kontur?: Kontur; editor?: ReturnType<Kontur["editor"]> };

function keep(mine: Mine, surface: Surface): Surface {
  mine.surface?.free();
  mine.surface = surface;
  return surface;
}

async function answer(mine: Mine, id: number, call: Call, port: Port): Promise<unknown> {
  if (call.name === "load") {
    mine.kontur = await Kontur.load(call.module);
    return undefined;
  }
  const { kontur } = mine;
  if (!kontur) throw new Error("the worker was not loaded");
  kontur.progress = "tells" in call && call.tells ? (stage, fraction) => port.postMessage({ id, stage, fraction }) : undefined;
  switch (call.name) {
    case "fill":
      return kontur.fill(call.request);
    case "segment": {
      const { mask, grid, report, mesh } = keep(mine, kontur.segment(call.request)) as ReturnType<Kontur["segment"]>;
      return { mask, grid, report, mesh };
    }
    case "preview":
    case "finish":
      mine.editor ??= kontur.editor();
      return { mesh: keep(mine, mine.editor[call.name](call.contours)).mesh };
    case "outlines":
      return kontur.outlines(call.mesh, call.planes);
    case "outline":
      return mine.surface?.outline(call.plane) ?? [];
    case "values":
      if (!mine.surface) throw new KonturError("invalid_input", "nothing was made yet whose values could be told");
      return mine.surface.values(call.points);
  }
}

/** Answers the messages of one port. */
export function serve(port: Port): (message: { id: number; call: Call }) => void {
  const mine: Mine = {};
  let last = Promise.resolve();
  return ({ id, call }) => {
    last = last.then(async () => {
      try {
        port.postMessage({ id, result: await answer(mine, id, call, port) });
      } catch (error) {
        const { kind, message } = error as KonturError;
        port.postMessage({ id, error: { kind: kind ?? "internal", message } });
      }
    });
  };
}

const inBrowser = typeof self !== "undefined" && typeof (self as { postMessage?: unknown }).postMessage === "function";
if (inBrowser) {
  const handle = serve(self as unknown as Port);
  self.addEventListener("message", (event) => handle(event.data as { id: number; call: Call }));
} else {
  const name = "node:worker_threads";
  const { parentPort } = (await import(/* @vite-ignore */ name)) as {
    parentPort: (Port & { on(event: "message", handle: (message: { id: number; call: Call }) => void): void }) | null;
  };
  if (parentPort) parentPort.on("message", serve(parentPort));
}
