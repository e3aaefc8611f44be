// SPDX-License-Identifier: Apache-2.0
// Bundles the TypeScript under tests/<what>/ and runs it: `node tests/run.mjs unit`.
import { spawnSync } from "node:child_process";
import { mkdirSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const tests = dirname(fileURLToPath(import.meta.url));
const [what = "unit", ...rest] = process.argv.slice(2);
const output = join(tests, "..", "node_modules", ".tests", what);
const files = readdirSync(join(tests, what)).filter((name) => (what === "unit" ? name.endsWith(".test.ts") : name.endsWith(".ts")));

mkdirSync(output, { recursive: true });
await build({
  entryPoints: files.map((name) => join(tests, what, name)),
  outdir: output,
  outExtension: { ".js": ".mjs" },
  bundle: true,
  platform: "node",
  format: "esm",
  target: "node18",
  packages: "external",
  sourcemap: "inline",
});
const outputs = files.map((name) => join(output, name.replace(/\.ts$/, ".mjs")));
const run = what === "unit" ? ["--enable-source-maps", "--test", ...outputs] : ["--enable-source-maps", join(output, `${what === "mock" ? "server" : what}.mjs`), ...rest];
process.exit(spawnSync(process.execPath, run, { stdio: "inherit" }).status ?? 1);
