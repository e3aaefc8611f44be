// SPDX-License-Identifier: Apache-2.0

/** Whether WebGL's renderer of this name computes its pictures without a graphics processor. */
export const isSoftwareRenderer = (name: string): boolean => /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);

export interface PaceServices {
  /** Settles when the browser wants the next frame. */
  frame(): Promise<void>;
  /** Draws; settles when the frame is finished, and says whether there was anything to draw on. */
  render(fine: boolean): Promise<boolean>;
  /** Whether a hand is at work: a fine frame then waits. */
  isHeld(): boolean;
  later(act: () => void, ms: number): void;
  now(): number;
}

const SLOW_MS = 25; // a fine frame that takes longer makes other work wait
const REST_MS = 250;
const VERY_SLOW_MS = 1000; // such a frame keeps the whole page waiting: it may take a twentieth of the time, and no more
const LONGEST_REST_MS = 60_000;

/**
 * Decides when the 3D view is drawn: when something has changed, one frame at a time. Where a fine frame takes long, as
 * without a graphics processor, it comes when all has been at rest for a while, and what cannot wait for it is drawn roughly.
 */
export class Pace {
  private waiting: "nothing" | "rest" | "frame" = "nothing";
  private isDrawing = false;
  private fineMs = 0;
  private fineBeforeMs = 0;
  private restsFrom = 0;
  private isTimed = false;

  constructor(private readonly services: PaceServices) {}

  get isSlow(): boolean {
    return this.fineMs > SLOW_MS;
  }

  /** How long all must be at rest before a fine frame is drawn. */
  private get restMs(): number {
    const usualMs = Math.min(this.fineMs, this.fineBeforeMs); // the first frame compiles shaders
    return usualMs > VERY_SLOW_MS ? Math.min(20 * usualMs, LONGEST_REST_MS) : REST_MS;
  }

  /** Something looks different; `canWait` where slices matter more to the user than this view. */
  changed(canWait = false): void {
    this.restsFrom = this.services.now() + this.restMs;
    if (!canWait || !this.isSlow) this.waiting = "frame";
    else if (this.waiting === "nothing") this.waiting = "rest";
    this.go();
  }

  private go(): void {
    if (this.isDrawing) return;
    if (this.waiting === "frame") void this.draw(!this.isSlow);
    else if (this.waiting === "rest") this.waitForRest();
  }

  private waitForRest(): void {
    if (this.isTimed) return;
    this.isTimed = true;
    this.services.later(() => {
      this.isTimed = false;
      if (this.isDrawing || this.waiting !== "rest") return;
      if (this.services.isHeld() || this.services.now() < this.restsFrom) return this.waitForRest();
      void this.draw(true);
    }, REST_MS);
  }

  private async draw(fine: boolean): Promise<void> {
    this.isDrawing = true;
    try {
      await this.services.frame();
      this.waiting = fine ? "nothing" : "rest";
      const start = this.services.now();
      const isDrawn = await this.services.render(fine);
      if (fine && isDrawn) [this.fineBeforeMs, this.fineMs] = [this.fineMs, this.services.now() - start];
    } finally {
      this.isDrawing = false;
    }
    this.go();
  }
}
