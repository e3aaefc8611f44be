// SPDX-License-Identifier: Apache-2.0

/** A length with so many decimals, or with two digits where these would say less: images may be of cells. */
export function lengthText(length_mm: number, decimals = 1): string {
  const says = Math.abs(length_mm) >= 10 ** (1 - decimals) || length_mm === 0;
  return `${says ? length_mm.toFixed(decimals) : Number(length_mm.toPrecision(2))} mm`;
}

/** A coordinate, as finely as slices `step_mm` apart ask for. */
export const coordinateText = (mm: number, step_mm: number): string => mm.toFixed(Math.max(1, Math.ceil(-Math.log10(step_mm))));
