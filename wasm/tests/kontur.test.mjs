// SPDX-License-Identifier: Apache-2.0
// kontur-wasm in Node, beside the native library: node --test. KONTUR_WASM is the built package, KONTUR_NATIVE a program that
// writes CASE.json and CASE.nii of cases of the phantom (tests/portable/program.cpp).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, test } from "node:test";
import { pathToFileURL } from "node:url";
import { Worker } from "node:worker_threads";
import { brotliCompressSync } from "node:zlib";

const PACKAGE = process.env.KONTUR_WASM;
const { Kontur, KonturError, KonturWorker } = await import(pathToFileURL(join(PACKAGE, "index.js")));
const bytes = readFileSync(join(PACKAGE, "kontur.wasm"));
const HEADER_BYTES = 352;
const CASES = ["liver_parallel14", "kidney_radial6"];

const folder = mkdtempSync(join(tmpdir(), "kontur-"));
let module;
let kontur;

before(async () => {
  execFileSync(process.env.KONTUR_NATIVE, [folder, ...CASES]);
  module = await WebAssembly.compile(bytes);
  kontur = await Kontur.load(module);
});
after(() => rmSync(folder, { recursive: true }));

const native = (name) => readFileSync(join(folder, `${name}.nii`)).subarray(HEADER_BYTES);
const contours = (name) => JSON.parse(readFileSync(join(folder, `${name}.json`), "utf8"));
const request = (name) => ({ contours: contours(name), grid: kontur.phantom(name).grid });

describe("masks", () => {
  for (const name of CASES)
    test(`${name} is the native library's but for voxels on the surface`, () => {
      const made = kontur.segment(request(name));
      const there = native(name);
      assert.equal(made.mask.length, there.length);
      const inside = there.reduce((sum, value) => sum + value, 0);
      let different = 0;
      for (let n = 0; n < there.length; n++) different += made.mask[n] === there[n] ? 0 : 1;
      console.log(`${name}: ${different} of ${inside} voxels differ`);
      assert.ok(inside > 1000 && different <= 1e-4 * inside, `${different} of ${inside}`);
      assert.equal(
        made.report.mask.voxels,
        made.mask.reduce((sum, value) => sum + value, 0),
      );
      made.free();
    });

  test("repeat themselves byte for byte", () => {
    const [one, other] = [1, 2].map(() => kontur.segment(request("kidney_radial6")));
    assert.deepEqual(one.mask, other.mask);
    assert.deepEqual(one.mesh, other.mesh);
  });
});

describe("label maps", () => {
  const grid = {
    size: [40, 36, 32],
    indexToMm: [
      [1, 0, 0, -20],
      [0, 1.2, 0, 7],
      [0, 0, 1.5, 3],
    ],
  };
  const inBall = (n, radius = 15) => {
    const [i, j, k] = [n % 40, Math.floor(n / 40) % 36, Math.floor(n / (40 * 36))];
    return Math.hypot(i - 20, 1.2 * (j - 18), 1.5 * (k - 16)) < radius;
  };
  const sparse = (Type, label = 1) => Type.from({ length: 40 * 36 * 32 }, (_, n) => (Math.floor(n / (40 * 36)) % 5 === 1 && inBall(n) ? label : 0));
  const counted = (labels, label) => labels.reduce((sum, value) => sum + (value === label ? 1 : 0), 0);

  test("of which every fifth slice is painted are filled, and what was painted stays", () => {
    const labels = sparse(Uint8Array);
    const filled = kontur.fill({ labels, grid });
    assert.ok(labels.every((label, n) => label === 0 || filled.labels[n] === label));
    const ball = Array.from(labels, (_, n) => (inBall(n) && n >= labels.indexOf(1) && n <= labels.lastIndexOf(1) ? 1 : 0));
    const dice = (2 * ball.reduce((sum, value, n) => sum + value * filled.labels[n], 0)) / (counted(ball, 1) + counted(filled.labels, 1));
    assert.ok(dice > 0.985, `${dice}`);
    const [one] = filled.report.labels;
    assert.equal(one.painted_voxels + one.added_voxels, counted(filled.labels, 1));
    assert.deepEqual([one.label, one.slices], [1, [0, 0, one.slices[2]]]);
  });

  test("of other types come back as those", () => {
    const one = kontur.fill({ labels: sparse(Uint8Array), grid });
    for (const Type of [Int16Array, Uint16Array, Int32Array, Float32Array]) {
      const { labels } = kontur.fill({ labels: sparse(Type, 3), grid });
      assert.equal(labels.constructor, Type);
      assert.equal(counted(labels, 3), counted(one.labels, 1));
    }
  });

  test("that cannot be filled are refused", () => {
    const refused = (request, words) =>
      assert.throws(() => kontur.fill({ labels: sparse(Uint8Array), grid, ...request }), { name: "KonturError", message: words });
    refused({ labels: new Uint8Array(5) }, /^the label map has 5 samples, and its grid 46080 voxels$/);
    refused({ labels: new Float64Array(40 * 36 * 32) }, /Float64Array/);
    refused({ image: new Int16Array(5) }, /^the image has 5 samples/);
    refused({ options: { ends: "round" } }, /ends is "round"; it takes closed, half, open/);
    refused({ options: { labels: [7] } }, /7/);
  });
});

test("the phantom tells its truth, and shows it in its CT", () => {
  const made = kontur.segment(request("kidney_radial6"));
  const truth = kontur.phantomTruth("kidney_radial6", made.grid);
  const both = truth.reduce((sum, value, n) => sum + value * made.mask[n], 0);
  const dice = (2 * both) / (truth.reduce((sum, value) => sum + value, 0) + made.report.mask.voxels);
  assert.ok(dice > 0.99, `${dice}`);
  const image = kontur.phantomImage(made.grid);
  const mean = (inside) =>
    image.reduce((sum, hu, n) => sum + (truth[n] === inside ? hu : 0), 0) / truth.reduce((sum, value) => sum + (value === inside ? 1 : 0), 0);
  assert.ok(image instanceof Int16Array && mean(1) > 150 && mean(0) < 100, `${mean(1)} HU inside, ${mean(0)} outside`);
  assert.throws(() => kontur.phantomTruth("kidney", made.grid), { name: "KonturError", kind: "invalid_input", message: /kidney_radial6/ });
  made.free();
});

test("a mesh of anyone's is cut by planes", () => {
  const points = Float32Array.from([0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2]);
  const triangles = Uint32Array.from([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]);
  const found = kontur.outlines(
    { points, triangles },
    [1, 3].map((z) => ({ origin: [0, 0, z], normal: [0, 0, 1] })),
  );
  assert.deepEqual(
    found.map((lines) => lines.length),
    [1, 0],
  );
  const [{ closed, points: corners }] = found[0];
  assert.ok(closed && corners.length === 9 && corners.every((value, n) => (n % 3 === 2 ? value === 1 : value === 0 || value === 1)), `${corners}`);
  assert.throws(() => kontur.outlines({ points, triangles: Uint32Array.from([0, 1, 9]) }, [{ origin: [0, 0, 1], normal: [0, 0, 1] }]), { name: "KonturError" });
});

test("the mesh, its outlines and the function agree", () => {
  const made = kontur.segment(request("kidney_radial6"));
  const { points, normals, triangles } = made.mesh;
  assert.ok(triangles.length > 1000 && points.length === normals.length && triangles.every((point) => point < points.length / 3));
  const values = made.values(Float64Array.from(points.subarray(0, 300)));
  assert.ok(
    values.every((value) => Math.abs(value) < 0.5),
    `${values}`,
  );
  const [x, y, z] = [0, 1, 2].map((axis) => points.filter((_, n) => n % 3 === axis).reduce((sum, v) => sum + v, 0) / (points.length / 3));
  const lines = made.outline({ origin: [x, y, z], normal: [0, 0, 1] });
  assert.ok(lines.length > 0 && lines.every((line) => line.closed && line.points.every((v, n) => n % 3 !== 2 || Math.abs(v - z) < 1e-3)));
});

test("an editor gives a preview, and finishes as the native library does", () => {
  const editor = kontur.editor();
  assert.ok(editor.preview(contours("kidney_radial6")).mesh.triangles.length > 300);
  const finished = editor.finish(contours("kidney_radial6"));
  const made = kontur.segment(request("kidney_radial6"));
  const places = Float64Array.from(made.mesh.points.subarray(0, 30));
  assert.deepEqual(finished.values(places), made.values(places));
  editor.free();
});

describe("what cannot be is refused in one sentence", () => {
  const refused = (asked, kind, words) =>
    assert.throws(
      () => kontur.segment(asked),
      (error) => error instanceof KonturError && error.kind === kind && words.test(error.message),
    );

  test("no contours", () => refused({}, "invalid_input", /^the request has no contours$/));
  test("a point that is none", () => {
    const broken = request("kidney_radial6");
    broken.contours.planes[0].contours[0].points[3] = [1, "two"];
    refused(broken, "corrupt_file", /plane 1.*contour 1.*point 4/);
  });
  test("an option that is none", () =>
    refused({ ...request("kidney_radial6"), options: { kernel: "cubic" } }, "invalid_input", /kernel is "cubic"; it takes screened, /));
  test("a grid that is none", () => refused({ ...request("kidney_radial6"), grid: { size: [0, 1, 1] } }, "invalid_input", /grid/));
  test("and the next call works", () => assert.ok(kontur.segment(request("kidney_radial6")).mask.includes(1)));
});

describe("in a worker", () => {
  const start = () => new Worker(new URL(pathToFileURL(join(PACKAGE, "worker.js"))));

  test("a call gives the same mask and tells how far it is", async () => {
    const worker = new KonturWorker(module, start);
    const stages = new Set();
    const made = await worker.segment(request("kidney_radial6"), (stage) => void stages.add(stage));
    assert.deepEqual(made.mask, kontur.segment(request("kidney_radial6")).mask);
    assert.ok(stages.size > 1);
    assert.ok((await worker.preview(contours("kidney_radial6"))).mesh.points.length > 0);
    await assert.rejects(worker.segment({}), { kind: "invalid_input" });
    const plane = { origin: [0, 0, 0], normal: [0, 0, 1] };
    assert.deepEqual(await worker.outlines(made.mesh, [plane]), kontur.outlines(made.mesh, [plane]));
    const painted = {
      labels: Uint8Array.from({ length: 1000 }, (_, n) => (n % 300 < 100 && n % 10 < 5 ? 1 : 0)),
      grid: {
        size: [10, 10, 10],
        indexToMm: [
          [1, 0, 0, 0],
          [0, 1, 0, 0],
          [0, 0, 1, 0],
        ],
      },
    };
    assert.deepEqual(await worker.fill(painted), kontur.fill(painted));
    worker.cancel();
  });

  test("a cancelled call ends at once, and the next one starts anew", async () => {
    const worker = new KonturWorker(module, start);
    const call = worker.segment(request("liver_parallel14"), () => worker.cancel());
    await assert.rejects(call, { kind: "cancelled" });
    assert.ok((await worker.segment(request("kidney_radial6"))).mask.includes(1));
    worker.cancel();
  });
});

test("it is small, and so is its memory", () => {
  const MB = 1e6;
  const packed = brotliCompressSync(bytes).length;
  console.log(`${(packed / MB).toFixed(2)} MB packed, ${(kontur.memoryBytes / MB).toFixed(0)} MB of memory`);
  assert.ok(packed <= 1.5 * MB && kontur.memoryBytes <= 200 * MB);
});
