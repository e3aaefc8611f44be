// SPDX-License-Identifier: Apache-2.0
import type { SecondImage, Shown } from "../model/second_image";
import type { Identity, Session } from "../net/protocol";
import { COLOR_MAPS, gradientOf, type ColorMapName } from "../model/color_maps";
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { sizeLine } from "./identity";
import { piece, render, setValue } from "../dom/pieces";
import { presetOptions, windowField } from "./window_field";

/** What an image is called where there are two: its modality, or else its place. */
export const shortName = ({ modality }: Pick<Identity, "modality">, else_: string): string => modality || else_;

const short = (value: number): string => String(Number(value.toPrecision(3)));

/** They move the slider, not the slice; the other keys are the page's while it has the keyboard. */
export function keepSliderKeys(event: KeyboardEvent): void {
  if (/^(Arrow|Page)|^(Home|End)$/.test(event.key)) event.stopPropagation();
}

/** What the second image is, which of the two are seen, and how: below the identity of the first. */
export class SecondImageCard {
  readonly element = el("section", { class: "second-card", "aria-label": "Second image", "data-test": "second-image", hidden: true });
  private readonly title = el("strong", {});
  private readonly fold = button({
    label: "",
    title: "Fold the card of the second image",
    class: "fold",
    test: "fold-second",
    click: () => this.second.toggleFolded(),
  });
  private readonly lines = el("div", { class: "second-lines" });
  private readonly look: HTMLElement[];
  private readonly choices = new Map<Shown, HTMLButtonElement>();
  private readonly opacity = el("input", {
    type: "range",
    min: "0",
    max: "1",
    step: "0.01",
    "aria-label": "Opacity of the second image",
    "data-test": "second-opacity",
    on: { input: () => this.second.setOpacity(this.opacity.valueAsNumber), keydown: keepSliderKeys },
  });
  private readonly percent = el("output", { class: "second-percent" });
  private readonly colors = el("select", { title: "Colours of the second image", "data-test": "second-colors", on: { change: () => this.chooseColors() } });
  private readonly presets = el("select", { title: "Windows of the second image", "data-test": "second-presets", on: { change: () => this.choosePreset() } });
  private readonly low = this.field("Where the colours begin", "second-low");
  private readonly high = this.field("Where the colours end", "second-high");
  private readonly bar = el("div", { class: "second-bar", "aria-hidden": "true" });
  private readonly unit = el("span", { class: "second-unit" });
  private first = "First";

  constructor(
    private readonly second: SecondImage,
    remove: () => void,
  ) {
    const titles: Record<Shown, string> = {
      first: "The project's own image alone (O)",
      both: "The second image over the first (O)",
      second: "The second image alone: what you draw follows its edges (I)",
    };
    for (const shown of ["first", "both", "second"] as const)
      this.choices.set(shown, button({ label: shown, title: titles[shown], class: "tool", test: `show-${shown}`, click: () => second.show(shown) }));
    for (const { name, label } of COLOR_MAPS) this.colors.append(el("option", { value: name }, label));
    const close = button({
      icon: ICONS.close,
      title: "Remove the second image from the project",
      class: "icon-button small",
      test: "remove-image",
      click: remove,
    });
    this.look = [
      el("label", { class: "second-row" }, "Opacity", this.opacity, this.percent),
      el("div", { class: "second-row" }, this.colors, this.presets),
      this.bar,
      el("div", { class: "second-scale" }, this.low, this.unit, this.high),
    ];
    this.element.append(
      el("div", { class: "second-head" }, this.fold, this.title, close),
      this.lines,
      el("div", { class: "second-choices", role: "group", "aria-label": "Which image is seen" }, ...this.choices.values()),
      ...this.look,
    );
    second.on(["image"], () => this.fill());
    second.on(["shown", "look"], () => this.update());
  }

  /** Whose image it lies over. */
  start({ identity }: Pick<Session, "identity">): void {
    this.first = shortName(identity, "First");
    this.fill();
  }

  private fill(): void {
    const { info } = this.second;
    this.element.hidden = info === null;
    if (!info) return;
    const { identity, title, notes } = info;
    const what = [
      identity.modality,
      identity.series_number && `series ${identity.series_number}`,
      identity.series_description || (identity.modality === "" && title),
    ]
      .filter(Boolean)
      .join(" · ");
    this.title.textContent = what;
    this.title.title = title;
    render(
      this.lines,
      [sizeLine(info), ...notes].map((line) => piece("span", { title: line }, line)),
    );
    const name = shortName(identity, "Second");
    const labels: Record<Shown, string> = { first: this.first, both: "Both", second: name === this.first ? "Second" : name };
    for (const [shown, choice] of this.choices) choice.querySelector("span")!.textContent = labels[shown];
    render(this.presets, presetOptions(info.presets));
    this.unit.textContent = info.unit;
    this.update();
  }

  private update(): void {
    const { second } = this;
    if (!second.info) return;
    for (const [shown, choice] of this.choices) choice.setAttribute("aria-pressed", String(shown === second.shown));
    for (const part of [this.lines, ...this.look]) part.hidden = second.isFolded;
    this.fold.setAttribute("aria-expanded", String(!second.isFolded));
    this.fold.title = second.isFolded ? "Show opacity, colours and window of the second image" : "Fold the card of the second image";
    this.fold.setAttribute("aria-label", "Details of the second image");
    this.opacity.value = String(second.opacity);
    this.opacity.disabled = second.shown !== "both";
    this.percent.textContent = `${Math.round(100 * second.opacity)} %`;
    this.colors.value = second.colors;
    this.bar.style.background = gradientOf(second.colors);
    const { center, width } = second.window;
    setValue(this.low, short(center - width / 2));
    setValue(this.high, short(center + width / 2));
    const preset = second.info.presets.findIndex((one) => short(one.center) === short(center) && short(one.width) === short(width));
    this.presets.value = preset < 0 ? "" : String(preset);
  }

  private field(title: string, test: string): HTMLInputElement {
    const field = windowField(
      title,
      () => this.typeWindow(),
      () => this.update(),
    );
    field.setAttribute("aria-label", title);
    field.dataset["test"] = test;
    return field;
  }

  private typeWindow(): void {
    const low = this.low.valueAsNumber;
    const high = this.high.valueAsNumber;
    if (low < high) this.second.setWindow({ center: (low + high) / 2, width: high - low });
  }

  private choosePreset(): void {
    const preset = this.second.info?.presets[Number(this.presets.value)];
    if (preset) this.second.setWindow(preset);
    this.presets.blur();
  }

  private chooseColors(): void {
    this.second.setColors(this.colors.value as ColorMapName);
    this.colors.blur();
  }
}
