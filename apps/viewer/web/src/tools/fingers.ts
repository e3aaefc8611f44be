// SPDX-License-Identifier: Apache-2.0
import { gap, type Point2 } from "../geometry/screen";
import type { Gesture } from "./gesture";

/** What two fingers do until one of them is lifted. */
export interface PairGesture {
  move(a: Point2, b: Point2): void;
}

export interface FingerServices {
  /** One finger does what the pointer does with the tool. */
  press(at: Point2): Gesture | null;
  /** One that has rested, when it moves. */
  rest(at: Point2): Gesture;
  pair(a: Point2, b: Point2): PairGesture;
  /** Calls after that time, unless what it returns is called before. */
  later(act: () => void, ms: number): () => void;
}

const TREMBLE_PIXELS = 8; // of a finger that rests
const PAIR_PIXELS = 24; // a finger that has gone farther draws, and another one beside it is a hand that leans on the screen
const REST_MS = 600;

/** The first finger: it waits until it moves, rests or is lifted, because a second one may follow. */
interface First {
  readonly id: number;
  readonly start: Point2;
  readonly way: Point2[]; // while it waits
  at: Point2;
  gesture: Gesture | null;
  isWaiting: boolean;
}

/** The fingers on one view: one works with the tool, or changes the window after a rest; two look around, and what one began is dropped. */
export class Fingers {
  private readonly touching = new Set<number>();
  private first: First | null = null;
  private second: { id: number; at: Point2; gesture: PairGesture } | null = null;
  private stopWaiting = () => {};

  constructor(private readonly services: FingerServices) {}

  /** The first one of all that touch. */
  begin(id: number, at: Point2): void {
    this.cancel();
    this.touching.clear(); // a lift may have been told to nobody
    this.touching.add(id);
    this.first = { id, start: at, way: [], at, gesture: null, isWaiting: true };
    this.stopWaiting = this.services.later(() => this.rest(), REST_MS);
  }

  /** Another one. False where the first one is not of this view, or nothing any more. */
  join(id: number, at: Point2): boolean {
    const { first } = this;
    if (!first) return false;
    this.touching.add(id);
    if (this.second || gap(first.at, first.start) > PAIR_PIXELS) return true;
    this.stopWaiting();
    first.gesture?.cancel?.();
    Object.assign(first, { gesture: null, isWaiting: false });
    this.second = { id, at, gesture: this.services.pair(first.at, at) };
    return true;
  }

  move(id: number, places: readonly Point2[]): void {
    const { first, second } = this;
    const last = places.at(-1);
    if (!first || !last) return;
    if (id === first.id) first.at = last;
    if (id === second?.id) second.at = last;
    if (second) return second.gesture.move(first.at, second.at);
    if (id === first.id) this.moveFirst(first, places);
  }

  private moveFirst(first: First, places: readonly Point2[]): void {
    if (first.isWaiting) {
      first.way.push(...places);
      if (gap(first.at, first.start) > TREMBLE_PIXELS) this.press(first, first.way);
      return;
    }
    const { gesture } = first;
    if (gesture) for (const place of gesture.isStroke ? places : places.slice(-1)) gesture.move(place);
  }

  /** Whether that was the last one. */
  lift(id: number, at: Point2): boolean {
    this.touching.delete(id);
    const { first, second } = this;
    if (first && (id === first.id || id === second?.id)) {
      this.first = this.second = null; // the finger that stays does nothing more
      this.stopWaiting();
      if (first.isWaiting) this.press(first, []); // a tap
      first.gesture?.end(gap(at, first.start) > TREMBLE_PIXELS ? at : first.start);
    }
    return this.touching.size === 0;
  }

  /** The system has taken it: all that they do is given up. Whether that was the last one. */
  drop(id: number): boolean {
    this.touching.delete(id);
    this.cancel();
    return this.touching.size === 0;
  }

  /** Gives up what they do; false where that is nothing. */
  cancel(): boolean {
    const { first } = this;
    this.first = this.second = null;
    this.stopWaiting();
    first?.gesture?.cancel?.();
    return first !== null;
  }

  private press(first: First, way: readonly Point2[]): void {
    this.stopWaiting();
    first.isWaiting = false;
    first.gesture = this.services.press(first.start);
    this.moveFirst(first, way);
  }

  private rest(): void {
    const { first } = this;
    if (!first?.isWaiting) return;
    first.isWaiting = false;
    first.gesture = this.services.rest(first.at);
  }
}
