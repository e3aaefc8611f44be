// SPDX-License-Identifier: Apache-2.0
// Colours of how sure a surface is: cividis (Nunez, Anderton and Renslow 2018), which readers of any colour vision see alike; and
// of how far it is from another one: from blue inside to orange outside, by light where it touches.

/** From a narrow band to a wide one, in sRGB. */
export const BAND_STOPS = ["#00224e", "#35456c", "#666970", "#948e77", "#c8b866", "#fee838"] as const;

/** From far inside of another surface to far outside, in sRGB. */
export const DISTANCE_STOPS = ["#10316b", "#4a7fc1", "#f4f4f2", "#e0913d", "#7a3300"] as const;

/** Of a mask that was corrected: as it was, drawn, carried on, by the image, in sRGB. */
export const ORIGIN_COLORS = ["#b8bec6", "#0072b2", "#56b4e9", "#009e73"] as const;

const linear = (byte: number): number => (byte <= 10.31 ? byte / 255 / 12.92 : ((byte / 255 + 0.055) / 1.055) ** 2.4);
const inLight = (stops: readonly string[]) => stops.map((color) => [1, 3, 5].map((at) => linear(parseInt(color.slice(at, at + 2), 16))));
const BAND = inLight(BAND_STOPS);
const DISTANCE = inLight(DISTANCE_STOPS);
const ORIGINS = inLight(ORIGIN_COLORS);

/** The end of the scale: what 98 % of the points stay below, rounded up to 1, 2 or 5 times a power of ten. */
export function bandScale(half_widths_mm: Float32Array): number {
  const sorted = Float32Array.from(half_widths_mm).sort();
  const wide = Math.max(sorted[Math.floor(0.98 * (sorted.length - 1))] ?? 0, 1e-3);
  const power = 10 ** Math.floor(Math.log10(wide));
  return [1, 2, 5, 10].map((factor) => factor * power).find((size) => size >= wide * (1 - 1e-6))!;
}

/** Red, green and blue of each point, linear, as WebGL takes them. */
export const bandColors = (half_widths_mm: Float32Array, most_mm: number): Float32Array => colorsOf(half_widths_mm, BAND, (width) => width / most_mm);

/** The same for distances, from -`most_mm` to `most_mm`. */
export const distanceColors = (distances_mm: Float32Array, most_mm: number): Float32Array =>
  colorsOf(distances_mm, DISTANCE, (distance) => 0.5 + distance / most_mm / 2);

/** The same for who made each point of a corrected mask's surface. */
export const originColors = (origins: Uint8Array): Float32Array =>
  Float32Array.from({ length: 3 * origins.length }, (_, n) => ORIGINS[origins[Math.floor(n / 3)]!]![n % 3]!);

function colorsOf(values: Float32Array, stops: readonly number[][], placeOf: (value: number) => number): Float32Array {
  const colors = new Float32Array(3 * values.length);
  values.forEach((value, point) => {
    const place = Math.min(Math.max(placeOf(value), 0), 1) * (stops.length - 1);
    const below = Math.min(Math.floor(place), stops.length - 2);
    for (let channel = 0; channel < 3; ++channel) {
      const from = stops[below]![channel]!;
      const to = stops[below + 1]![channel]!;
      colors[3 * point + channel] = from + (place - below) * (to - from);
    }
  });
  return colors;
}
