// SPDX-License-Identifier: Apache-2.0
// A file that needs itself by way of others can be read, tested and changed only together with them. Types count, too.
import assert from "node:assert/strict";
import { readdirSync, readFileSync, statSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { test } from "node:test";
import ts from "typescript";

/** What each file imports of the others, by its path. */
type Imports = ReadonlyMap<string, readonly string[]>;

/** One way around from a file back to it; null where there is none. */
function circle(imports: Imports): string[] | null {
  const isDone = new Set<string>();
  const way: string[] = [];
  const follow = (file: string): string[] | null => {
    if (way.includes(file)) return [...way.slice(way.indexOf(file)), file];
    if (isDone.has(file)) return null;
    way.push(file);
    for (const next of imports.get(file) ?? []) {
      const found = follow(next);
      if (found) return found;
    }
    way.pop();
    isDone.add(file);
    return null;
  };
  for (const file of imports.keys()) {
    const found = follow(file);
    if (found) return found;
  }
  return null;
}

/** The sources below a folder of the page, with what they import of each other. */
function importsBelow(folder: string): Imports {
  const files = (readdirSync(folder, { recursive: true }) as string[]).filter((name) => name.endsWith(".ts") && statSync(join(folder, name)).isFile());
  return new Map(
    files.map((file) => {
      const { importedFiles } = ts.preProcessFile(readFileSync(join(folder, file), "utf8"));
      const own = importedFiles.map(({ fileName }) => fileName).filter((name) => name.startsWith("."));
      return [file, own.map((name) => `${relative(folder, join(folder, dirname(file), name))}.ts`)];
    }),
  );
}

test("no source imports itself by way of others", () => {
  const imports = importsBelow("src");
  assert.ok(imports.get("main.ts")?.includes("app.ts"), "the sources are there, and are read");
  for (const [file, others] of imports) for (const other of others) assert.ok(imports.has(other), `${file} imports ${other}`);
  assert.equal(circle(imports)?.join(" > "), undefined);
});

test("circles are found, and what only meets again is none", () => {
  const imports = (...pairs: [string, string[]][]): Imports => new Map(pairs);
  assert.deepEqual(circle(imports(["a", ["b", "c"]], ["b", ["d"]], ["c", ["d"]], ["d", []])), null);
  assert.deepEqual(circle(imports(["a", ["b", "c"]], ["b", []], ["c", ["d"]], ["d", ["c"]])), ["c", "d", "c"]);
  assert.deepEqual(circle(imports(["a", ["a"]])), ["a", "a"]);
});
