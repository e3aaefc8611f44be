#!/usr/bin/env node
// SPDX-License-Identifier: Apache-2.0
// The same painted slices of the phantom, filled in WebAssembly by kontur, by ITK's morphological contour interpolation and by
// niivue, each in a process of its own; prints the table of the package's README.
//
// Usage: wasm/bench/fill.mjs PACKAGE PEERS KONTUR
//   PACKAGE  kontur-wasm as `make wasm` builds it
//   PEERS    a folder with: npm install --ignore-scripts @itk-wasm/morphological-contour-interpolation@2.0.0 @niivue/niivue@0.69.0
//   KONTUR   the native program, which compares with the truth
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { brotliCompressSync } from "node:zlib";

const CASES = { liver: { name: "liver_parallel14", painted: 14 }, metastasis: { name: "metastasis_parallel7", painted: 7 } };
const MB = 1e6;
const [PACKAGE, PEERS, KONTUR, ...CHILD] = process.argv.slice(2);
const peer = (path) => join(PEERS, "node_modules", path);
const ITK = peer("@itk-wasm/morphological-contour-interpolation/dist");

/** The body on its grid, and the same with the painted slices alone: from the first to the last occupied, evenly. */
async function drawn({ name, painted }) {
  const { Kontur } = await import(pathToFileURL(join(PACKAGE, "index.js")));
  const kontur = await Kontur.load(readFileSync(join(PACKAGE, "kontur.wasm")));
  const { grid } = kontur.phantom(name);
  const truth = kontur.phantomTruth(name, grid);
  const area = grid.size[0] * grid.size[1];
  const first = Math.floor(truth.indexOf(1) / area);
  const last = Math.floor(truth.lastIndexOf(1) / area);
  const kept = Array.from({ length: painted }, (_, n) => Math.round(first + ((last - first) * n) / (painted - 1)));
  const sparse = new Uint8Array(truth.length);
  for (const k of kept) sparse.set(truth.subarray(k * area, (k + 1) * area), k * area);
  return { kontur, grid, truth, kept, sparse };
}

async function itk({ grid, sparse }, options) {
  const { morphologicalContourInterpolationNode } = await import(pathToFileURL(join(ITK, "index-node.js")));
  const spacing = [0, 1, 2].map((axis) => Math.hypot(...grid.indexToMm.map((row) => row[axis])));
  const image = {
    imageType: { dimension: 3, componentType: "uint8", pixelType: "Scalar", components: 1 },
    name: "painted",
    origin: [0, 0, 0],
    spacing,
    direction: new Float64Array([1, 0, 0, 0, 1, 0, 0, 0, 1]),
    size: grid.size,
    metadata: new Map(),
    data: sparse,
  };
  return async () => (await morphologicalContourInterpolationNode({ ...image, data: sparse.slice() }, options)).outputImage.data;
}

const METHODS = {
  "kontur-wasm":
    async ({ grid, sparse, kontur }) =>
    () =>
      kontur.fill({ labels: sparse, grid }).labels,
  ITK: (given) => itk(given, {}),
  "ITK, dilations": (given) => itk(given, { noUseDistanceTransform: true }),
  niivue: async ({ grid, sparse, kept }) => {
    const { interpolateMaskSlices } = await import(pathToFileURL(peer("@niivue/niivue/build/drawing/index.js")));
    const [dimX, dimY, dimZ] = grid.size;
    return () => {
      const filled = sparse.slice();
      const options = { useIntensityGuided: false, sliceType: 0 };
      for (let n = 1; n < kept.length; n++) interpolateMaskSlices(filled, { dimX, dimY, dimZ }, undefined, 1, kept[n - 1], kept[n], options, () => undefined);
      return filled;
    };
  },
};

/** The memories of modules that are instantiated from now on. */
function watchedMemories() {
  const memories = new Set();
  const { instantiate } = WebAssembly;
  WebAssembly.instantiate = async (...given) => {
    const made = await instantiate.apply(WebAssembly, given);
    for (const one of [...Object.values((made.instance ?? made).exports), ...Object.values(given[1] ?? {}).flatMap(Object.values)])
      if (one instanceof WebAssembly.Memory) memories.add(one);
    return made;
  };
  return memories;
}

/** One method on one case, here: its mask as a file, the processor time of a second call, and the most memory of its modules. */
async function measure(organ, method, path) {
  const given = await drawn(CASES[organ]);
  const memories = watchedMemories();
  if (method === "kontur-wasm") {
    const { Kontur } = await import(pathToFileURL(join(PACKAGE, "index.js")));
    given.kontur = await Kontur.load(readFileSync(join(PACKAGE, "kontur.wasm")));
  }
  const fill = await METHODS[method](given);
  await fill();
  const start = process.cpuUsage();
  const mask = await fill();
  const { user, system } = process.cpuUsage(start);
  const seconds = (user + system) / 1e6;
  const memory = Math.max(0, ...[...memories].map(({ buffer }) => buffer.byteLength));
  write(
    path,
    Uint8Array.from(mask, (value) => (value ? 1 : 0)),
    given.grid,
  );
  console.log(JSON.stringify({ seconds, memory_mb: memory / MB }));
}

function write(path, mask, { size, indexToMm }) {
  const column = (axis) => `(${indexToMm.map((row) => row[axis]).join()})`;
  const lines = ["NRRD0004", "type: uint8", "dimension: 3", "space: left-posterior-superior", `sizes: ${size.join(" ")}`];
  lines.push(`space directions: ${[0, 1, 2].map(column).join(" ")}`, `space origin: ${column(3)}`, "encoding: raw", "", "");
  writeFileSync(path, Buffer.concat([Buffer.from(lines.join("\n")), mask]));
}

function megabytes(paths) {
  return paths.reduce((sum, path) => sum + brotliCompressSync(readFileSync(path)).length, 0) / MB;
}

function sizes() {
  const wasm = join(ITK, "pipelines/morphological-contour-interpolation.wasm.zst"); // compressed as it is sent
  const itk =
    readFileSync(wasm).length / MB +
    megabytes([join(ITK, "pipelines/morphological-contour-interpolation.js"), join(ITK, "bundle/index-worker-embedded.min.js")]);
  const kontur = megabytes(
    ["index", "client", "samples", "types", "wasi", "worker"].map((name) => join(PACKAGE, `${name}.js`)).concat(join(PACKAGE, "kontur.wasm")),
  );
  return { "kontur-wasm": kontur, ITK: itk, "ITK, dilations": itk };
}

async function table() {
  const folder = mkdtempSync(join(tmpdir(), "kontur-"));
  const size = sizes();
  console.log("| painted | filled by | mean distance, mm | Dice | processor time, s | MB of memory | MB to load |\n|---|---|--:|--:|--:|--:|--:|");
  for (const [organ, { name, painted }] of Object.entries(CASES)) {
    const truth = join(folder, `${organ}.nrrd`);
    const given = await drawn({ name, painted });
    write(truth, given.truth, given.grid);
    for (const method of Object.keys(METHODS)) {
      const path = join(folder, "made.nrrd");
      const { seconds, memory_mb } = JSON.parse(
        execFileSync(process.execPath, [fileURLToPath(import.meta.url), PACKAGE, PEERS, KONTUR, organ, method, path], { encoding: "utf8" }),
      );
      const found = JSON.parse(execFileSync(KONTUR, ["compare", path, truth, "--json"], { encoding: "utf8" }));
      const cells = [
        found.mean_surface_distance_mm.toFixed(3),
        found.dice.toFixed(4),
        seconds.toFixed(2),
        memory_mb ? memory_mb.toFixed(0) : "",
        size[method]?.toFixed(2) ?? "",
      ];
      console.log(`| ${organ}, ${painted} slices | ${method} | ${cells.join(" | ")} |`);
    }
  }
  rmSync(folder, { recursive: true });
}

await (CHILD.length ? measure(...CHILD) : table());
