// SPDX-License-Identifier: Apache-2.0

const LEAST_BYTES = 32_000; // what is smaller tells of the way, not of its width
const SLOW_BYTES_PER_MS = 12_500; // 100 Mbit/s; the server compresses several times as fast, and to a third
const REMEMBERED = 5;

/** How fast bytes come from the server: over a tunnel, compressing them is worth its time. */
export class Link {
  private rates: number[] = []; // bytes per ms, of the last large replies

  /** A reply's bytes, as they came, took this long from the first to the last. */
  took(bytes: number, ms: number): void {
    if (bytes < LEAST_BYTES) return;
    this.rates = [...this.rates.slice(1 - REMEMBERED), bytes / Math.max(ms, 0.1)];
  }

  /** A page that is busy takes its replies late: only where none of several came fast the way is to blame. */
  get isSlow(): boolean {
    return this.rates.length === REMEMBERED && Math.max(...this.rates) < SLOW_BYTES_PER_MS;
  }
}
