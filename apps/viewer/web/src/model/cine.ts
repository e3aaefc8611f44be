// SPDX-License-Identifier: Apache-2.0
import { Emitter } from "./emitter";
import type { Navigation } from "./navigation";

const LEAST_MS = 60; // for one frame

/** Shows the image's volumes one after the other, as fast as they come, but no faster than the eye wants. */
export class Cine extends Emitter<"playing"> {
  isPlaying = false;

  constructor(
    private readonly navigation: Navigation,
    /** Settles when what is seen of this time is there. */
    private readonly shown: () => Promise<unknown>,
    private readonly rest: (ms: number) => Promise<unknown> = (ms) => new Promise((resolve) => void setTimeout(resolve, ms)),
  ) {
    super();
  }

  /** False where there is one volume alone. */
  toggle(): boolean {
    if (this.navigation.times < 2) return false;
    this.isPlaying = !this.isPlaying;
    this.emit("playing");
    if (this.isPlaying) void this.play();
    return true;
  }

  step(steps: number): boolean {
    this.pause();
    this.navigation.setTime(this.navigation.time + steps);
    return this.navigation.times > 1;
  }

  pause(): void {
    if (this.isPlaying) this.toggle();
  }

  private async play(): Promise<void> {
    while (this.isPlaying) {
      this.navigation.setTime(this.navigation.time + 1);
      await Promise.all([this.shown(), this.rest(LEAST_MS)]);
    }
  }
}
