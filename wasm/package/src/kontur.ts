// SPDX-License-Identifier: Apache-2.0
import { SAMPLES, type SampleType, typed } from "./samples.js";
import {
  type Contours,
  type ErrorKind,
  type Filled,
  type FillRequest,
  type Grid,
  KonturError,
  type Mesh,
  type Plane,
  type Polyline,
  type Progress,
  type Request,
} from "./types.js";
import { wasi } from "./wasi.js";

interface Exports {
  memory: WebAssembly.Memory;
  _initialize(): void;
  kontur_allocate(bytes: number): number;
  kontur_release(place: number): void;
  kontur_error(): number;
  kontur_segment(request: number, length: number, samples: number, type: number, typeLength: number): number;
  kontur_new_editor(): number;
  kontur_drop_editor(editor: number): void;
  kontur_preview(editor: number, contours: number, length: number): number;
  kontur_finish(editor: number, contours: number, length: number): number;
  kontur_fill(request: number, length: number, labels: number, image: number): number;
  kontur_phantom(name: number, length: number): number;
  kontur_phantom_truth(name: number, length: number, grid: number, gridLength: number): number;
  kontur_phantom_image(grid: number, length: number): number;
  kontur_drop(made: number): void;
  kontur_array(made: number, which: number, answer: number): void;
  kontur_values(made: number, points: number, count: number, values: number): number;
  kontur_mesh(points: number, pointCount: number, triangles: number, triangleCount: number): number;
  kontur_outline(made: number, plane: number, length: number): number;
}

const enum Part {
  about = 0,
  voxels = 1,
  points = 2,
  normals = 3,
  triangles = 4,
}

/** A surface: its mesh, and the function of which it is the zeros. `free` gives its memory back. */
export class Surface {
  constructor(
    protected readonly kontur: Kontur,
    readonly address: number,
  ) {}

  get mesh(): Mesh {
    const floats = (which: number) => new Float32Array(this.kontur.bytes(this.address, which).buffer);
    const triangles = new Uint32Array(this.kontur.bytes(this.address, Part.triangles).buffer);
    return { points: floats(Part.points), normals: floats(Part.normals), triangles };
  }

  /** f at points of three numbers each, mm (LPS): above 0 inside, about mm near the surface. */
  values(points: Float64Array): Float64Array {
    return this.kontur.values(this.address, points);
  }

  /** Where a plane cuts the mesh. */
  outline(plane: Plane): Polyline[] {
    return this.kontur.outline(this.address, plane);
  }

  free(): void {
    this.kontur.drop(this.address);
  }
}

/** A mask on a grid, and the surface that it was made from. */
export class Segmentation extends Surface {
  /** 1 inside, 0 outside, i fastest. */
  readonly mask: Uint8Array;
  readonly grid: Grid;
  /** As `kontur segment --report` writes it. */
  readonly report: Record<string, unknown>;

  constructor(kontur: Kontur, address: number) {
    super(kontur, address);
    const about = kontur.about(address) as { grid: Grid; report: Record<string, unknown> };
    this.grid = about.grid;
    this.report = about.report;
    this.mask = kontur.bytes(address, Part.voxels);
  }
}

/** Follows contours while they are edited: a preview after each change, the finished surface when there is time. */
export class Editor {
  constructor(
    private readonly kontur: Kontur,
    private readonly address: number,
  ) {}

  preview(contours: Contours): Surface {
    return this.kontur.edited("kontur_preview", this.address, contours);
  }

  finish(contours: Contours): Surface {
    return this.kontur.edited("kontur_finish", this.address, contours);
  }

  free(): void {
    this.kontur.dropEditor(this.address);
  }
}

/** kontur in this thread. A call returns when it is done: see `KonturWorker` for one that does not hold the page up. */
export class Kontur {
  /** Told how far a call is; the call is cancelled where it returns false. */
  progress: Progress | undefined;
  private exports!: Exports;

  private constructor() {}

  /** `module` is kontur.wasm: compiled, its bytes, or what fetch gives. */
  static async load(module: WebAssembly.Module | BufferSource | Response | Promise<Response>): Promise<Kontur> {
    const kontur = new Kontur();
    const compiled = await compile(module);
    const imports = {
      wasi_snapshot_preview1: wasi(() => kontur.exports.memory),
      kontur: { progress: (stage: number, length: number, fraction: number) => kontur.told(stage, length, fraction) },
    };
    kontur.exports = (await WebAssembly.instantiate(compiled, imports)).exports as unknown as Exports;
    kontur.exports._initialize();
    return kontur;
  }

  /** Contours to mask and surface. */
  segment(request: Request): Segmentation {
    const { image, ...rest } = request;
    const type = image ? typed(image, request.grid, "the image") : "";
    return this.withBytes(image ?? new Uint8Array(), (samples) =>
      this.withText(type, (name, nameLength) =>
        this.withText(JSON.stringify(rest), (text, length) => {
          const made = this.exports.kontur_segment(text, length, image ? samples : 0, name, nameLength);
          return new Segmentation(this, this.made(made));
        }),
      ),
    );
  }

  /** Painted slices to whole labels. */
  fill({ labels, image, grid, options }: FillRequest): Filled {
    const imageType = image && typed(image, grid, "the image");
    const request = JSON.stringify({ grid, options, imageType, labelsType: typed(labels, grid, "the label map") });
    const made = this.withBytes(image ?? new Uint8Array(), (imagePlace) =>
      this.withBytes(labels, (labelsPlace) =>
        this.withText(request, (text, length) => this.made(this.exports.kontur_fill(text, length, labelsPlace, image ? imagePlace : 0))),
      ),
    );
    const { type, report } = this.about(made) as { type: SampleType; report: Filled["report"] };
    return { labels: new SAMPLES[type](this.voxels(made)), report };
  }

  /** Where each plane cuts a mesh, anyone's. */
  outlines({ points, triangles }: Pick<Mesh, "points" | "triangles">, planes: Plane[]): Polyline[][] {
    const made = this.withBytes(points, (place) =>
      this.withBytes(triangles, (corners) => this.made(this.exports.kontur_mesh(place, points.length / 3, corners, triangles.length / 3))),
    );
    try {
      return planes.map((plane) => this.outline(made, plane));
    } finally {
      this.drop(made);
    }
  }

  editor(): Editor {
    return new Editor(this, this.made(this.exports.kontur_new_editor()));
  }

  /** Contours and grid of a case of the phantom that kontur generates, such as "liver_parallel14". */
  phantom(name: string): { contours: Contours; grid: Grid } {
    return this.answer(this.withText(name, (text, length) => this.exports.kontur_phantom(text, length))) as { contours: Contours; grid: Grid };
  }

  /** 1 in the body of a case of the phantom, 0 elsewhere. */
  phantomTruth(name: string, grid: Grid): Uint8Array {
    return new Uint8Array(
      this.voxels(
        this.withText(name, (text, length) =>
          this.withText(JSON.stringify(grid), (gridText, gridLength) => this.made(this.exports.kontur_phantom_truth(text, length, gridText, gridLength))),
        ),
      ),
    );
  }

  /** The phantom's CT on a grid, in Hounsfield units. */
  phantomImage(grid: Grid): Int16Array {
    return new Int16Array(this.voxels(this.withText(JSON.stringify(grid), (text, length) => this.made(this.exports.kontur_phantom_image(text, length)))));
  }

  /** Of the module's memory, which grows and never shrinks. */
  get memoryBytes(): number {
    return this.exports.memory.buffer.byteLength;
  }

  /** @internal */
  edited(call: "kontur_preview" | "kontur_finish", editor: number, contours: Contours): Surface {
    return new Surface(this, this.made(this.withText(JSON.stringify(contours), (text, length) => this.exports[call](editor, text, length))));
  }

  /** @internal */
  values(made: number, points: Float64Array): Float64Array {
    const count = points.length / 3;
    if (!Number.isInteger(count)) throw new KonturError("invalid_input", `there are ${points.length} coordinates; three make a point`);
    return this.withBytes(points, (places) =>
      this.withBytes(new Float64Array(count), (values) => {
        this.made(this.exports.kontur_values(made, places, count, values));
        return new Float64Array(this.exports.memory.buffer, values, count).slice();
      }),
    );
  }

  /** @internal */
  outline(made: number, plane: Plane): Polyline[] {
    return this.answer(this.withText(JSON.stringify(plane), (text, length) => this.exports.kontur_outline(made, text, length))) as Polyline[];
  }

  /** @internal A copy of one of the arrays that a call made. */
  bytes(made: number, which: number): Uint8Array {
    const PAIR_BYTES = 8;
    return this.withBytes(new Uint8Array(PAIR_BYTES), (pair) => {
      this.exports.kontur_array(made, which, pair);
      const [place, bytes] = new Uint32Array(this.exports.memory.buffer, pair, 2);
      return new Uint8Array(this.exports.memory.buffer, place, bytes).slice();
    });
  }

  /** @internal */
  about(made: number): unknown {
    return JSON.parse(new TextDecoder().decode(this.bytes(made, Part.about)));
  }

  /** @internal */
  drop(made: number): void {
    this.exports.kontur_drop(made);
  }

  /** @internal */
  dropEditor(editor: number): void {
    this.exports.kontur_drop_editor(editor);
  }

  private voxels(made: number): ArrayBuffer {
    const { buffer } = this.bytes(made, Part.voxels);
    this.drop(made);
    return buffer as ArrayBuffer;
  }

  private answer(made: number): unknown {
    const answer = this.about(this.made(made));
    this.drop(made);
    return answer;
  }

  private made(address: number): number {
    if (address !== 0) return address;
    const bytes = new Uint8Array(this.exports.memory.buffer, this.exports.kontur_error());
    const text = new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
    const { kind, message } = JSON.parse(text) as { kind: ErrorKind; message: string };
    throw new KonturError(kind, message);
  }

  private told(stage: number, length: number, fraction: number): number {
    if (!this.progress) return 0;
    const name = new TextDecoder().decode(new Uint8Array(this.exports.memory.buffer, stage, length).slice());
    return this.progress(name, fraction) === false ? 1 : 0;
  }

  private withText<T>(text: string, use: (place: number, bytes: number) => T): T {
    const bytes = new TextEncoder().encode(text);
    return this.withBytes(bytes, (place) => use(place, bytes.length));
  }

  private withBytes<T>(data: ArrayBufferView, use: (place: number) => T): T {
    const place = this.exports.kontur_allocate(Math.max(1, data.byteLength));
    if (place === 0) throw new KonturError("too_large", `there is no room for ${data.byteLength} bytes in the 4 GB that WebAssembly can address`);
    try {
      new Uint8Array(this.exports.memory.buffer).set(new Uint8Array(data.buffer, data.byteOffset, data.byteLength), place);
      return use(place);
    } finally {
      this.exports.kontur_release(place);
    }
  }
}

async function compile(module: WebAssembly.Module | BufferSource | Response | Promise<Response>): Promise<WebAssembly.Module> {
  if (module instanceof WebAssembly.Module) return module;
  if (module instanceof ArrayBuffer || ArrayBuffer.isView(module)) return WebAssembly.compile(module);
  return WebAssembly.compile(await (await module).arrayBuffer());
}
