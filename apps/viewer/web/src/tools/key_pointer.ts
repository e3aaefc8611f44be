// SPDX-License-Identifier: Apache-2.0
import { toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import type { Vec3 } from "../geometry/vec";
import type { Navigation } from "../model/navigation";
import type { ViewName } from "../net/protocol";
import { el } from "../dom/dom";
import type { Editor } from "./editor";
import type { Gesture } from "./gesture";

export interface KeyPointerServices {
  navigation: Navigation;
  editor: Editor;
  /** Null while the view is not shown. */
  screenOf(view: ViewName): Screen | null;
  /** What the mark lies over. */
  elementOf(view: ViewName): HTMLElement | null;
  pointed(at: Vec3): void;
}

/** For those who draw without a mouse: a mark on a slice that keys move, and that presses where it is. */
export class KeyPointer {
  private readonly mark = el("div", { class: "key-pointer", "data-test": "key-pointer" });
  private place: { view: ViewName; at: Point2 } | null = null;
  private gesture: Gesture | null = null;

  constructor(private readonly services: KeyPointerServices) {}

  /** It begins at the crosshair. */
  move(view: ViewName, [right, down]: Point2): void {
    const screen = this.services.screenOf(view);
    if (!screen) return;
    const [x, y] = this.enter(view, screen);
    const at: Point2 = [within(x + right, screen.width), within(y + down, screen.height)];
    this.place = { view, at };
    this.mark.style.translate = `${at[0]}px ${at[1]}px`;
    if (this.gesture) this.gesture.move(at);
    else this.services.editor.moved(view, screen, at);
    this.services.pointed(toWorld(screen, at));
  }

  click(view: ViewName): void {
    if (!this.gesture) this.press(view);
    this.release();
  }

  /** Holds the button until the next time, so that moving drags. */
  hold(view: ViewName): void {
    if (this.gesture) this.release();
    else this.press(view);
  }

  /** Leaves what it has pressed, or else it goes; false where it was not there. */
  cancel(): boolean {
    const { gesture, place } = this;
    if (!gesture) this.hide();
    this.setGesture(null);
    gesture?.cancel?.();
    return gesture !== null || place !== null;
  }

  /** Another pointer has taken over. */
  hide(): void {
    if (this.gesture) return;
    this.place = null;
    this.mark.remove();
  }

  /** Where it is in this view. */
  private enter(view: ViewName, screen: Screen): Point2 {
    if (this.place?.view === view) return this.place.at;
    if (this.gesture) this.cancel();
    this.services.elementOf(view)?.append(this.mark);
    return toScreen(screen, this.services.navigation.crosshair);
  }

  private press(view: ViewName): void {
    this.move(view, [0, 0]);
    const screen = this.services.screenOf(view);
    if (screen && this.place) this.setGesture(this.services.editor.press(view, screen, this.place.at, { ctrl: false, shift: false }));
  }

  private release(): void {
    const { gesture, place } = this;
    this.setGesture(null);
    if (place) gesture?.end(place.at);
  }

  private setGesture(gesture: Gesture | null): void {
    this.gesture = gesture;
    this.mark.classList.toggle("pressed", gesture !== null);
  }
}

const within = (value: number, size: number): number => Math.min(Math.max(value, 0), size);
