// SPDX-License-Identifier: Apache-2.0

/** The longest of 1, 2, 5 times a power of ten mm that fits into `most_pixels`. */
export function scaleBar(mm_per_pixel: number, most_pixels: number): { mm: number; pixels: number; label: string } {
  const most = mm_per_pixel * most_pixels;
  const power = 10 ** Math.floor(Math.log10(most));
  const mm = [5, 2, 1].map((factor) => factor * power).find((size) => size <= most * (1 + 1e-9)) ?? power;
  const label = mm >= 10 ? `${mm / 10} cm` : `${mm} mm`;
  return { mm, pixels: mm / mm_per_pixel, label };
}
