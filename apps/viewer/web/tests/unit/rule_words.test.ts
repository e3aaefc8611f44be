// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { completed, completions, nameInRules } from "../../src/model/rule_words";

const NAMES = ["Tumour", "Lung L", "Lung R", "or", "3rd"];
const offers = (line: string, caret = line.length) => completions(line, caret, NAMES).map(({ text }) => text);

test("names are written as rules read them", () => {
  assert.deepEqual(["CTV", "Lung L", "or", "3rd", "it's", "Tumör"].map(nameInRules), ["CTV", "'Lung L'", "'or'", "'3rd'", `"it's"`, "Tumör"]);
});

test("a word is completed by names, functions and words, before the caret alone", () => {
  assert.deepEqual(offers("PTV = Tu"), ["Tumour"]);
  assert.deepEqual(offers("PTV = lu"), ["'Lung L'", "'Lung R'"]);
  assert.deepEqual(offers("PTV = our"), ["Tumour"], "what has it within");
  assert.deepEqual(offers("PTV = Tumour + 5 m"), ["Tumour", "ml", "mm"]);
  assert.deepEqual(offers("PTV = cr"), ["crop("]);
  assert.deepEqual(offers("PTV = Tu - 'Lung L'", 8), ["Tumour"]);
});

test("nothing is offered where nothing is typed, the name is new, or the word is whole", () => {
  for (const line of ["", "Tu", "PTV = ", "PTV = Tumour", "PTV = Tumour + 5"]) assert.deepEqual(offers(line), [], line);
});

test("quotes that are open belong to the word", () => {
  const line = "A = 'Lung";
  const [first] = completions(line, line.length, NAMES);
  assert.deepEqual(first, { text: "'Lung L'", from: 4 });
  assert.deepEqual(completed(line, line.length, first!), { line: "A = 'Lung L'", caret: 12 });
  assert.deepEqual(completed("A = Tu + 5 mm", 6, { text: "Tumour", from: 4 }), { line: "A = Tumour + 5 mm", caret: 10 });
});
