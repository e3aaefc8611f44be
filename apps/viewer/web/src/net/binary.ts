// SPDX-License-Identifier: Apache-2.0

const TYPES = { u8: Uint8Array, u16: Uint16Array, u32: Uint32Array, f32: Float32Array } as const;

interface ArrayEntry {
  type: keyof typeof TYPES;
  offset: number; // bytes from the end of the JSON
  count: number;
}

/** A reply of the form: uint32 N, N bytes of JSON, arrays. The arrays are views on the buffer. */
export class BinaryReply<Header> {
  readonly header: Header;
  private readonly start: number;
  private readonly entries: Record<string, ArrayEntry>;

  constructor(private readonly buffer: ArrayBuffer) {
    const size = new DataView(buffer).getUint32(0, true);
    this.start = 4 + size;
    const text = new TextDecoder().decode(new Uint8Array(buffer, 4, size));
    const { arrays, ...header } = JSON.parse(text) as { arrays?: Record<string, ArrayEntry> };
    this.header = header as Header;
    this.entries = arrays ?? {};
  }

  get bytes(): number {
    return this.buffer.byteLength;
  }

  has(name: string): boolean {
    return name in this.entries;
  }

  u8(name: string): Uint8Array {
    return this.array(name, "u8") as Uint8Array;
  }

  u16(name: string): Uint16Array {
    return this.array(name, "u16") as Uint16Array;
  }

  u32(name: string): Uint32Array {
    return this.array(name, "u32") as Uint32Array;
  }

  f32(name: string): Float32Array {
    return this.array(name, "f32") as Float32Array;
  }

  private array(name: string, type: keyof typeof TYPES): Uint8Array | Uint16Array | Uint32Array | Float32Array {
    const entry = this.entries[name];
    if (!entry) return new TYPES[type](0);
    if (entry.type !== type) throw new Error(`the server's array "${name}" holds ${entry.type}, not ${type}`);
    return new TYPES[type](this.buffer, this.start + entry.offset, entry.count);
  }
}
