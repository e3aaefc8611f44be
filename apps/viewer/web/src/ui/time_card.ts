// SPDX-License-Identifier: Apache-2.0
import type { Navigation } from "../model/navigation";
import type { Cine } from "../model/cine";
import { button, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { iconPiece, render } from "../dom/pieces";
import { keepSliderKeys } from "./second_image_card";

/** Which of the image's volumes in time is seen, below the identity: for images that have several. */
export class TimeCard {
  readonly element = el("section", { class: "time-card", "aria-label": "Time", "data-test": "time", hidden: true });
  private readonly play: HTMLButtonElement;
  private readonly slider = el("input", {
    type: "range",
    min: "1",
    step: "1",
    "aria-label": "Frame",
    "data-test": "time-slider",
    on: { input: () => this.show(this.slider.valueAsNumber - 1), keydown: keepSliderKeys },
  });
  private readonly frame = el("output", { class: "time-frame", "data-test": "time-frame" });
  private readonly back: HTMLButtonElement;

  constructor(
    private readonly navigation: Navigation,
    private readonly cine: Cine,
  ) {
    this.play = button({ icon: ICONS.play, title: "", class: "icon-button small", test: "play", click: () => void cine.toggle() });
    this.back = button({ icon: ICONS.reset, title: "", class: "icon-button small", test: "own-time", click: () => this.show(navigation.ownTime) });
    this.element.append(this.play, this.slider, this.frame, this.back);
    navigation.on(["time"], () => this.update());
    cine.on(["playing"], () => this.update());
  }

  private show(time: number): void {
    this.cine.pause();
    this.navigation.setTime(time);
  }

  private update(): void {
    const { navigation, cine } = this;
    this.element.hidden = navigation.times < 2;
    this.slider.max = String(navigation.times);
    this.slider.value = String(navigation.time + 1);
    this.frame.textContent = `${navigation.time + 1} / ${navigation.times}`;
    this.back.disabled = !navigation.isAway;
    name(this.back, `Back to frame ${navigation.ownTime + 1}, which contours belong to`);
    name(this.play, cine.isPlaying ? "Pause (T)" : "Play the frames (T)");
    render(this.play, [iconPiece(cine.isPlaying ? ICONS.pause : ICONS.play)]);
  }
}

function name(control: HTMLButtonElement, title: string): void {
  control.title = title;
  control.setAttribute("aria-label", title);
}
