// SPDX-License-Identifier: Apache-2.0
import type { Plane } from "../geometry/plane";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import { completed, completions, type Completion } from "../model/rule_words";
import { volumeText } from "../model/volumes";
import type { Caller } from "../net/calls";
import { VIEW_NAMES, type RuleProblem } from "../net/protocol";
import type { RulePreview } from "../tools/rule_preview";
import { RuleMenu } from "./rule_menu";
import { buttonPiece, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, render, type Piece } from "../dom/pieces";

const REST_MS = 250; // of who types, before more is asked than whether the line is right

export interface RuleServices {
  navigation: Navigation;
  project: Project;
  preview: RulePreview;
  ask: Caller;
  failed(error: unknown): void;
}

/** A line to type a rule in, such as "PTV = CTV + 5 mm": names are completed, errors show their place, and what it would make is seen. */
export class RuleLine {
  readonly element = el("section", { class: "rule-line", "aria-label": "Rule for a structure", "data-test": "rule-line", hidden: true });
  private readonly field = el("input", {
    type: "text",
    class: "rule-field",
    placeholder: "PTV = CTV + 5 mm",
    "aria-label": "Rule, such as PTV = CTV + 5 mm",
    spellcheck: false,
    autocomplete: "off",
    maxLength: 1000,
    "data-test": "rule-field",
    on: {
      input: () => this.typed(),
      keydown: (event) => this.key(event),
      click: () => this.complete(),
    },
  });
  private readonly menu: RuleMenu;
  private offered: Completion[] = [];
  private chosen = 0; // of these
  private problem: RuleProblem | null = null;
  private made: { name: string; isNew: boolean } | null = null;
  private volume: string | null = null;
  private asked = 0; // checks and previews are of the newest line alone
  private timer = 0;

  constructor(private readonly services: RuleServices) {
    const { project, navigation } = services;
    this.menu = new RuleMenu(
      () => [...project.structures.values()].map(({ name }) => name),
      (line) => this.put(line),
    );
    project.on(["surfaces", "structures"], () => this.previewSoon());
    navigation.on(["planes"], () => this.previewSoon());
    this.update();
  }

  get isOpen(): boolean {
    return !this.element.hidden;
  }

  open(line = ""): void {
    this.element.hidden = false;
    this.field.value = line;
    this.menu.reset(this.services.project.activeStructure?.name);
    this.menu.element.hidden = line !== ""; // they begin a rule, and do not read one
    this.typed();
    this.field.focus();
    this.field.setSelectionRange(line.length, line.length);
  }

  close(): void {
    this.element.hidden = true;
    ++this.asked;
    window.clearTimeout(this.timer);
    this.services.preview.show([]);
  }

  /** A line that the menus wrote. */
  private put(line: string): void {
    this.field.value = line;
    this.offered = [];
    this.update();
    void this.check();
  }

  private typed(): void {
    this.complete();
    void this.check();
  }

  private complete(): void {
    const line = this.field.value;
    const made = /^\s*(?:'([^']*)'|"([^"]*)"|([^\s=]+))\s*=/.exec(line);
    const own = made?.[1] ?? made?.[2] ?? made?.[3];
    const names = [...this.services.project.structures.values()].map(({ name }) => name).filter((name) => name !== own);
    this.offered = completions(line, this.field.selectionStart ?? line.length, names);
    this.chosen = 0;
    this.update();
  }

  private take(completion: Completion): void {
    const { line, caret } = completed(this.field.value, this.field.selectionStart ?? this.field.value.length, completion);
    this.field.value = line;
    this.field.setSelectionRange(caret, caret);
    this.field.focus();
    this.typed();
  }

  private key(event: KeyboardEvent): void {
    event.stopPropagation(); // letters are no tools here
    const { offered } = this;
    const completion = offered[this.chosen];
    const turn = { ArrowDown: 1, ArrowUp: -1 }[event.key];
    if (turn !== undefined && offered.length > 0) this.chosen = (this.chosen + turn + offered.length) % offered.length;
    else if ((event.key === "Tab" || event.key === "Enter") && completion) this.take(completion);
    else if (event.key === "Enter") void this.submit();
    else if (event.key === "Escape" && completion) this.offered = [];
    else if (event.key === "Escape") this.close();
    else return;
    event.preventDefault();
    this.update();
  }

  /** Whether it is a rule; what is wrong with it is seen at once. */
  private async check(): Promise<void> {
    const line = this.field.value;
    const number = ++this.asked;
    this.made = null;
    this.volume = null;
    if (line.trim() === "") {
      this.problem = null;
      this.services.preview.show([]);
      return this.update();
    }
    try {
      const { problem, name, is_new } = await this.services.ask("rule.check", { line });
      if (number !== this.asked) return;
      this.problem = problem ?? null;
      this.made = name === undefined ? null : { name, isNew: is_new ?? true };
      if (!this.made) this.services.preview.show([]);
      this.update();
      this.previewSoon();
    } catch (error) {
      this.services.failed(error);
    }
  }

  private previewSoon(): void {
    window.clearTimeout(this.timer);
    if (this.isOpen && this.made) this.timer = window.setTimeout(() => void this.preview(), REST_MS);
  }

  private async preview(): Promise<void> {
    const line = this.field.value;
    const number = this.asked;
    const planes: Plane[] = VIEW_NAMES.map((view) => {
      const { origin, u, v, normal } = this.services.navigation.plane(view);
      return { origin, u, v, normal };
    });
    try {
      const { volume_ml, lines } = await this.services.ask("rule.preview", { line, planes });
      if (number !== this.asked || !this.isOpen) return;
      this.volume = volumeText(volume_ml);
      this.services.preview.show(planes.map((plane, n) => ({ plane, lines: lines[n] ?? [] })));
    } catch (error) {
      if (number !== this.asked) return;
      this.volume = null;
      this.problem = { text: error instanceof Error ? error.message : String(error) };
    }
    this.update();
  }

  private async submit(): Promise<void> {
    if (!this.made) return;
    try {
      const { structure } = await this.services.ask("rule.set", { line: this.field.value });
      this.close();
      this.services.project.activate(structure.id);
    } catch (error) {
      this.services.failed(error);
    }
  }

  private update(): void {
    const { made } = this;
    const take = buttonPiece({
      label: made && !made.isNew ? "Change" : "Add",
      title: made ? `Have ${made.name} made by this rule (Enter)` : "Have a structure made by this rule (Enter)",
      class: "choice",
      test: "rule-take",
      more: { disabled: !made },
      click: () => void this.submit(),
    });
    const leave = buttonPiece({ icon: ICONS.close, title: "Leave the rule (Esc)", class: "icon-button small", test: "rule-leave", click: () => this.close() });
    const volume = piece("span", { class: "rule-volume", "data-test": "rule-volume", "aria-live": "polite" }, this.volume ?? "");
    render(this.element, [
      piece("div", { class: "rule-row" }, this.field, leave),
      this.menu.element,
      this.list(),
      this.problemPiece(),
      piece("div", { class: "rule-row" }, volume, take),
    ]);
  }

  private list(): Piece | null {
    if (this.offered.length === 0) return null;
    const entries = this.offered.map((completion, n) =>
      buttonPiece({
        label: completion.text,
        title: `${completion.text} (Tab)`,
        class: `choice${n === this.chosen ? " chosen" : ""}`,
        part: `offer-${completion.text}`,
        test: "rule-offer",
        click: () => this.take(completion),
      }),
    );
    return piece("div", { key: "offers", class: "rule-offers", "aria-label": "What can stand here" }, ...entries);
  }

  private problemPiece(): Piece | null {
    const { problem } = this;
    if (!problem) return null;
    const line = this.field.value;
    const { at } = problem;
    const place =
      at === undefined
        ? null
        : piece(
            "code",
            { class: "rule-place", "data-test": "rule-place" },
            line.slice(0, at),
            piece("mark", {}, wordAt(line, at)),
            line.slice(at + wordAt(line, at).length),
          );
    return piece("div", { key: "problem", class: "rule-problem", role: "status", "data-test": "rule-problem" }, place, piece("p", {}, sentence(problem.text)));
  }
}

/** What stands at the place of an error; a blank at the line's end, which is seen as a mark, too. */
function wordAt(line: string, at: number): string {
  return /^(?:'[^']*'?|"[^"]*"?|[\w.\u0080-\uffff]+|.)/u.exec(line.slice(at))?.[0] ?? " ";
}

const sentence = (text: string): string => `${text.charAt(0).toUpperCase()}${text.slice(1)}${/[.?!]$/.test(text) ? "" : "."}`;
