// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test, type TestContext } from "node:test";
import { BinaryReply } from "../../src/net/binary";
import type { ServerError } from "../../src/net/http";
import { Latest } from "../../src/net/latest";
import { Socket } from "../../src/net/socket";
import { session } from "./support";

interface Job {
  request: number;
  finish: () => void;
}

function jobs(): { started: Job[]; latest: Latest<number> } {
  const started: Job[] = [];
  const latest = new Latest<number>((request) => new Promise<void>((finish) => started.push({ request, finish })));
  return { started, latest };
}

const settled = () => new Promise((resolve) => setImmediate(resolve));

test("one request runs at a time, and of those that wait only the latest follows", async () => {
  const { started, latest } = jobs();
  for (const request of [1, 2, 3, 4]) latest.send(request);
  assert.deepEqual(
    started.map((job) => job.request),
    [1],
  );
  started[0]!.finish();
  await settled();
  assert.deepEqual(
    started.map((job) => job.request),
    [1, 4],
  );
  started[1]!.finish();
  await latest.idle();
  assert.equal(latest.busy, false);
});

test("requests that wait are merged as told", async () => {
  const seen: boolean[] = [];
  const latest = new Latest<boolean>(
    async (pixels) => void seen.push(pixels),
    (a, b) => a || b,
  );
  for (const pixels of [false, true, false]) latest.send(pixels);
  await latest.idle();
  assert.deepEqual(seen, [false, true]);
});

test("a dropped request does not run, a failed one does not stop the next", async () => {
  const seen: number[] = [];
  const latest = new Latest<number>(async (request) => {
    seen.push(request);
    if (request === 1) throw new Error("refused");
  });
  latest.send(1);
  latest.send(2);
  latest.drop();
  await latest.idle();
  latest.send(3);
  await latest.idle();
  assert.deepEqual(seen, [1, 3]);
});

/** The browser's end of a connection whose other end the test plays. */
class FakeWebSocket {
  static readonly OPEN = 1;
  static last: FakeWebSocket;
  readyState = FakeWebSocket.OPEN;
  readonly sent: { seq: number; call: string }[] = [];
  private readonly listeners = new Map<string, (event: { data: string }) => void>();

  constructor() {
    FakeWebSocket.last = this;
  }

  addEventListener(type: string, listener: (event: { data: string }) => void): void {
    this.listeners.set(type, listener);
  }

  close(): void {
    this.listeners.get("close")!({ data: "" });
  }

  send(text: string): void {
    this.sent.push(JSON.parse(text) as { seq: number; call: string });
  }

  answer(seq = this.sent.at(-1)!.seq): void {
    this.tell({ seq, result: {} });
  }

  tell(message: object): void {
    this.listeners.get("message")!({ data: JSON.stringify(message) });
  }
}

interface Timers {
  /** Lets the page's intervals come once. */
  tick(): void;
}

/** A socket in a page whose clock the test turns, and what it tells. */
function connecting(context: TestContext, knock = () => new Promise<void>(() => undefined)): { socket: Socket; told: string[]; timers: Timers } {
  const { setTimeout, setInterval } = globalThis;
  context.after(() => Object.assign(globalThis, { setTimeout, setInterval }));
  const intervals: (() => void)[] = [];
  Object.assign(globalThis, {
    WebSocket: FakeWebSocket,
    location: { host: "127.0.0.1:1" },
    setTimeout: () => 0,
    setInterval: (act: () => void, ms: number) => {
      assert.equal(ms, 2500);
      intervals.push(act);
    },
  });
  const told: string[] = [];
  const socket = new Socket("token", {
    event: ({ event }) => told.push(event),
    connection: (state) => told.push(state),
    unsaved: (count, acknowledged) => told.push(`${count}${acknowledged ? " acknowledged" : ""}`),
    knock,
  });
  return { socket, told, timers: { tick: () => intervals.forEach((act) => act()) } };
}

const failure = (call: Promise<unknown>): Promise<string> =>
  call.then(
    () => "done",
    ({ kind, edits }: ServerError) => `${kind}${edits ? ", an edit" : ""}`,
  );

test("of a connection's calls none is sent before the session is known, and lost edits are told as such", async (context) => {
  const { socket, told } = connecting(context);
  socket.open();
  assert.equal(await failure(socket.call("undo", {})), "offline, an edit");
  assert.equal(await failure(socket.call("value", { at: [0, 0, 0] })), "offline");
  assert.equal(FakeWebSocket.last.sent.length, 0);
  FakeWebSocket.last.tell(session());
  const first = failure(socket.call("undo", {}));
  FakeWebSocket.last.answer();
  assert.equal(await first, "done");
  const under_way = [socket.call("undo", {}), socket.call("contour.pull", { id: 1, from: [0, 0, 0], to: [1, 0, 0], draft: true })].map(failure);
  FakeWebSocket.last.close();
  assert.deepEqual(await Promise.all(under_way), ["lost, an edit", "lost"]);
  assert.deepEqual(told, ["connecting", "open", "session", "1", "0 acknowledged", "1", "lost", "0"]);
});

test("a connection over which nothing comes for 10 s is silent until something does, and its edits are sent once", async (context) => {
  const { socket, told, timers } = connecting(context);
  socket.open();
  for (let i = 0; i < 9; ++i) timers.tick();
  assert.deepEqual(told.splice(0), ["connecting"], "nobody has answered yet");
  const { last } = FakeWebSocket;
  last.tell(session());
  for (let i = 0; i < 9; ++i) {
    timers.tick();
    last.answer();
    await settled();
  }
  assert.equal(last.sent.length, 9);
  assert.deepEqual(told.splice(0), ["open", "session"]);
  const edit = failure(socket.call("undo", {}));
  for (let i = 0; i < 3; ++i) timers.tick();
  assert.deepEqual(told.splice(0), ["1"]);
  for (let i = 0; i < 9; ++i) timers.tick();
  assert.deepEqual(told.splice(0), ["silent"]);
  last.answer(last.sent[9]!.seq);
  assert.equal(await edit, "done");
  assert.deepEqual(told, ["open", "0 acknowledged"]);
  assert.deepEqual(
    last.sent.slice(9).map(({ call }) => call),
    ["undo", "ping"],
  );
});

test("a server that takes long over a call, and answers otherwise, is not silent", async (context) => {
  const knocks: (() => void)[] = [];
  const { socket, told, timers } = connecting(context, () => new Promise((answer) => knocks.push(answer)));
  socket.open();
  FakeWebSocket.last.tell(session());
  void socket.call("undo", {});
  for (let i = 0; i < 9; ++i) {
    for (let n = 0; n < 3; ++n) timers.tick();
    assert.equal(knocks.length, 1, "one at a time");
    knocks.pop()!();
    await settled();
  }
  assert.ok(!told.includes("silent"));
  for (let n = 0; n < 4; ++n) timers.tick();
  assert.ok(told.includes("silent"));
  knocks.pop()!();
  await settled();
  assert.equal(told.at(-1), "open");
});

test("events are a sign of life while a call takes long", (context) => {
  const { socket, told, timers } = connecting(context);
  socket.open();
  FakeWebSocket.last.tell(session());
  void socket.call("undo", {});
  for (let i = 0; i < 9; ++i) {
    timers.tick();
    timers.tick();
    timers.tick();
    FakeWebSocket.last.tell({ event: "status", text: "Computing", fraction: i / 9 });
  }
  assert.ok(!told.includes("silent"));
});

test("a silent connection that is lost is opened again, and silent only after as long", async (context) => {
  const { socket, told, timers } = connecting(context);
  socket.open();
  FakeWebSocket.last.tell(session());
  const edit = failure(socket.call("undo", {}));
  for (let i = 0; i < 4; ++i) timers.tick();
  FakeWebSocket.last.close();
  assert.equal(await edit, "lost, an edit");
  socket.open();
  FakeWebSocket.last.tell(session());
  for (let i = 0; i < 3; ++i) timers.tick();
  assert.deepEqual(told, ["connecting", "open", "session", "1", "silent", "lost", "0", "connecting", "open", "session"]);
  assert.deepEqual(
    FakeWebSocket.last.sent.map(({ call }) => call),
    ["ping"],
    "the edit is not repeated",
  );
});

function reply(header: object, size: number): { buffer: ArrayBuffer; start: number } {
  const text = new TextEncoder().encode(JSON.stringify(header));
  const start = Math.ceil((4 + text.length) / 4) * 4;
  const buffer = new ArrayBuffer(start + size);
  new DataView(buffer).setUint32(0, start - 4, true);
  new Uint8Array(buffer).fill(32, 4, start).set(text, 4);
  return { buffer, start };
}

test("a binary reply gives its header, and arrays without copying", () => {
  const arrays = { pixels: { type: "u8", offset: 8, count: 3 }, points: { type: "f32", offset: 12, count: 2 } };
  const { buffer, start } = reply({ width: 3, arrays }, 200);
  new Uint8Array(buffer).set([7, 8, 9], start + 8);
  new Float32Array(buffer, start + 12, 2).set([1.5, -2]);
  const parsed = new BinaryReply<{ width: number }>(buffer);
  assert.deepEqual(parsed.header, { width: 3 });
  assert.deepEqual([...parsed.u8("pixels")], [7, 8, 9]);
  assert.deepEqual([...parsed.f32("points")], [1.5, -2]);
  assert.equal(parsed.f32("points").buffer, buffer);
});

test("an array that is missing is empty, one of another type is refused by name", () => {
  const { buffer } = reply({ arrays: { points: { type: "f32", offset: 100, count: 0 } } }, 100);
  const parsed = new BinaryReply(buffer);
  assert.equal(parsed.has("pixels"), false);
  assert.equal(parsed.u8("pixels").length, 0);
  assert.throws(() => parsed.u32("points"), /"points" holds f32/);
});
