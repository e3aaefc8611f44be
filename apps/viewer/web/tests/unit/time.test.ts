// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { Navigation } from "../../src/model/navigation";
import { Cine } from "../../src/model/cine";
import { editing } from "./editing";
import { session } from "./support";

function beating(times: number, time: number): Navigation {
  const plain = session();
  const navigation = new Navigation();
  navigation.start({ ...plain, image: { ...plain.image, times, time } }, null);
  return navigation;
}

const settled = () => new Promise((resolve) => setImmediate(resolve));

test("a cine goes on when the frame is there and the eye has had its time, from the last to the first", async () => {
  const navigation = beating(3, 1);
  const waiting: (() => void)[] = [];
  const wait = () => new Promise<void>((resolve) => waiting.push(resolve));
  const cine = new Cine(navigation, wait, wait);
  assert.equal(cine.toggle(), true);
  const times: number[] = [];
  for (let n = 0; n < 3; ++n) {
    await settled();
    times.push(navigation.time);
    waiting.shift()!();
    await settled();
    assert.equal(navigation.time, times.at(-1), "half of what is waited for is not enough");
    waiting.shift()!();
  }
  assert.deepEqual(times, [2, 0, 1]);
  cine.step(1);
  await settled();
  const stopped = navigation.time;
  waiting.forEach((go) => go());
  await settled();
  assert.deepEqual([cine.isPlaying, navigation.time], [false, stopped]);
});

test("an image of one frame is not played", () => {
  const cine = new Cine(beating(1, 0), () => Promise.resolve());
  assert.deepEqual([cine.toggle(), cine.step(1), cine.isPlaying], [false, false, false]);
});

test("what is begun in a frame is gone on with there, and tools that look around work in others", () => {
  const all = editing("spline");
  const { navigation, project, editor, press, edits, complaints, remedies } = all;
  const plain = session();
  navigation.on(["time"], () => project.setTime(navigation.time, navigation.ownTime));
  navigation.start({ ...plain, image: { ...plain.image, times: 5, time: 2 } }, null);
  const click = (at: [number, number]) => press(at)?.end(at);
  click([100, 100]);
  assert.equal(editor.drawing.sketch?.time, null);
  navigation.setTime(4);
  assert.equal(press([140, 100]), null);
  assert.match(complaints.at(-1)!, /What you are drawing belongs to frame 3; this is frame 5/);
  assert.deepEqual(edits(), []);
  remedies.at(-1)!.act();
  assert.equal(navigation.isAway, false);
  assert.notEqual(press([140, 100]), null);
});

test("a mask is corrected in its frame alone", () => {
  const { navigation, project, editor, press, complaints } = editing("freehand");
  const plain = session();
  navigation.on(["time"], () => project.setTime(navigation.time, navigation.ownTime));
  navigation.start({ ...plain, image: { ...plain.image, times: 5, time: 2 } }, null);
  const active = project.activeStructure!;
  project.structures.set(active.id, { ...active, mask: { hash: "a", reach: 1, drop_loose: false, confirmed_planes: [] } });
  navigation.setTime(4);
  assert.equal(press([100, 100]), null);
  assert.match(complaints.at(-1)!, /belongs to frame 3; in frame 5 it is only to be looked at/);
  assert.equal(editor.isOutOfTime, true);
});
