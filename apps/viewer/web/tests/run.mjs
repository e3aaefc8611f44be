// SPDX-License-Identifier: Apache-2.0
// Bundles the TypeScript under tests/<what>/ and runs it: `node tests/run.mjs unit`, or only some of its files:
// `node tests/run.mjs e2e edit page`. Several such runs may go at once. KONTUR_BROWSER=firefox runs e2e and bench in Firefox instead of Chromium.
import { spawnSync } from "node:child_process";
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

const [what = "unit", ...rest] = process.argv.slice(2);

const browsers = {
  chromium: [process.env.KONTUR_CHROMIUM ?? "/usr/bin/chromium-headless-shell"],
  firefox: [process.env.KONTUR_FIREFOX ?? "/usr/bin/firefox-esr", "/usr/bin/Xvfb"],
};
const browser = process.env.KONTUR_BROWSER ?? "chromium";
const missing = browsers[browser].find((path) => !existsSync(path));
if (what === "e2e" && missing) {
  console.log(`skipped: there is no ${missing} to open the page in (tools/setup installs it)`);
  process.exit(77);
}

const tests = dirname(fileURLToPath(import.meta.url));
const output = join(tests, "..", "node_modules", ".tests", browser, what); // the two may run at once
const ending = what === "bench" ? ".ts" : ".test.ts";
const isWanted = (name) => what === "bench" || rest.length === 0 || rest.includes(name.slice(0, -ending.length));
const files = readdirSync(join(tests, what)).filter((name) => name.endsWith(ending) && isWanted(name));
if (files.length === 0) throw new Error(`there is no test of ${rest.join(", ")} in tests/${what}`);

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
const run = what === "bench" ? [join(output, `${rest[0] ?? "bench"}.mjs`)] : ["--test", ...outputs];
process.exit(spawnSync(process.execPath, ["--enable-source-maps", ...run], { stdio: "inherit" }).status ?? 1);
