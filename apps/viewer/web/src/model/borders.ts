// SPDX-License-Identifier: Apache-2.0
import type { BorderPair, BorderRule, Borders, Relation, Structure } from "../net/protocol";

type Structures = ReadonlyMap<number, Structure>;

const isAbout = ({ first, second }: Pick<BorderRule, "first" | "second">, a: number, b: number): boolean =>
  (first === a && second === b) || (first === b && second === a);

/** Pairs of structures that a rule can be given for: those that touch and those that have one first, then, of few structures, all others. */
export function pairsToShow(borders: Borders, found: readonly BorderPair[], structures: Structures): [number, number][] {
  const MOST_FOR_ALL = 6;
  const pairs: [number, number][] = [];
  const add = (a: number, b: number) => {
    if (structures.has(a) && structures.has(b) && !pairs.some(([first, second]) => isAbout({ first, second }, a, b))) pairs.push([a, b]);
  };
  for (const { first, second } of [...found, ...borders.rules]) add(first, second);
  const ids = [...structures.keys()];
  if (ids.length <= MOST_FOR_ALL) for (const [i, a] of ids.entries()) for (const b of ids.slice(i + 1)) add(a, b);
  return pairs;
}

export function ruleAbout(borders: Borders, a: number, b: number): BorderRule | undefined {
  return borders.rules.find((rule) => isAbout(rule, a, b));
}

/** What was found where no rule is given; undefined where two do not touch. */
export function foundAbout(found: readonly BorderPair[], a: number, b: number): BorderPair | undefined {
  return found.find((pair) => !pair.given && isAbout(pair, a, b));
}

const WORDS: Record<Relation, (first: string, second: string) => string> = {
  exclusive: (first, second) => `${first} and ${second} exclude each other`,
  inside: (first, second) => `${first} lies inside ${second}`,
  overlap: (first, second) => `${first} and ${second} may overlap`,
};

/** How two lie to each other, in words. */
export function inWords({ first, second, relation }: BorderRule, structures: Structures): string {
  const name = (id: number) => structures.get(id)?.name ?? "?";
  return WORDS[relation](name(first), name(second));
}

export const percent = (share: number): string => `${(100 * share).toFixed(share > 0 && share < 0.0995 ? 1 : 0)} %`;

/** Which rules nobody gave, and why they are so; "" where there are none. */
export function chosenSentence(borders: Borders, found: readonly BorderPair[], structures: Structures): string {
  if (!borders.shared) return "";
  const chosen = found.filter(({ given, first, second }) => !given && structures.has(first) && structures.has(second));
  const [only] = chosen;
  if (!only) return "";
  if (chosen.length === 1)
    return `${inWords(only, structures)}: chosen, as they ${only.share > 0 ? `have ${percent(only.share)} of the smaller one in common` : "only touch"}.`;
  const counts = (["exclusive", "inside", "overlap"] as const).map((relation) => chosen.filter((pair) => pair.relation === relation).length);
  const parts = [`${counts[0]} exclude each other`, `${counts[1]} lie one inside the other`, `${counts[2]} may overlap`].filter((_, i) => counts[i]! > 0);
  return `Of ${chosen.length} pairs that touch ${parts.join(", ")}: chosen from what they have in common.`;
}
