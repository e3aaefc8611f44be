// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { coarseTriangles } from "../../src/three/coarse";
import { isSoftwareRenderer, Pace } from "../../src/three/pace";

const settled = () => new Promise((resolve) => setImmediate(resolve));

/** A clock, a renderer that takes a given time, and timers, all moved by hand. */
class Bench {
  readonly frames: ("fine" | "rough")[] = [];
  isHeld = false;
  private ms = 0;
  private timers: { at: number; act: () => void }[] = [];
  private finishFrame: (() => void) | null = null;
  readonly pace = new Pace({
    frame: () => Promise.resolve(),
    render: (fine) => {
      this.frames.push(fine ? "fine" : "rough");
      return new Promise((resolve) => (this.finishFrame = () => resolve(true)));
    },
    isHeld: () => this.isHeld,
    later: (act, ms) => void this.timers.push({ at: this.ms + ms, act }),
    now: () => this.ms,
  });

  async finish(took_ms: number): Promise<void> {
    await this.pass(took_ms);
    this.finishFrame!();
    await settled();
  }

  async pass(ms: number): Promise<void> {
    for (const end = this.ms + ms; this.ms < end;) {
      ++this.ms;
      const due = this.timers.filter(({ at }) => at <= this.ms);
      this.timers = this.timers.filter(({ at }) => at > this.ms);
      due.forEach(({ act }) => act());
    }
    await settled();
  }
}

/** One that has drawn a fine frame in this time. */
async function after(took_ms: number): Promise<Bench> {
  const bench = new Bench();
  bench.pace.changed();
  await settled();
  await bench.finish(took_ms);
  bench.frames.length = 0;
  return bench;
}

test("where frames are cheap all are fine, and one is in flight at a time", async () => {
  const bench = await after(5);
  for (let i = 0; i < 10; ++i) bench.pace.changed(i % 2 === 0);
  await settled();
  assert.deepEqual(bench.frames, ["fine"], "all that changes before a frame begins is in it");
  bench.pace.changed(true);
  await bench.finish(5);
  assert.deepEqual(bench.frames, ["fine", "fine"]);
  await bench.finish(5);
  await bench.pass(1000);
  assert.deepEqual(bench.frames, ["fine", "fine"]);
});

test("where they are dear, changes that can wait are drawn once, when all rests", async () => {
  const bench = await after(300);
  for (let i = 0; i < 20; ++i) {
    bench.pace.changed(true);
    await bench.pass(100);
  }
  assert.deepEqual(bench.frames, []);
  await bench.pass(600);
  assert.deepEqual(bench.frames, ["fine"]);
});

test("where they are dear, what cannot wait is rough first, and fine after the hand has let go", async () => {
  const bench = await after(300);
  bench.isHeld = true;
  for (let i = 0; i < 3; ++i) {
    bench.pace.changed();
    await settled();
    await bench.finish(40);
  }
  await bench.pass(2000);
  assert.deepEqual(bench.frames, ["rough", "rough", "rough"]);
  bench.isHeld = false;
  for (let waited = 0; bench.frames.length < 4 && waited < 600; waited += 10) await bench.pass(10);
  assert.deepEqual(bench.frames, ["rough", "rough", "rough", "fine"]);
  await bench.finish(10);
  assert.equal(bench.pace.isSlow, false, "the first frame compiles shaders: later ones may be cheap");
});

test("where they take seconds, they take a small part of the time", async () => {
  const bench = await after(300);
  for (let i = 0; i < 2; ++i) {
    bench.pace.changed(true);
    for (let waited = 0; bench.frames.length <= i && waited < 2000; waited += 50) await bench.pass(50);
    assert.equal(bench.frames.length, i + 1, "after one such frame, which may have compiled shaders, all goes on as before");
    await bench.finish(2000);
  }
  bench.pace.changed();
  await settled();
  await bench.finish(40);
  for (let waited = 0; waited < 30_000; waited += 500) await bench.pass(500);
  assert.deepEqual(bench.frames, ["fine", "fine", "rough"]);
  for (let waited = 0; bench.frames.length < 4 && waited < 15_000; waited += 500) await bench.pass(500);
  assert.deepEqual(bench.frames, ["fine", "fine", "rough", "fine"]);
});

/** A ball of `rings` times twice as many points. */
function ball(rings: number): { positions: Float32Array; triangles: Uint32Array } {
  const positions: number[] = [];
  const triangles: number[] = [];
  const around = 2 * rings;
  for (let i = 0; i <= rings; ++i)
    for (let j = 0; j < around; ++j) {
      const [a, b] = [(Math.PI * i) / rings, (Math.PI * j) / rings];
      positions.push(100 * Math.sin(a) * Math.cos(b), 100 * Math.sin(a) * Math.sin(b), 100 * Math.cos(a));
    }
  for (let i = 0; i < rings; ++i)
    for (let j = 0; j < around; ++j) {
      const [a, b] = [i * around + j, i * around + ((j + 1) % around)];
      triangles.push(a, b, a + around, b, b + around, a + around);
    }
  return { positions: Float32Array.from(positions), triangles: Uint32Array.from(triangles) };
}

function volume(positions: Float32Array, triangles: Uint32Array): number {
  let six = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((i) => positions.subarray(3 * triangles[t + i]!, 3 * triangles[t + i]! + 3)) as [Float32Array, Float32Array, Float32Array];
    six += a[0]! * (b[1]! * c[2]! - b[2]! * c[1]!) + a[1]! * (b[2]! * c[0]! - b[0]! * c[2]!) + a[2]! * (b[0]! * c[1]! - b[1]! * c[0]!);
  }
  return six / 6;
}

test("a rough surface has a fraction of the triangles, and the shape stays", () => {
  const { positions, triangles } = ball(300);
  const rough = coarseTriangles(positions, triangles);
  assert.ok(rough.length < 0.35 * triangles.length, `${rough.length / 3} of ${triangles.length / 3} triangles`);
  assert.ok(Math.abs(volume(positions, rough) / volume(positions, triangles) - 1) < 0.02);
  assert.ok(rough.every((point) => point < positions.length / 3));
});

test("a surface without extent has no triangles left", () => {
  assert.equal(coarseTriangles(new Float32Array(9), Uint32Array.of(0, 1, 2)).length, 0);
  assert.equal(coarseTriangles(new Float32Array(0), new Uint32Array(0)).length, 0);
});

test("a renderer without a graphics processor is known by its name", () => {
  const software = [
    "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device (Subzero) (0x0000C0DE)), SwiftShader driver)",
    "llvmpipe (LLVM 15.0.6, 256 bits)",
    "ANGLE (Microsoft, Microsoft Basic Render Driver Direct3D11)",
    "Apple Software Renderer",
  ];
  const hardware = ["ANGLE (Intel, Mesa Intel(R) UHD Graphics 620 (KBL GT2), OpenGL 4.6)", "Apple M2", "Mali-G78", "WebKit WebGL"];
  assert.deepEqual(
    software.map(isSoftwareRenderer),
    software.map(() => true),
  );
  assert.deepEqual(
    hardware.map(isSoftwareRenderer),
    hardware.map(() => false),
  );
});
