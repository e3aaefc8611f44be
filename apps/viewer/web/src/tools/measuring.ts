// SPDX-License-Identifier: Apache-2.0
import { coincide } from "../geometry/plane";
import { gap, planeOf, toScreen, toWorld, type Point2, type Screen } from "../geometry/screen";
import { Measurements, type Measurement } from "../model/measurements";
import { CLICK_PIXELS, type Gesture } from "./gesture";
import type { Place } from "./place";

const POINT_PIXELS = 8;

/** A drag measures a distance, three clicks an angle; ends can be dragged to where they belong. */
export class Measuring {
  readonly measurements = new Measurements();
  /** The angle that is being clicked, or the distance under the hand; its last point follows the pointer. */
  begun: Measurement | null = null;
  private clicks = 0;

  press({ screen, step_mm, pointer }: Place): Gesture {
    const grabbed = this.pointAt(screen, step_mm, pointer);
    if (grabbed && !this.begun) return this.drag(screen, grabbed);
    const at = toWorld(screen, pointer);
    if (this.begun && !coincide(this.begun.plane, planeOf(screen), step_mm / 2)) this.leave();
    const isFirst = this.begun === null;
    this.begun ??= { plane: planeOf(screen), points: [at, at] };
    let isDrag = false;
    return {
      move: (to) => {
        isDrag ||= gap(to, pointer) > CLICK_PIXELS;
        if (isDrag) this.follow(screen, to);
      },
      end: (to) => {
        if (isFirst && isDrag) this.finish(screen, to);
        else this.click(screen, to);
      },
      cancel: () => void this.leave(),
    };
  }

  /** The pointer moves, and no button is held. */
  follow(screen: Screen, pointer: Point2): void {
    if (this.begun) this.begun.points[this.begun.points.length - 1] = toWorld(screen, pointer);
  }

  /** False where nothing was begun. */
  leave(): boolean {
    const was = this.begun !== null;
    this.begun = null;
    this.clicks = 0;
    return was;
  }

  pointAt(screen: Screen, step_mm: number, pointer: Point2): { measurement: Measurement; index: number } | null {
    for (const measurement of this.measurements.lyingIn(planeOf(screen), step_mm)) {
      const index = measurement.points.findIndex((p) => gap(toScreen(screen, p), pointer) < POINT_PIXELS * (screen.reach ?? 1));
      if (index >= 0) return { measurement, index };
    }
    return null;
  }

  private drag(screen: Screen, { measurement, index }: { measurement: Measurement; index: number }): Gesture {
    const before = measurement.points[index]!;
    this.measurements.movePoint(measurement, index, before);
    return {
      move: (to) => this.measurements.movePoint(measurement, index, toWorld(screen, to)),
      end: () => undefined,
      cancel: () => this.measurements.movePoint(measurement, index, before),
    };
  }

  private click(screen: Screen, at: Point2): void {
    const begun = this.begun;
    if (!begun) return;
    this.follow(screen, at);
    if (++this.clicks === 3) return this.finish(screen, at);
    if (this.clicks === 2) begun.points.push(toWorld(screen, at));
  }

  private finish(screen: Screen, at: Point2): void {
    this.follow(screen, at);
    const finished = this.begun!;
    this.leave();
    this.measurements.add(finished);
  }
}
