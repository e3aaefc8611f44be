// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Project } from "../../src/model/project";
import { Editor } from "../../src/tools/editor";
import { TOOLS } from "../../src/tools/registry";
import type { EditorServices } from "../../src/tools/services";
import { HELP_SECTIONS } from "../../src/tools/tool";
import { COMMANDS, HELD_KEYS } from "../../src/ui/commands";
import { helpRows } from "../../src/ui/help";
import { hintFor } from "../../src/ui/hints";
import { session, started } from "./support";

const project = new Project();
project.start(session());
const editor = new Editor(started(), project, { call: () => new Promise(() => undefined) } as unknown as EditorServices);

const twice = (words: readonly string[]) => words.filter((word, i) => words.indexOf(word) !== i);
const rows = HELP_SECTIONS.flatMap(helpRows);

test("no two tools have a name in common, and no two commands a key", () => {
  assert.deepEqual(twice(TOOLS.map(({ id }) => id)), []);
  assert.deepEqual(twice(TOOLS.map(({ icon }) => icon)), []);
  assert.deepEqual(twice([...COMMANDS.flatMap(({ keys }) => keys), ...HELD_KEYS.map(({ key }) => key)]), []);
});

test("the key of every tool takes it, and the ? sheet and the status line know it", () => {
  for (const { id, key } of [...TOOLS].reverse()) {
    const command = COMMANDS.find(({ keys }) => keys.includes(key))!;
    command.run({ editor } as Parameters<typeof command.run>[0], false);
    assert.equal(editor.tool.id, id);
    assert.ok(
      rows.some(([keys]) => keys.split(/[ ,]+/).includes(key.toUpperCase())),
      `${key.toUpperCase()} is on the sheet`,
    );
    assert.notEqual(hintFor(editor), "");
  }
});

test("every row of the ? sheet is there once", () => {
  assert.deepEqual(twice(rows.map(([keys]) => keys)), []);
  for (const section of HELP_SECTIONS) assert.ok(helpRows(section).length > 0, section);
});

test("the tool that made a sketch goes on with it", () => {
  const resuming = (kind: "free" | "line" | "spline" | "wire", redraws?: number) =>
    TOOLS.filter((tool) => tool.resumes?.({ kind, redraws } as never)).map(({ id }) => id);
  assert.deepEqual([resuming("free"), resuming("line"), resuming("spline"), resuming("wire")], [["freehand"], ["freehand"], ["spline"], ["wire"]]);
  assert.deepEqual(resuming("free", 3), ["redraw"]);
});
