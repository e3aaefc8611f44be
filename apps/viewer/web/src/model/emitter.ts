// SPDX-License-Identifier: Apache-2.0

/** Tells listeners which topic changed; they look up the rest themselves. */
export class Emitter<Topic extends string> {
  private readonly listeners: { topics: readonly Topic[]; listener: () => void }[] = [];

  /** Returns what ends it. */
  on(topics: readonly Topic[], listener: () => void): () => void {
    const entry = { topics, listener };
    this.listeners.push(entry);
    return () => void this.listeners.splice(this.listeners.indexOf(entry), 1);
  }

  protected emit(...topics: Topic[]): void {
    for (const entry of this.listeners) if (entry.topics.some((topic) => topics.includes(topic))) entry.listener();
  }
}
