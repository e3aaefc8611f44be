// SPDX-License-Identifier: Apache-2.0

/**
 * Carries out one request at a time. Of those that come meanwhile only one waits: `merge` makes it from the one that waits
 * already and the new one (by default the new one alone).
 */
export class Latest<Request> {
  private waiting: { request: Request } | null = null;
  private running: Promise<void> | null = null;

  constructor(
    private readonly carryOut: (request: Request) => Promise<unknown>,
    private readonly merge: (old: Request, next: Request) => Request = (_, next) => next,
  ) {}

  get busy(): boolean {
    return this.running !== null;
  }

  send(request: Request): void {
    this.waiting = { request: this.waiting ? this.merge(this.waiting.request, request) : request };
    this.running ??= this.run();
  }

  /** Whether another request follows the one that runs. */
  get hasNext(): boolean {
    return this.waiting !== null;
  }

  /** Forgets the one that waits; the one that runs goes on. */
  drop(): void {
    this.waiting = null;
  }

  /** Settles when nothing runs and nothing waits. */
  async idle(): Promise<void> {
    while (this.running) await this.running;
  }

  private async run(): Promise<void> {
    while (this.waiting) {
      const { request } = this.waiting;
      this.waiting = null;
      try {
        await this.carryOut(request);
      } catch {
        // whoever carries it out reports failures; the next request must run all the same
      }
    }
    this.running = null;
  }
}
