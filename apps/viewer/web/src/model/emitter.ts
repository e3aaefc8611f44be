// SPDX-License-Identifier: Apache-2.0

/** Tells listeners which topic changed; they look up the rest themselves. */
export class Emitter<Topic extends string> {
  private readonly listeners: { topics: readonly Topic[]; listener: () => void }[] = [];

  on(topics: readonly Topic[], listener: () => void): void {
    this.listeners.push({ topics, listener });
  }

  protected emit(...topics: Topic[]): void {
    for (const entry of this.listeners) if (entry.topics.some((topic) => topics.includes(topic))) entry.listener();
  }
}
