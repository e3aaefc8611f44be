// SPDX-License-Identifier: Apache-2.0
// Each of these went unseen by the compiler, and left a user with a field that takes no key or a file that no click chooses.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { transform } from "esbuild";
import { ESLint } from "eslint";

const linter = new ESLint();

/** The rules that a line of the page breaks. `field` is an input, `event` a key's. */
async function broken(line: string): Promise<(string | null)[]> {
  const text = `import { el } from "../dom/dom";\nexport function handle(field: HTMLInputElement, save: () => Promise<void>): void {\n  ${line}\n}\nexport { el };\n`;
  const [result] = await linter.lintText(text, { filePath: "src/ui/hints.ts" }); // a file of the project, whose types are known
  return result!.messages.map(({ ruleId }) => ruleId);
}

test("the linter refuses handler properties", async () => {
  assert.deepEqual(await broken("field.onkeydown = (event) => { if (event.key === 'Enter') field.blur(); };"), ["no-restricted-syntax"]);
  assert.deepEqual(await broken('field["onclick"] = null;'), ["no-restricted-syntax"]);
  assert.deepEqual(await broken("el('input', { onchange: () => field.blur() });"), ["no-restricted-syntax"]);
});

test("the linter refuses handlers that return what they were not asked for, and promises that nobody hears of", async () => {
  assert.deepEqual(await broken("field.addEventListener('keydown', (event) => event.key === 'Enter' && field.blur());"), [
    "@typescript-eslint/strict-void-return",
  ]);
  assert.deepEqual(await broken("el('input', { on: { keydown: (event) => event.key === 'Enter' && field.blur() } });"), [
    "@typescript-eslint/strict-void-return",
  ]);
  assert.deepEqual(await broken("save();"), ["@typescript-eslint/no-floating-promises"]);
  assert.deepEqual(await broken("el('input', { on: { keydown: (event) => { if (event.key === 'Enter') field.blur(); } } });"), []);
});

test("browsers drop no rule of the style sheet", async () => {
  const warnings = async (css: string): Promise<string[]> => (await transform(css, { loader: "css" })).warnings.map(({ text }) => text);
  assert.notDeepEqual(await warnings(".slice-slider,\n@media (hover: none) { a { color: red; } }"), [], "a rule that has lost its end");
  assert.deepEqual(await warnings(await readFile("src/style.css", "utf8")), []);
});
