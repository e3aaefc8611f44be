// SPDX-License-Identifier: Apache-2.0
import { BODY, lineOf, NO_RULE, type RuleChoice } from "../model/rule_menu";
import { el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";

/** The same rules by menus, for who does not want to type: each choice writes the line anew. */
export class RuleMenu {
  readonly element = el("details", { class: "rule-menu", "data-test": "rule-menu", on: { toggle: () => this.begin() } });
  private choice: RuleChoice = { ...NO_RULE };

  constructor(
    private readonly names: () => readonly string[],
    private readonly write: (line: string) => void,
  ) {
    this.update();
  }

  /** Begins anew, with the structure that is drawn in. */
  reset(active: string | undefined): void {
    this.element.open = false;
    this.choice = { ...NO_RULE, name: "PTV", of: active ?? "", margin: 5 };
    this.update();
  }

  update(): void {
    const others = this.names();
    const { choice } = this;
    render(this.element, [
      piece("summary", {}, "By menus"),
      this.row("Name", this.text("name")),
      this.row("of", this.select("of", "Structure that it is made of", others), "+", this.length("margin", "Margin in mm; negative: inwards", -100), "mm"),
      this.row(
        "within",
        this.select("crop", "Crop to", ["", BODY, ...others]),
        "gap",
        this.length("cropGap", "Gap to its surface in mm", 0, choice.crop === ""),
        "mm",
      ),
      this.row(
        "less",
        this.select("spare", "Structure to spare", ["", ...others]),
        "+",
        this.length("spareMargin", "Margin around it in mm", -100, choice.spare === ""),
        "mm",
      ),
    ]);
  }

  private begin(): void {
    if (this.element.open && lineOf(this.choice) !== "") this.write(lineOf(this.choice));
  }

  private set(change: Partial<RuleChoice>): void {
    this.choice = { ...this.choice, ...change };
    this.update();
    const line = lineOf(this.choice);
    if (line !== "") this.write(line);
  }

  private row(head: string, ...fields: (Piece | string)[]): Piece {
    return piece("div", { key: head, class: "rule-row" }, piece("span", { class: "rule-head" }, head), ...fields);
  }

  private text(part: "name"): Piece {
    return piece("input", {
      key: part,
      type: "text",
      class: "rule-field",
      value: this.choice[part],
      maxLength: 64,
      "aria-label": "Name of what is made",
      "data-test": `menu-${part}`,
      on: { input: ({ currentTarget }) => this.set({ [part]: currentTarget.value }), keydown: (event) => event.stopPropagation() },
    });
  }

  private select(part: "of" | "crop" | "spare", label: string, names: readonly string[]): Piece {
    const options = names.map((name) =>
      piece("option", { key: name, value: name, selected: name === this.choice[part] }, name === "" ? "nothing" : name === BODY ? "body" : name),
    );
    return piece(
      "select",
      { key: part, "aria-label": label, "data-test": `menu-${part}`, on: { change: ({ currentTarget }) => this.set({ [part]: currentTarget.value }) } },
      ...options,
    );
  }

  private length(part: "margin" | "cropGap" | "spareMargin", label: string, least: number, disabled = false): Piece {
    return piece("input", {
      key: part,
      type: "number",
      class: "rule-length",
      min: String(least),
      max: "100",
      step: "0.5",
      value: String(this.choice[part]),
      disabled,
      title: label,
      "aria-label": label,
      "data-test": `menu-${part}`,
      on: { input: ({ currentTarget }) => this.take(part, currentTarget.valueAsNumber), keydown: (event) => event.stopPropagation() },
    });
  }

  private take(part: "margin" | "cropGap" | "spareMargin", length: number): void {
    if (Number.isFinite(length)) this.set({ [part]: length });
  }
}
