// SPDX-License-Identifier: Apache-2.0

/** "1369 ml", "12.4 ml", "0.0525 ml": three digits, and no powers of ten for people to read. */
export function volumeText(ml: number): string {
  if (Math.abs(ml) >= 100 || ml === 0) return `${ml.toFixed(0)} ml`;
  const decimals = Math.min(6, 2 - Math.floor(Math.log10(Math.abs(ml))));
  return `${ml.toFixed(decimals)} ml`;
}
