// SPDX-License-Identifier: Apache-2.0
import { gap, toWorld, type Point2, type Screen } from "../geometry/screen";
import { sub } from "../geometry/vec";
import type { Navigation } from "../model/navigation";
import type { ViewName, Window } from "../net/protocol";
import type { Editor } from "./editor";
import { fingerPair } from "./finger_pair";
import { Fingers } from "./fingers";
import { CLICK_PIXELS, type Gesture } from "./gesture";
import type { Pointers } from "./pointers";

/** What input needs of the view that it comes from. */
export interface InputView {
  readonly name: ViewName;
  readonly element: HTMLElement;
  /** Its title, which lies over the slice. */
  readonly header: HTMLElement;
  /** Where the pointer is heard. */
  readonly overlay: HTMLElement;
  /** Null before the view is laid out. */
  screen(): Screen | null;
  /** In pixels of the screen. */
  pointOf(event: PointerEvent | WheelEvent): Point2;
}

export interface InputServices {
  navigation: Navigation;
  editor: Editor;
  pointers: Pointers; // of all views
  isPanning(): boolean; // space is held
  /** The image that a drag puts into another window; with Shift the other one of two. */
  windowed(isShifted: boolean): Windowed;
  pointed(view: InputView, event: PointerEvent): void;
  jump(view: InputView, event: PointerEvent): void;
  /** What can be done by what has begun, until it ends. */
  hint(text: string | null): void;
}

/** What the right button puts into another window. */
export interface Windowed {
  window: Window;
  setWindow(window: Window): void;
}

const WHEEL_STEP = 60; // of deltaY in pixels, for touchpads that send many small ones
const FINGER_REACH = 2.2;

/** Lets mouse and fingers scroll, zoom, pan and window a view, and hands the left button, the pen and one finger to the editor. */
export class ViewInput {
  private gesture: Gesture | null = null;
  private tookPress = false; // the last one
  private wheelRest = 0;
  private readonly fingers: Fingers;

  constructor(
    private readonly view: InputView,
    private readonly services: InputServices,
  ) {
    const canvas = view.overlay;
    this.fingers = new Fingers({
      press: (at) => this.pressByFinger(at),
      rest: (at) => this.windowAfterRest(at),
      pair: (a, b) => fingerPair(view.name, services.navigation, () => view.screen(), a, b),
      later: (act, ms) => {
        const timer = window.setTimeout(act, ms);
        return () => window.clearTimeout(timer);
      },
    });
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    view.header.addEventListener("pointerdown", (event) => this.pressTitle(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    for (const type of ["pointercancel", "lostpointercapture"] as const)
      canvas.addEventListener(type, (event) => {
        if (services.pointers.holds(event)) this.cancel();
      });
    canvas.addEventListener("pointercancel", (event) => {
      if (isTouch(event) && this.fingers.drop(event.pointerId)) services.pointers.release();
    });
    canvas.addEventListener("pointerleave", (event) => {
      if (this.gesture === null && !services.pointers.ignores(event)) services.editor.left();
    });
    canvas.addEventListener("dblclick", () => {
      if (this.tookPress) services.editor.doubleClick();
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    view.element.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  /** Leaves what the pointer is doing; false when it is doing nothing. */
  cancel(): boolean {
    if (this.fingers.cancel()) {
      this.services.pointers.release();
      return true;
    }
    const gesture = this.release();
    gesture?.cancel?.();
    return gesture !== null;
  }

  /** A stroke may begin on the title; a click there stays the title's. */
  private pressTitle(press: PointerEvent): void {
    if (press.target instanceof Element && press.target.closest("button")) return;
    const end = () => {
      window.removeEventListener("pointermove", follow);
      window.removeEventListener("pointerup", end);
      window.removeEventListener("pointercancel", end);
    };
    const follow = (event: PointerEvent) => {
      if (event.pointerId !== press.pointerId || gap(this.view.pointOf(press), this.view.pointOf(event)) <= CLICK_PIXELS) return;
      end();
      this.down(press);
      this.move(event);
    };
    window.addEventListener("pointermove", follow);
    window.addEventListener("pointerup", end);
    window.addEventListener("pointercancel", end);
  }

  private down(event: PointerEvent): void {
    const screen = this.view.screen();
    const { editor, pointers } = this.services;
    if (isTouch(event) && !pointers.isPalm(event) && this.fingers.join(event.pointerId, this.view.pointOf(event))) return;
    this.tookPress = screen !== null && pointers.take(event, () => void this.cancel());
    if (!screen || !this.tookPress) return;
    this.view.overlay.focus({ preventScroll: true });
    this.view.overlay.setPointerCapture(event.pointerId);
    const at = this.view.pointOf(event);
    event.preventDefault();
    if (isTouch(event)) return this.fingers.begin(event.pointerId, at);
    const modifiers = { ctrl: event.ctrlKey || event.metaKey, shift: event.shiftKey };
    if (event.button === 2) this.gesture = this.windowGesture(at, event.shiftKey);
    else if (event.button === 1 || (event.button === 0 && this.services.isPanning())) this.gesture = this.panGesture(at);
    else if (event.button === 0) this.gesture = editor.press(this.view.name, screen, at, modifiers);
    if (!this.gesture) pointers.release();
  }

  private move(event: PointerEvent): void {
    const screen = this.view.screen();
    if (isTouch(event)) return this.moveFinger(event);
    if (!screen || this.services.pointers.ignores(event)) return;
    const at = this.view.pointOf(event);
    this.services.pointed(this.view, event);
    if (this.gesture) return this.follow(this.gesture, event);
    if (event.shiftKey && event.buttons === 0) return this.services.jump(this.view, event);
    this.services.editor.moved(this.view.name, screen, at);
  }

  private moveFinger(event: PointerEvent): void {
    const { pointers } = this.services;
    if (pointers.holds(event)) this.services.pointed(this.view, event);
    if (!pointers.isPalm(event)) this.fingers.move(event.pointerId, this.placesOf(event));
  }

  private follow(gesture: Gesture, event: PointerEvent): void {
    for (const place of gesture.isStroke ? this.placesOf(event) : [this.view.pointOf(event)]) gesture.move(place);
  }

  /** A busy page gets one event for several places of the pointer. */
  private placesOf(event: PointerEvent): Point2[] {
    const places = event.getCoalescedEvents?.() ?? []; // older browsers have none
    return (places.length > 0 ? places : [event]).map((place) => this.view.pointOf(place));
  }

  private up(event: PointerEvent): void {
    if (isTouch(event)) return this.liftFinger(event);
    if (!this.services.pointers.holds(event)) return;
    this.release()?.end(this.view.pointOf(event));
  }

  private liftFinger(event: PointerEvent): void {
    const { pointers, hint } = this.services;
    if (pointers.isPalm(event) || !this.fingers.lift(event.pointerId, this.view.pointOf(event))) return;
    pointers.release();
    hint(null);
  }

  private pressByFinger(at: Point2): Gesture | null {
    const screen = this.view.screen();
    return screen && this.services.editor.press(this.view.name, { ...screen, reach: FINGER_REACH }, at, { ctrl: false, shift: false });
  }

  private windowAfterRest(at: Point2): Gesture {
    this.services.hint("Drag for the window: width to the right, centre up and down");
    navigator.vibrate?.(15); // Firefox and Safari have none
    return this.windowGesture(at);
  }

  private release(): Gesture | null {
    const gesture = this.gesture;
    this.gesture = null;
    if (gesture) this.services.pointers.release();
    return gesture;
  }

  private wheel(event: WheelEvent): void {
    event.preventDefault();
    const { navigation } = this.services;
    const delta = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? event.deltaY * 20 : event.deltaY;
    const screen = this.view.screen();
    if (!screen) return;
    if (event.ctrlKey || event.metaKey) return this.grow(screen, this.view.pointOf(event), Math.exp(-delta / 400));
    this.wheelRest += delta;
    const steps = Math.trunc(this.wheelRest / WHEEL_STEP);
    this.wheelRest -= steps * WHEEL_STEP;
    if (steps !== 0) navigation.scroll(this.view.name, Math.abs(delta) >= 100 ? Math.sign(steps) : steps);
  }

  private grow(screen: Screen, at: Point2, factor: number): void {
    if (!this.services.editor.wheel(factor)) this.services.navigation.zoomAt(this.view.name, toWorld(screen, at), factor);
  }

  private panGesture(start: Point2): Gesture {
    let last = start;
    return {
      move: (at) => {
        const screen = this.view.screen();
        if (screen) this.services.navigation.pan(this.view.name, sub(toWorld(screen, last), toWorld(screen, at)));
        last = at;
      },
      end: () => undefined,
    };
  }

  /** To the right: more contrast range; up: darker, as radiologists' workstations do. */
  private windowGesture(start: Point2, isShifted = false): Gesture {
    const image = this.services.windowed(isShifted);
    const { center, width } = image.window;
    const gain = Math.max(width, 1e-6) / 300;
    return {
      move: (at) => image.setWindow({ center: center + (at[1] - start[1]) * gain, width: width + (at[0] - start[0]) * gain * 2 }),
      end: () => undefined,
    };
  }
}

const isTouch = ({ pointerType }: PointerEvent): boolean => pointerType === "touch";
