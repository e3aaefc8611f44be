// SPDX-License-Identifier: Apache-2.0
// What the C library asks of its system: a clock, random bytes and two streams for messages. There are no files.

const BAD_FILE = 8;
const SUCCESS = 0;

export function wasi(memory: () => WebAssembly.Memory): WebAssembly.ModuleImports {
  const view = () => new DataView(memory().buffer);
  const written = ["", "", ""];
  const write = (stream: number, text: string) => {
    const lines = (written[stream] + text).split("\n");
    written[stream] = lines.pop() ?? "";
    for (const line of lines) console.warn(line);
  };
  const known: Record<string, (...words: number[]) => number> = {
    clock_time_get: (_clock, _precision, time) => {
      view().setBigUint64(time!, BigInt(Math.round(1e6 * performance.now())), true);
      return SUCCESS;
    },
    random_get: (place, bytes) => {
      crypto.getRandomValues(new Uint8Array(memory().buffer, place, bytes));
      return SUCCESS;
    },
    environ_sizes_get: (count, bytes) => {
      view().setUint32(count!, 0, true);
      view().setUint32(bytes!, 0, true);
      return SUCCESS;
    },
    environ_get: () => SUCCESS,
    fd_write: (stream, pieces, count, answer) => {
      if (stream !== 1 && stream !== 2) return BAD_FILE;
      let bytes = 0;
      for (let n = 0; n < count!; n++) {
        const place = view().getUint32(pieces! + 8 * n, true);
        const length = view().getUint32(pieces! + 8 * n + 4, true);
        write(stream, new TextDecoder().decode(new Uint8Array(memory().buffer, place, length).slice()));
        bytes += length;
      }
      view().setUint32(answer!, bytes, true);
      return SUCCESS;
    },
    proc_exit: (code) => {
      throw new Error(`kontur ended with ${code}`);
    },
  };
  return new Proxy(known as WebAssembly.ModuleImports, { get: (all, name: string) => all[name] ?? (() => BAD_FILE) });
}
