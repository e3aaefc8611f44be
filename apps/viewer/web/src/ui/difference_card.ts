// SPDX-License-Identifier: Apache-2.0
import type { Vec3 } from "../geometry/vec";
import { lengthText } from "../model/lengths";
import type { Project } from "../model/project";
import { volumeText } from "../model/volumes";
import type { Http } from "../net/http";
import type { Comparison, Difference } from "../net/protocol";
import { buttonPiece, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { piece, render, type Piece } from "../dom/pieces";

export interface DifferenceServices {
  http: Http;
  project: Project;
  /** All views go there. */
  goTo(p: Vec3): void;
  tell(text: string): void;
  failed(error: unknown): void;
}

const WHICH_TWO = "Choose two structures to compare in the statistics, and go through their differences from there.";

/** Two readers' structures side by side: how they agree, and where they differ, the farthest first. */
export class DifferenceCard {
  readonly element = el("section", { class: "rule-line differences", "aria-label": "Differences of two structures", "data-test": "differences", hidden: true });
  private pair: readonly [number, number] | null = null;
  private found: Comparison | null = null;
  private revisions: readonly number[] = []; // that were compared
  private at = -1;
  private running: AbortController | null = null;

  constructor(private readonly services: DifferenceServices) {
    services.project.on(["structures", "surfaces"], () => this.update());
  }

  /** Compares two, and goes to where they differ most. */
  async start(first: number, second: number): Promise<void> {
    this.pair = [first, second];
    this.found = null;
    this.at = -1;
    this.update();
    await this.step(1);
  }

  /** The next difference, or the one before. What has been drawn since then is compared anew. */
  async step(by: 1 | -1): Promise<void> {
    this.pair ??= this.onlyTwo();
    if (!this.pair) return this.services.tell(WHICH_TWO);
    try {
      if (!this.found || this.isStale()) await this.compare(this.pair);
    } catch (error) {
      if (!(error instanceof DOMException && error.name === "AbortError")) this.services.failed(error);
      return;
    }
    const all = this.found?.differences ?? [];
    this.at = Math.min(Math.max(this.at + by, 0), all.length - 1);
    const here = all[this.at];
    if (here) this.services.goTo(here.at);
    this.update();
  }

  close(): void {
    this.running?.abort();
    this.pair = this.found = null;
    this.update();
  }

  private onlyTwo(): [number, number] | null {
    const { project } = this.services;
    const [first, second, ...more] = [...project.structures.values()].filter((one) => project.hasContent(one));
    return first && second && more.length === 0 ? [first.id, second.id] : null;
  }

  private present(): number[] {
    return (this.pair ?? []).map((id) => this.services.project.revisionAt(id));
  }

  private isStale(): boolean {
    return this.present().some((revision, n) => revision !== this.revisions[n]);
  }

  private async compare([first, second]: readonly [number, number]): Promise<void> {
    this.running?.abort();
    const own = (this.running = new AbortController());
    this.found = null;
    this.at = -1;
    this.update();
    this.revisions = this.present();
    const found = await this.services.http.compare(first, second, own.signal);
    if (this.running === own && this.pair) this.found = found;
  }

  private name(id: number): string {
    return this.services.project.structures.get(id)?.name ?? "deleted";
  }

  private update(): void {
    const { pair, found } = this;
    this.element.hidden = !pair;
    if (!pair) return render(this.element, []);
    const [first, second] = pair.map((id) => this.name(id)) as [string, string];
    const leave = buttonPiece({
      icon: ICONS.close,
      title: "Compare no longer",
      class: "icon-button small",
      test: "differences-leave",
      click: () => this.close(),
    });
    const rows: (Piece | null)[] = [
      piece("div", { key: "names", class: "rule-row" }, piece("strong", { class: "rule-volume" }, `${first} and ${second}`), leave),
      piece("p", { key: "figures", class: "certainty", "data-test": "differences-figures" }, found ? figures(found) : "Comparing …"),
      found ? piece("p", { key: "here", class: "certainty", role: "status", "data-test": "difference" }, this.here(found, [first, second])) : null,
      this.buttons(found?.differences.length ?? 0),
    ];
    render(this.element, rows);
  }

  private buttons(count: number): Piece {
    const step = (label: string, by: 1 | -1, key: string, possible: boolean) =>
      buttonPiece({
        label,
        title: `${label} difference (${key})`,
        class: "choice",
        test: by > 0 ? "difference-next" : "difference-previous",
        more: { disabled: !possible },
        click: () => void this.step(by),
      });
    return piece(
      "div",
      { key: "steps", class: "rule-row" },
      step("Previous", -1, "Shift + J", this.at > 0),
      step("Next", 1, "J", this.at + 1 < count || (this.found !== null && this.isStale())),
    );
  }

  private here({ differences }: Comparison, names: readonly [string, string]): string {
    const one = differences[this.at];
    if (this.isStale()) return "Drawn on since; the next step compares anew.";
    if (!one) return differences.length === 0 ? "They do not differ." : `${differences.length} differences.`;
    return `${this.at + 1} of ${differences.length}: ${differenceText(one, names)}`;
  }
}

const figures = ({ dice, mean_mm, percentile_95_mm, volumes_ml: [a, b] }: Comparison): string =>
  `Dice ${dice.toFixed(3)}${mean_mm === null ? "" : `, mean ${lengthText(mean_mm, 2)}, 95 % within ${lengthText(percentile_95_mm!, 2)}`}; ${volumeText(a)} and ${volumeText(b)}`;

/** "4.2 mm, 0.31 ml in Reader 1 alone". */
export const differenceText = ({ distance_mm, volume_ml, in_first }: Difference, [first, second]: readonly [string, string]): string =>
  `${lengthText(distance_mm, 1)}, ${volumeText(volume_ml)} in ${in_first ? first : second} alone`;
