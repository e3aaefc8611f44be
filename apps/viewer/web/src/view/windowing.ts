// SPDX-License-Identifier: Apache-2.0
import type { Coding, Window } from "../net/protocol";

const LEAST_CODES = 256; // in a window: with fewer, steps would be seen that the image does not have

/** Whether the codes are fine enough for this window. */
export const canShow = ({ step }: Coding, { width }: Window): boolean => width >= LEAST_CODES * step;

/** The colour of each code in a window, `colors` being those of 256 shades, from its lower end, where the server has black, to its upper one; `outside` is that of no value. */
export function colorsOfCodes({ first, step }: Coding, { center, width }: Window, colors: Uint32Array, outside: number): Uint32Array {
  const scale = 255 / width;
  const a = step * scale,
    b = (first - step - center) * scale + 128; // 127.5, and half a shade to round
  const table = new Uint32Array(65536);
  table[0] = outside;
  for (let code = 1; code < table.length; ++code) table[code] = colors[Math.floor(Math.min(Math.max(a * code + b, 0), 255))]!;
  return table;
}
