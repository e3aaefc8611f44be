// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Pointers } from "../../src/tools/pointers";

const mouse = { pointerId: 1, pointerType: "mouse" };
const finger = (pointerId: number) => ({ pointerId, pointerType: "touch" });
const pen = (pointerId: number) => ({ pointerId, pointerType: "pen" });

function pointers() {
  const left: number[] = [];
  const told = { ofPen: 0 };
  const these = new Pointers(() => void ++told.ofPen);
  const take = (pointer: typeof mouse) => these.take(pointer, () => void left.push(pointer.pointerId));
  return { these, take, left, told };
}

test("one pointer works at a time, and the next one after it is released", () => {
  const { these, take, left } = pointers();
  assert.ok(take(finger(2)));
  assert.ok(!take(finger(3)));
  assert.ok(these.holds(finger(2)) && !these.holds(finger(3)));
  assert.ok(these.ignores(finger(3)) && these.ignores(mouse) && !these.ignores(finger(2)));
  these.release();
  assert.ok(take(finger(3)));
  assert.deepEqual(left, []);
});

test("a pen takes over from the palm that came before it, and from nothing else", () => {
  const { these, take, left } = pointers();
  assert.ok(take(finger(2)));
  assert.ok(take(pen(5)));
  assert.deepEqual(left, [2]);
  assert.ok(!take(mouse));
  these.release();
  assert.ok(take(mouse));
  assert.ok(!take(pen(5)));
});

test("touches are no longer taken once a pen was seen, if only above the screen, and that is said once", () => {
  const { these, take, told } = pointers();
  assert.ok(!these.ignores(finger(2)));
  assert.ok(!these.ignores(pen(5)));
  assert.ok(these.ignores(finger(2)));
  assert.ok(!take(finger(2)) && !take(finger(3)));
  assert.equal(told.ofPen, 1);
  assert.ok(take(mouse));
});

test("a pointer whose release was never told can press again", () => {
  const { take, left } = pointers();
  assert.ok(take(mouse));
  assert.ok(take(mouse));
  assert.deepEqual(left, [1]);
});
