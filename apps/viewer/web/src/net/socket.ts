// SPDX-License-Identifier: Apache-2.0
import { ServerError } from "./http";
import type { Arguments, CallName, Result } from "./calls";
import { Latest } from "./latest";
import type { ServerEvent } from "./protocol";

interface Pending {
  resolve: (result: unknown) => void;
  reject: (error: Error) => void;
}

export type ConnectionState = "connecting" | "open" | "silent" | "lost";

export interface SocketHandlers {
  event(event: ServerEvent): void;
  /**
   * "open" when the session event has come; "silent" when the connection stands, but nothing comes over it any more, until
   * something does ("open" again); "lost" is told while edits under way still count as unsaved.
   */
  connection(state: ConnectionState): void;
  /** How many edits the server has not yet acknowledged, and whether it has just acknowledged one. */
  unsaved(count: number, acknowledged: boolean): void;
  /** Asks, not over this connection, whether the server answers anything at all. */
  knock(): Promise<void>;
}

const RETRY_MS = 1000;
const TICK_MS = 2500;
const TICKS_UNTIL_SILENT = 4; // in which signs of life are asked for
const READING_CALLS = new Set<CallName>(["path", "value", "ping", "page.save", "draft.drop"]);

/**
 * Calls and events over one WebSocket, which is opened again when it is lost. One that is silent is kept: should the server go
 * on (it was suspended, or a tunnel hung), it carries out once what it was sent, and nobody need guess which edits had arrived.
 */
export class Socket {
  private socket: WebSocket | null = null;
  private readonly pending = new Map<number, Pending & { edits: boolean }>();
  private nextSeq = 1;
  private greeted = false;
  /** Ticks since anything came. They count what the clock does not: a laptop that sleeps, or a tab that is held back, has fewer. */
  private quietTicks = 0;
  private readonly pings = new Latest<void>(() => this.call("ping", {}));
  /** Calls are answered in order: while one takes long no ping is, but the server is there. */
  private readonly knocks = new Latest<void>(async () => {
    await this.handlers.knock();
    this.hear();
  });

  constructor(
    private readonly token: string,
    private readonly handlers: SocketHandlers,
  ) {
    setInterval(() => this.tick(), TICK_MS);
  }

  /** Asks anew what there is: another session has come, or none. */
  reopen(): void {
    const old = this.socket;
    this.socket = null;
    this.greeted = false;
    this.quietTicks = 0;
    old?.close();
    this.open();
  }

  open(): void {
    this.handlers.connection("connecting");
    const socket = new WebSocket(`ws://${location.host}/api/socket`, ["kontur", this.token]);
    socket.addEventListener("message", (message: MessageEvent<string>) => {
      if (socket === this.socket) this.receive(JSON.parse(message.data) as Record<string, unknown>);
    });
    socket.addEventListener("close", () => {
      if (socket === this.socket) this.lose();
    });
    this.socket = socket;
  }

  call<Name extends CallName>(name: Name, args: Arguments<Name>): Promise<Result<Name>> {
    const isDraft = "draft" in args && args.draft === true;
    const edits = !READING_CALLS.has(name) && !isDraft;
    // Before it is known what the project holds, an edit could repeat one that had arrived when the connection was lost.
    if (!this.greeted || this.socket?.readyState !== WebSocket.OPEN)
      return Promise.reject(new ServerError("offline", "Not connected to kontur: nothing was changed.", edits));
    const seq = this.nextSeq++;
    const reply = new Promise<Result<Name>>((resolve, reject) => void this.pending.set(seq, { resolve: resolve as (result: unknown) => void, reject, edits }));
    this.socket.send(JSON.stringify({ seq, call: name, ...args }));
    if (edits) this.tellUnsaved(false);
    return reply;
  }

  private receive(message: Record<string, unknown>): void {
    this.hear();
    if (typeof message["event"] === "string") {
      if (message["event"] === "session" || message["event"] === "start") this.greet();
      return this.handlers.event(message as unknown as ServerEvent);
    }
    const pending = this.pending.get(message["seq"] as number);
    if (!pending) return;
    this.pending.delete(message["seq"] as number);
    const error = message["error"] as { kind: string; message: string } | undefined;
    if (error) pending.reject(new ServerError(error.kind, error.message, pending.edits));
    else pending.resolve(message["result"]);
    if (pending.edits) this.tellUnsaved(!error);
  }

  private tick(): void {
    if (!this.greeted) return;
    if (++this.quietTicks === TICKS_UNTIL_SILENT) this.handlers.connection("silent");
    if (!this.pings.busy) this.pings.send();
    if (this.quietTicks > 1 && !this.knocks.busy) this.knocks.send();
  }

  /** Whatever comes is a sign of life. */
  private hear(): void {
    const wasSilent = this.quietTicks >= TICKS_UNTIL_SILENT;
    this.quietTicks = 0;
    if (wasSilent) this.handlers.connection("open");
  }

  private greet(): void {
    this.greeted = true;
    this.handlers.connection("open");
  }

  private lose(): void {
    this.greeted = false;
    this.quietTicks = 0;
    this.handlers.connection("lost");
    const lost = [...this.pending.values()];
    this.pending.clear();
    for (const { reject, edits } of lost) reject(new ServerError("lost", "The connection to kontur was lost.", edits));
    this.tellUnsaved(false);
    setTimeout(() => this.open(), RETRY_MS);
  }

  private tellUnsaved(acknowledged: boolean): void {
    this.handlers.unsaved([...this.pending.values()].filter((pending) => pending.edits).length, acknowledged);
  }
}
