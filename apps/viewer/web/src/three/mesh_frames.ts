// SPDX-License-Identifier: Apache-2.0
import type { MeshData } from "./scene";

const MOST_BYTES = 256 << 20;

interface Kept {
  revision: number;
  mesh: MeshData;
}

/** Surfaces of structures that move, by time, so that they can be played. The ones used last stay. */
export class MeshFrames {
  private readonly kept = new Map<string, Kept>(); // the ones used last behind

  get(structure: number, time: number, revision: number): MeshData | null {
    const key = keyOf(structure, time);
    const found = this.kept.get(key);
    if (found?.revision !== revision) return null;
    this.kept.delete(key);
    this.kept.set(key, found);
    return found.mesh;
  }

  has(structure: number, time: number, revision: number): boolean {
    return this.kept.get(keyOf(structure, time))?.revision === revision;
  }

  keep(structure: number, time: number, revision: number, mesh: MeshData): void {
    this.kept.delete(keyOf(structure, time));
    this.kept.set(keyOf(structure, time), { revision, mesh });
    for (const key of this.kept.keys()) {
      if (this.bytes <= MOST_BYTES) return;
      this.kept.delete(key);
    }
  }

  /** Whether there is room for another one like those that are kept. */
  get hasRoom(): boolean {
    return this.bytes < 0.9 * MOST_BYTES;
  }

  get size(): number {
    return this.kept.size;
  }

  clear(): void {
    this.kept.clear();
  }

  private get bytes(): number {
    return [...this.kept.values()].reduce((sum, { mesh }) => sum + mesh.positions.byteLength + mesh.normals.byteLength + mesh.triangles.byteLength, 0);
  }
}

const keyOf = (structure: number, time: number): string => `${structure}:${time}`;
