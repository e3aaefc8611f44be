// SPDX-License-Identifier: Apache-2.0
// Colours of how sure a surface is: cividis (Nunez, Anderton and Renslow 2018), which readers of any colour vision see alike.

/** From a narrow band to a wide one, in sRGB. */
export const BAND_STOPS = ["#00224e", "#35456c", "#666970", "#948e77", "#c8b866", "#fee838"] as const;

const linear = (byte: number): number => (byte <= 10.31 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
const STOPS = BAND_STOPS.map((color) => [1, 3, 5].map((at) => linear(parseInt(color.slice(at, at + 2), 16))));

/** The end of the scale: what 98 % of the points stay below, rounded up to 1, 2 or 5 times a power of ten. */
export function bandScale(half_widths_mm: Float32Array): number {
  const sorted = Float32Array.from(half_widths_mm).sort();
  const wide = Math.max(sorted[Math.floor(0.98 * (sorted.length - 1))] ?? 0, 1e-3);
  const power = 10 ** Math.floor(Math.log10(wide));
  return [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= wide * (1 - 1e-6))!;
}

/** Red, green and blue of each point, linear, as WebGL takes them. */
export function bandColors(half_widths_mm: Float32Array, most_mm: number): Float32Array {
  const colors = new Float32Array(3 * half_widths_mm.length);
  half_widths_mm.forEach((width, point) => {
    const place = Math.min(Math.max(width / most_mm, 0), 1) * (STOPS.length - 1);
    const below = Math.min(Math.floor(place), STOPS.length - 2);
    for (let channel = 0; channel < 3; ++channel) {
      const from = STOPS[below]![channel]!, to = STOPS[below + 1]![channel]!;
      colors[3 * point + channel] = from + (place - below) * (to - from);
    }
  });
  return colors;
}
