// SPDX-License-Identifier: Apache-2.0
import { ServerError } from "./http";
import type { ServerEvent } from "./protocol";

interface Pending {
  resolve: (result: unknown) => void;
  reject: (error: Error) => void;
}

export type ConnectionState = "connecting" | "open" | "lost";

export interface SocketHandlers {
  event(event: ServerEvent): void;
  connection(state: ConnectionState): void;
  /** How many edits the server has not yet acknowledged. */
  unsaved(count: number): void;
}

const RETRY_MS = 1000;
const READING_CALLS = new Set(["path", "value", "ping", "page.save", "draft.drop"]);

/** Calls and events over one WebSocket, which is opened again when it is lost. */
export class Socket {
  private socket: WebSocket | null = null;
  private readonly pending = new Map<number, Pending & { edits: boolean }>();
  private nextSeq = 1;

  constructor(
    private readonly token: string,
    private readonly handlers: SocketHandlers,
  ) {}

  open(): void {
    this.handlers.connection("connecting");
    const socket = new WebSocket(`ws://${location.host}/api/socket`, ["kontur", this.token]);
    socket.onopen = () => this.handlers.connection("open");
    socket.onmessage = (message: MessageEvent<string>) => this.receive(JSON.parse(message.data) as Record<string, unknown>);
    socket.onclose = () => this.lose();
    this.socket = socket;
  }

  call<Result>(name: string, args: Record<string, unknown> = {}): Promise<Result> {
    if (this.socket?.readyState !== WebSocket.OPEN)
      return Promise.reject(new ServerError("io", "Not connected to kontur; nothing was changed."));
    const seq = this.nextSeq++;
    const edits = !READING_CALLS.has(name) && args["draft"] !== true;
    const reply = new Promise<Result>((resolve, reject) =>
      this.pending.set(seq, { resolve: resolve as (result: unknown) => void, reject, edits }),
    );
    this.socket.send(JSON.stringify({ seq, call: name, ...args }));
    if (edits) this.tellUnsaved();
    return reply;
  }

  private receive(message: Record<string, unknown>): void {
    if (typeof message["event"] === "string") return this.handlers.event(message as unknown as ServerEvent);
    const pending = this.pending.get(message["seq"] as number);
    if (!pending) return;
    this.pending.delete(message["seq"] as number);
    const error = message["error"] as { kind: string; message: string } | undefined;
    if (error) pending.reject(new ServerError(error.kind, error.message));
    else pending.resolve(message["result"]);
    if (pending.edits) this.tellUnsaved();
  }

  private lose(): void {
    const lost = [...this.pending.values()];
    this.pending.clear();
    for (const { reject } of lost) reject(new ServerError("io", "The connection to kontur was lost."));
    this.tellUnsaved();
    this.handlers.connection("lost");
    setTimeout(() => this.open(), RETRY_MS);
  }

  private tellUnsaved(): void {
    this.handlers.unsaved([...this.pending.values()].filter((pending) => pending.edits).length);
  }
}
