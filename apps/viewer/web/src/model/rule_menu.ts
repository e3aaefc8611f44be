// SPDX-License-Identifier: Apache-2.0
import { nameInRules } from "./rule_words";

export const BODY = "body()"; // in place of a structure's name

/** What can be chosen of a rule without typing it: a margin around a structure, cropped to another, less a third one. */
export interface RuleChoice {
  name: string;
  of: string;
  /** mm outwards; negative: inwards. */
  margin: number;
  /** "": nothing; `BODY`: the patient's outline. */
  crop: string;
  cropGap: number;
  spare: string;
  spareMargin: number;
}

export const NO_RULE: RuleChoice = { name: "", of: "", margin: 0, crop: "", cropGap: 0, spare: "", spareMargin: 0 };

const mm = (length: number): string => `${Number(Math.abs(length).toFixed(3))} mm`;
const structure = (name: string): string => (name === BODY ? BODY : nameInRules(name));
const withMargin = (expression: string, length: number): string => (length === 0 ? expression : `${expression} ${length < 0 ? "-" : "+"} ${mm(length)}`);

/** The line that the choices stand for; "" while there is no name or no structure. */
export function lineOf({ name, of, margin, crop, cropGap, spare, spareMargin }: RuleChoice): string {
  if (name.trim() === "" || of === "") return "";
  let made = withMargin(structure(of), margin);
  if (crop !== "") made = `crop(${made}, ${structure(crop)}${cropGap > 0 ? `, ${mm(cropGap)}` : ""})`;
  if (spare !== "") made = `${made} - ${spareMargin === 0 ? structure(spare) : `(${withMargin(structure(spare), spareMargin)})`}`;
  return `${nameInRules(name.trim())} = ${made}`;
}
