// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { toScreen, toWorld, type Point2 } from "../../src/geometry/screen";
import { fingerPair } from "../../src/tools/finger_pair";
import { Fingers } from "../../src/tools/fingers";
import type { Gesture } from "../../src/tools/gesture";
import { near, started } from "./support";

/** Fingers whose gestures write down what becomes of them; `passTime` lets a finger have rested. */
function fingers(isStroke = true) {
  const told: string[] = [];
  let waits: (() => void) | null = null;
  const gesture = (name: string): Gesture => ({
    isStroke,
    move: (at) => told.push(`${name} ${at}`),
    end: (at) => told.push(`${name} ends ${at}`),
    cancel: () => told.push(`${name} dropped`),
  });
  const these = new Fingers({
    press: (at) => {
      told.push(`press ${at}`);
      return gesture("tool");
    },
    rest: (at) => {
      told.push(`rest ${at}`);
      return gesture("window");
    },
    pair: (a, b) => {
      told.push(`pair ${a} ${b}`);
      return { move: (p, q) => told.push(`two ${p} ${q}`) };
    },
    later: (act) => {
      waits = act;
      return () => (waits = null);
    },
  });
  const said = () => told.splice(0);
  return { these, said, passTime: () => waits?.() };
}

test("a tap is a click where the finger came down, though it trembles", () => {
  const { these, said } = fingers();
  these.begin(1, [50, 50]);
  these.move(1, [[53, 52]]);
  assert.deepEqual(said(), []);
  assert.ok(these.lift(1, [54, 52]));
  assert.deepEqual(said(), ["press 50,50", "tool ends 50,50"]);
});

test("a stroke keeps every place from the first touch on", () => {
  const { these, said, passTime } = fingers();
  these.begin(1, [0, 0]);
  these.move(1, [[3, 0]]);
  these.move(1, [
    [6, 0],
    [12, 0],
  ]);
  passTime();
  these.move(1, [
    [20, 0],
    [30, 0],
  ]);
  these.lift(1, [31, 0]);
  assert.deepEqual(said(), ["press 0,0", "tool 3,0", "tool 6,0", "tool 12,0", "tool 20,0", "tool 30,0", "tool ends 31,0"]);
});

test("what is no stroke hears of the latest place alone", () => {
  const { these, said } = fingers(false);
  these.begin(1, [0, 0]);
  these.move(1, [
    [6, 0],
    [12, 0],
  ]);
  these.move(1, [
    [20, 0],
    [30, 0],
  ]);
  assert.deepEqual(said(), ["press 0,0", "tool 12,0", "tool 30,0"]);
});

test("a second finger before the first has moved far makes a pair, and nothing is pressed or drawn", () => {
  const { these, said, passTime } = fingers();
  these.begin(1, [0, 0]);
  assert.ok(these.join(2, [100, 0]));
  passTime();
  these.move(2, [[120, 0]]);
  these.move(1, [[0, 40]]);
  assert.ok(!these.lift(1, [0, 40]));
  these.move(2, [[140, 0]]);
  assert.ok(these.lift(2, [140, 0]));
  assert.deepEqual(said(), ["pair 0,0 100,0", "two 0,0 120,0", "two 0,40 120,0"]);
});

test("a stroke that has just begun is dropped by a pinch, one that has gone far draws on", () => {
  const { these, said } = fingers();
  these.begin(1, [0, 0]);
  these.move(1, [[15, 0]]);
  these.join(2, [100, 0]);
  assert.deepEqual(said(), ["press 0,0", "tool 15,0", "tool dropped", "pair 15,0 100,0"]);
  these.lift(2, [100, 0]);
  these.lift(1, [15, 0]);
  these.begin(1, [0, 0]);
  these.move(1, [[40, 0]]);
  assert.ok(these.join(2, [100, 0]), "it is of this view, and does nothing");
  these.move(2, [[90, 0]]);
  these.move(1, [[60, 0]]);
  assert.ok(!these.lift(1, [60, 0]));
  assert.ok(these.lift(2, [90, 0]));
  assert.deepEqual(said(), ["press 0,0", "tool 40,0", "tool 60,0", "tool ends 60,0"]);
});

test("a finger that rests changes the window", () => {
  const { these, said, passTime } = fingers(false);
  these.begin(1, [5, 5]);
  passTime();
  these.move(1, [[25, 5]]);
  these.lift(1, [25, 5]);
  assert.deepEqual(said(), ["rest 5,5", "window 25,5", "window ends 25,5"]);
});

test("what is given up does not end, and a lift that nobody told of stops nothing", () => {
  const { these, said } = fingers();
  these.begin(1, [0, 0]);
  these.move(1, [[15, 0]]);
  assert.ok(these.cancel());
  assert.ok(!these.cancel());
  assert.deepEqual(said(), ["press 0,0", "tool 15,0", "tool dropped"]);
  assert.ok(!these.join(2, [9, 9]), "the finger that is still there is nothing any more");
  these.begin(3, [0, 0]);
  assert.ok(these.lift(3, [0, 0]));
});

function pair(a: Point2, b: Point2) {
  const navigation = started();
  const screen = () => navigation.screen("axial", 400, 400);
  return { navigation, screen, ...fingerPair("axial", navigation, screen, a, b) };
}

test("fingers that part zoom about what is between them, and it goes with them", () => {
  const { navigation, screen, move } = pair([150, 100], [250, 100]);
  const held = toWorld(screen(), [200, 100]);
  for (let i = 1; i <= 20; ++i) move([150 - 3 * i, 100 + i], [250 + 5 * i, 100 + i]);
  near(toScreen(screen(), held), [220, 120], 1e-6);
  assert.ok(Math.abs(navigation.cameras.axial.zoom - 2.6) < 1e-9, String(navigation.cameras.axial.zoom));
  assert.equal(navigation.slice("axial").number, 26, "no slice was left");
});

test("fingers that go sideways together take the image along", () => {
  const { navigation, screen, move } = pair([150, 100], [250, 100]);
  const held = toWorld(screen(), [200, 100]);
  for (let i = 1; i <= 20; ++i) move([150 + 4 * i, 100 + i], [250 + 4 * i, 100 + i]);
  near(toScreen(screen(), held), [280, 120], 1e-6);
  assert.equal(navigation.cameras.axial.zoom, 1);
});

test("fingers that go down together scroll on, as many slices as there are along the view, and back", () => {
  const { navigation, screen, move } = pair([150, 100], [250, 100]);
  const before = screen();
  for (let y = 1; y <= 80; ++y) move([150, 100 + y], [252, 100 + y]);
  assert.equal(navigation.slice("axial").number, 26 + Math.trunc(80 / (400 / 51)));
  for (let y = 80; y >= 0; --y) move([150, 100 + y], [300, 100 + y]); // a pinch that comes later does not count
  assert.equal(navigation.slice("axial").number, 26);
  near([screen().mm_per_pixel], [before.mm_per_pixel]);
});
