// SPDX-License-Identifier: Apache-2.0
import type { Cine } from "../model/cine";
import { drawnTimes } from "../model/drawn_times";
import type { Navigation } from "../model/navigation";
import type { Project } from "../model/project";
import type { Maker } from "../net/calls";
import { button, buttonPiece, el } from "../dom/dom";
import { ICONS } from "../dom/icons";
import { iconPiece, piece, render, type Piece } from "../dom/pieces";
import { keepSliderKeys } from "./second_image_card";
import { CurveView, showFigures } from "./volume_curve";

export interface TimeStripServices {
  navigation: Navigation;
  project: Project;
  cine: Cine;
  call: Maker;
  /** Offers the outline of the slice that keys are for. */
  proposeHere(): void;
}

/** Below the views, for images that have several volumes in time: which one is seen, where something was drawn, and the volume. */
export class TimeStrip {
  readonly element = el("section", { class: "time-strip", "aria-label": "Time", "data-test": "time", hidden: true });
  private readonly play: HTMLButtonElement;
  private readonly back: HTMLButtonElement;
  private readonly slider = el("input", {
    type: "range",
    min: "1",
    step: "1",
    "aria-label": "Frame",
    "data-test": "time-slider",
    on: { input: () => this.show(this.slider.valueAsNumber - 1), keydown: keepSliderKeys },
  });
  private readonly frame = el("output", { class: "time-frame", "data-test": "time-frame" });
  private readonly marks = el("div", { class: "time-marks", "data-test": "time-marks" });
  private readonly figures = el("div", { class: "time-figures", "data-test": "figures", hidden: true });
  private readonly motion = el("div", { class: "time-motion" });
  private readonly curve = new CurveView((time) => this.show(time));
  private isQueued = false;

  constructor(private readonly services: TimeStripServices) {
    const { navigation, cine, project } = services;
    this.play = button({ icon: ICONS.play, title: "", class: "icon-button small", test: "play", click: () => void cine.toggle() });
    this.back = button({ icon: ICONS.reset, title: "", class: "icon-button small", test: "own-time", click: () => this.show(navigation.ownTime) });
    const track = el("div", { class: "time-track" }, this.curve.element, this.marks, this.slider);
    const row = el("div", { class: "time-row" }, this.play, track, this.frame, this.back);
    this.element.append(row, el("div", { class: "time-row" }, this.figures, this.motion));
    navigation.on(["time"], () => this.updateFrame());
    cine.on(["playing"], () => this.updateFrame());
    project.on(["contours", "structures", "motions", "selection", "time"], () => this.updateSoon());
  }

  private show(time: number): void {
    this.services.cine.pause();
    this.services.navigation.setTime(time);
  }

  private updateFrame(): void {
    const { navigation, cine } = this.services;
    this.element.hidden = navigation.times < 2;
    this.slider.max = String(navigation.times);
    this.slider.value = String(navigation.time + 1);
    this.frame.textContent = `${navigation.time + 1} / ${navigation.times}`;
    this.back.disabled = !navigation.isAway;
    name(this.back, `Back to frame ${navigation.ownTime + 1}, in which the image was opened`);
    name(this.play, cine.isPlaying ? "Pause (T)" : "Play the frames (T)");
    render(this.play, [iconPiece(cine.isPlaying ? ICONS.pause : ICONS.play)]);
  }

  /** Once in a frame of the screen, however much has changed. */
  private updateSoon(): void {
    if (this.isQueued || this.services.navigation.times < 2) return;
    this.isQueued = true;
    requestAnimationFrame(() => {
      this.isQueued = false;
      this.update();
    });
  }

  private update(): void {
    const { project, navigation } = this.services;
    const active = project.activeStructure;
    const motion = active && project.motions.get(active.id);
    render(this.marks, this.markPieces());
    this.curve.show(motion?.curve, navigation.time, active?.color ?? "#888888");
    showFigures(this.figures, motion?.curve, (time) => this.show(time));
    this.figures.classList.toggle("outdated", motion?.finished === false);
    this.element.dataset["motion"] = !motion ? "none" : motion.finished ? "finished" : "coming";
    render(this.motion, motion ? [...this.cyclePieces(), this.proposePiece()] : []);
  }

  private markPieces(): Piece[] {
    const { navigation, project } = this.services;
    return drawnTimes(project).map(({ time, contours, ofActive }) => {
      const count = ofActive > 0 ? ofActive : contours;
      const mark = piece("button", {
        type: "button",
        class: ofActive > 0 ? "time-mark" : "time-mark other",
        title: `Frame ${time + 1}: ${count} ${count === 1 ? "contour" : "contours"}${ofActive > 0 ? "" : " of other structures"}`,
        "aria-label": `Frame ${time + 1}`,
        "data-time": String(time),
        key: time,
        style: { left: `${(100 * time) / Math.max(1, navigation.times - 1)}%` },
        on: { click: () => this.show(time) },
      });
      return mark;
    });
  }

  /** Asked once; afterwards it can be changed. */
  private cyclePieces(): Piece[] {
    const { project, navigation, call } = this.services;
    const { cycleFrames } = project;
    const set = (repeats: boolean) => call("cycle.set", { repeats });
    if (cycleFrames === null)
      return [
        piece("span", { class: "warning-text", "data-test": "cycle-question" }, `Does frame 1 follow frame ${navigation.times}, as in a heartbeat?`),
        buttonPiece({
          label: "It repeats",
          title: "The motion goes on from the last frame to the first",
          class: "choice",
          test: "cycle-yes",
          click: () => set(true),
        }),
        buttonPiece({
          label: "It does not",
          title: "Nothing moves before the first and after the last drawn frame",
          class: "choice",
          test: "cycle-no",
          click: () => set(false),
        }),
      ];
    const repeats = cycleFrames > 0;
    const text = repeats ? `Repeats after ${Number(cycleFrames.toFixed(1))} frames` : "Does not repeat";
    return [buttonPiece({ label: text, title: repeats ? "Let it not repeat" : "Let it repeat", class: "choice", test: "cycle", click: () => set(!repeats) })];
  }

  private proposePiece(): Piece {
    const title = "Propose the outline on the slice that keys are for; Enter takes it (Y)";
    return buttonPiece({ label: "Propose here", title, class: "choice", test: "propose-here", click: () => this.services.proposeHere() });
  }
}

function name(control: HTMLButtonElement, title: string): void {
  control.title = title;
  control.setAttribute("aria-label", title);
}
