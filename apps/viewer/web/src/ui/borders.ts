// SPDX-License-Identifier: Apache-2.0
import { chosenSentence, foundAbout, inWords, pairsToShow, percent, ruleAbout } from "../model/borders";
import type { Project } from "../model/project";
import type { Maker } from "../net/calls";
import type { BorderRule, Relation } from "../net/protocol";
import { openDialog } from "./dialogs";
import { button, el } from "../dom/dom";
import { piece, render, type Piece } from "../dom/pieces";

export interface BorderServices {
  project: Project;
  call: Maker;
}

/** Whether structures share borders, which rules were chosen for the user, and a way to others. */
export class BorderPanel {
  readonly element = el("div", { class: "borders", hidden: true });
  private readonly shared = el("input", {
    type: "checkbox",
    "data-test": "share-borders",
    on: { change: () => this.services.call("borders.set", { shared: this.shared.checked }) },
  });
  private readonly rules = button({
    label: "Rules…",
    title: "How pairs of structures lie to each other: exclusive, inside, may overlap",
    class: "choice",
    test: "border-rules",
    click: () => openBorderRules(this.services),
  });
  private readonly sentence = el("p", { class: "fine", role: "status", "data-test": "border-sentence" });

  constructor(private readonly services: BorderServices) {
    const label = el(
      "label",
      {
        class: "check",
        title:
          "Structures share borders: where they exclude each other they have one border, without gap or overlap: a line that is moved moves the neighbour's",
      },
      this.shared,
      "Structures share borders",
    );
    this.element.append(el("div", { class: "borders-row" }, label, this.rules), this.sentence);
    services.project.on(["structures", "borders", "refused"], () => this.update());
  }

  private update(): void {
    const { borders, borderPairs, structures } = this.services.project;
    this.element.hidden = structures.size < 2;
    this.shared.checked = borders.shared;
    this.rules.hidden = !borders.shared;
    const text = chosenSentence(borders, borderPairs, structures);
    if (this.sentence.textContent !== text) this.sentence.textContent = text;
  }
}

/** The name of a choice, and the rule that it stands for; null: none. */
type Choice = [string, Relation | "auto", number, number];

/** A rule for each pair; what is chosen counts at once, and can be taken back. */
function openBorderRules({ project, call }: BorderServices): void {
  const rows = el("div", { class: "border-rules" });
  const update = () =>
    render(
      rows,
      pairsToShow(project.borders, project.borderPairs, project.structures).map(([a, b]) => row(project, call, a, b)),
    );
  const off = project.on(["structures", "borders", "refused"], update);
  update();
  const dialog = openDialog(
    "How structures lie to each other",
    "border-rules-dialog",
    rows,
    el(
      "p",
      { class: "dialog-status" },
      "Without a rule, what the surfaces have in common decides: more than 80 % of the smaller one lies inside, from 25 % on they may overlap, else they exclude each other. Exports follow the same rules.",
    ),
  );
  dialog.addEventListener("close", off);
}

function row(project: Project, call: BorderServices["call"], a: number, b: number): Piece {
  const { borders, borderPairs, structures } = project;
  const found = foundAbout(borderPairs, a, b);
  const given = ruleAbout(borders, a, b);
  const words = (rule: BorderRule) => inWords(rule, structures);
  const choices: Choice[] = [
    [found ? `As found: ${words(found)} (${percent(found.share)} in common)` : "No rule", "auto", a, b],
    [words({ first: a, second: b, relation: "exclusive" }), "exclusive", a, b],
    [words({ first: a, second: b, relation: "inside" }), "inside", a, b],
    [words({ first: b, second: a, relation: "inside" }), "inside", b, a],
    [words({ first: a, second: b, relation: "overlap" }), "overlap", a, b],
  ];
  const isChosen = ([, relation, first]: Choice) =>
    given ? relation === given.relation && (relation !== "inside" || first === given.first) : relation === "auto";
  const names = `${structures.get(a)!.name} and ${structures.get(b)!.name}`;
  const change = (chosen: string) => {
    const [, relation, first, second] = choices[Number(chosen)]!;
    call("borders.rule", { first, second, relation });
  };
  const select = piece(
    "select",
    {
      "aria-label": names,
      "data-test": `rule-${a}-${b}`,
      value: choices.findIndex(isChosen),
      on: { change: ({ currentTarget }) => change(currentTarget.value) },
    },
    ...choices.map((choice, i) => piece("option", { value: String(i) }, choice[0])),
  );
  return piece("label", { key: `${a}-${b}`, class: "field" }, names, select);
}
