// SPDX-License-Identifier: Apache-2.0
// What can stand in a rule (docs/derive.md), for whoever types one.

const FUNCTIONS = ["avoid(", "body()", "clip(", "crop(", "drop(", "fill(", "largest("] as const;
const WORDS = ["along", "and", "anterior", "cm", "inferior", "left", "ml", "mm", "or", "posterior", "right", "superior"] as const;
const BARE_NAME = /^[A-Za-z_\u0080-\uffff][\w.\u0080-\uffff]*$/;
const MOST_OFFERED = 8;

/** What may replace a piece of the line, from `from` to the caret. */
export interface Completion {
  readonly text: string;
  readonly from: number;
}

/** A structure's name as a rule has to write it. */
export function nameInRules(name: string): string {
  if (BARE_NAME.test(name) && name !== "or" && name !== "and") return name;
  return name.includes("'") ? `"${name}"` : `'${name}'`;
}

/** Whether the caret stands where the new structure gets its name. */
const isBeforeSign = (line: string, caret: number): boolean => !line.slice(0, caret).includes("=");

/** Where the word begins that the caret is in or behind, and what it is; quotes that are open belong to it. */
function wordBefore(line: string, caret: number): { from: number; word: string } {
  const before = line.slice(0, caret);
  for (const quote of ["'", '"']) {
    const parts = before.split(quote);
    if (parts.length % 2 === 0) return { from: caret - parts.at(-1)!.length - 1, word: parts.at(-1)! };
  }
  const word = /[A-Za-z_\u0080-\uffff][\w.\u0080-\uffff]*$/.exec(before)?.[0] ?? "";
  return { from: caret - word.length, word };
}

/** Of names, functions and words those that begin so, or names that have it within, names first; none where nothing is typed yet. */
export function completions(line: string, caret: number, names: readonly string[]): Completion[] {
  const { from, word } = wordBefore(line, caret);
  const isQuoted = /['"]/.test(line.charAt(from));
  if (isBeforeSign(line, caret) || (word === "" && !isQuoted)) return [];
  const wanted = word.toLowerCase();
  const starts = names.filter((name) => name.toLowerCase().startsWith(wanted));
  const holds = names.filter((name) => !starts.includes(name) && name.toLowerCase().includes(wanted));
  const others = isQuoted ? [] : [...FUNCTIONS, ...WORDS].filter((one) => one.startsWith(wanted));
  const all = [...[...starts, ...holds].map(nameInRules), ...others];
  return all.includes(word) ? [] : all.slice(0, MOST_OFFERED).map((text) => ({ text, from }));
}

/** The line with a completion in it, and where the caret stands then. */
export function completed(line: string, caret: number, { text, from }: Completion): { line: string; caret: number } {
  return { line: line.slice(0, from) + text + line.slice(caret), caret: from + text.length };
}
