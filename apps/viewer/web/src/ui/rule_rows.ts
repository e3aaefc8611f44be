// SPDX-License-Identifier: Apache-2.0
import type { Maker } from "../net/calls";
import type { Structure } from "../net/protocol";
import { buttonPiece } from "../dom/dom";
import { piece, type Piece } from "../dom/pieces";

export interface RuleRowServices {
  call: Maker;
  /** Lets the user change the rule. */
  editRule(line: string): void;
}

/** Beside the name of a structure that a rule makes. */
export const ruleFlag = (rule: string): Piece =>
  piece("span", { key: "rule", class: "flag rule", "data-test": "is-rule", title: `Made by the rule ${rule}` }, "rule");

/** The rule of a structure, and what can be done about it. */
export function ruleRow({ id, name, rule }: Structure, { call, editRule }: RuleRowServices): Piece[] {
  if (rule === undefined) return [];
  const edit = buttonPiece({
    label: rule,
    title: `Change the rule ${rule}`,
    class: "rule-text",
    test: "rule-text",
    click: () => editRule(rule),
  });
  const freeze = buttonPiece({
    label: "Freeze",
    title: `Make a mask of ${name}: it follows nothing any more, and can be corrected`,
    class: "choice",
    test: "freeze",
    click: () => call("structure.freeze", { id }),
  });
  return [piece("div", { key: "rule-row", class: "rule-row" }, edit, freeze)];
}
