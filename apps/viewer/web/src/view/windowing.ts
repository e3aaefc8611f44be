// SPDX-License-Identifier: Apache-2.0
import type { Coding, Window } from "../net/protocol";

const LEAST_CODES = 256; // in a window: with fewer, steps would be seen that the image does not have

/** Whether the codes are fine enough for this window. */
export const canShow = ({ step }: Coding, { width }: Window): boolean => width >= LEAST_CODES * step;

/** The shades of coded values in a window, as the server gives them: black at its lower end, white at its upper; outside of the image black. */
export function shadesOf(codes: Uint16Array, { first, step }: Coding, { center, width }: Window, into: Uint8Array): Uint8Array {
  const scale = 255 / width;
  const a = step * scale;
  const b = (first - step - center) * scale + 128; // 127.5, and half a shade to round
  const table = new Uint8Array(65536);
  for (let code = 1; code < table.length; ++code) table[code] = Math.min(Math.max(a * code + b, 0), 255);
  for (let i = 0; i < codes.length; ++i) into[i] = table[codes[i]!]!;
  return into;
}

/** The colours of coded values in a window, `table` being those of 256 shades; outside of the image nothing. */
export function colorsOf(codes: Uint16Array, { first, step }: Coding, { center, width }: Window, table: Uint32Array, into: Uint32Array): void {
  const scale = 255 / width;
  const a = step * scale;
  const b = (first - step - center) * scale + 128;
  const colors = new Uint32Array(65536);
  for (let code = 1; code < colors.length; ++code) colors[code] = table[Math.floor(Math.min(Math.max(a * code + b, 0), 255))]!;
  for (let i = 0; i < codes.length; ++i) into[i] = colors[codes[i]!]!;
}
