// SPDX-License-Identifier: Apache-2.0

/** A word as a shell of Linux or macOS takes it. */
export function shellWord(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}
