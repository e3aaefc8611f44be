// SPDX-License-Identifier: Apache-2.0

/** As RFC 4180 has it. */
export function csv(rows: readonly (readonly (string | number)[])[]): string {
  const field = (value: string | number) => (typeof value === "number" ? String(value) : /[",\r\n]/.test(value) ? `"${value.replaceAll('"', '""')}"` : value);
  return rows.map((row) => row.map(field).join(",") + "\r\n").join("");
}
