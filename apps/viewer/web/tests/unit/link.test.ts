// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Link } from "../../src/net/link";

function after(...replies: [bytes: number, ms: number][]): boolean {
  const link = new Link();
  for (const [bytes, ms] of replies) link.took(bytes, ms);
  return link.isSlow;
}

const slow: [number, number] = [260_000, 100];
const fast: [number, number] = [260_000, 2];
const small: [number, number] = [900, 40];

test("a way is slow where several large replies took long, and none was fast", () => {
  assert.equal(after(slow, slow, slow, slow, slow), true);
  assert.equal(after(slow, slow, slow), false, "too few to tell");
  assert.equal(after(slow, slow, fast, slow, slow, slow), false, "the page was busy");
  assert.equal(after(small, small, small, small, small, small), false, "small ones tell nothing");
  assert.equal(after(slow, slow, slow, slow, slow, small, fast), false, "the way has become fast");
  assert.equal(after(fast, slow, slow, slow, slow, slow), true, "or slow");
});
