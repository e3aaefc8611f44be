// SPDX-License-Identifier: Apache-2.0
import { gap, toWorld, type Point2, type Screen } from "../geometry/screen";
import { sub } from "../geometry/vec";
import type { Navigation } from "../model/navigation";
import type { ViewName } from "../net/protocol";
import type { PairGesture } from "./fingers";

const DECIDE_PIXELS = 10; // of the fingers' way, before it is clear what they want
const PIXELS_PER_SLICE: readonly [number, number] = [4, 24];

/**
 * Two fingers up or down scroll through the slices, all of them along the height of the view. Fingers that move apart,
 * together or to a side hold the image: it goes with them, and grows by as much as they part. What they begin with lasts
 * until one is lifted, so that no slice jumps in the middle of a pinch.
 */
export function fingerPair(view: ViewName, navigation: Navigation, screenOf: () => Screen | null, a: Point2, b: Point2): PairGesture {
  const start = middle(a, b);
  const apart = Math.max(gap(a, b), 1);
  let wish: "scroll" | "hold" | null = null;
  let last = { at: start, apart };
  const decide = (at: Point2, spread: number): typeof wish => {
    const right = Math.abs(at[0] - start[0]);
    const down = Math.abs(at[1] - start[1]);
    const parted = Math.abs(spread - apart);
    if (Math.max(right, down, parted) < DECIDE_PIXELS) return null;
    return down > right && down > parted ? "scroll" : "hold";
  };
  let scrolledFrom = start[1];
  const scroll = (screen: Screen, y: number): void => {
    const step = Math.min(Math.max(screen.height / navigation.slice(view).count, PIXELS_PER_SLICE[0]), PIXELS_PER_SLICE[1]);
    const slices = Math.trunc((y - scrolledFrom) / step);
    if (slices === 0) return;
    scrolledFrom += slices * step;
    navigation.scroll(view, slices);
  };
  const hold = (screen: Screen, at: Point2, spread: number): void => {
    const held = toWorld(screen, last.at);
    navigation.pan(view, sub(held, toWorld(screen, at)));
    navigation.zoomAt(view, held, spread / last.apart);
  };
  return {
    move: (p, q) => {
      const screen = screenOf();
      const at = middle(p, q);
      const spread = Math.max(gap(p, q), 1);
      wish ??= decide(at, spread);
      if (!screen || wish === null) return;
      if (wish === "scroll") return scroll(screen, at[1]);
      hold(screen, at, spread);
      last = { at, apart: spread };
    },
  };
}

const middle = (a: Point2, b: Point2): Point2 => [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
