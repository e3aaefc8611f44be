// SPDX-License-Identifier: Apache-2.0

const MOST_BYTES = 64 << 20; // of one view: 60 slices of a megapixel

interface Kept<Reply> {
  reply: Reply;
  bytes: number;
}

/** Slices of an image's frames, so that they can be played: by what their pixels depend on. The ones used last stay. */
export class SliceFrames<Reply> {
  private readonly kept = new Map<string, Kept<Reply>>(); // the ones used last behind
  private bytes = 0;

  get(key: string): Reply | null {
    const found = this.kept.get(key);
    if (!found) return null;
    this.kept.delete(key);
    this.kept.set(key, found);
    return found.reply;
  }

  keep(key: string, reply: Reply, bytes: number): void {
    this.forget(key);
    this.kept.set(key, { reply, bytes });
    this.bytes += bytes;
    for (const oldest of this.kept.keys()) {
      if (this.bytes <= MOST_BYTES) return;
      this.forget(oldest);
    }
  }

  clear(): void {
    this.kept.clear();
    this.bytes = 0;
  }

  private forget(key: string): void {
    this.bytes -= this.kept.get(key)?.bytes ?? 0;
    this.kept.delete(key);
  }
}
