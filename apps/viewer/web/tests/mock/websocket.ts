// SPDX-License-Identifier: Apache-2.0
import { createHash } from "node:crypto";
import type { IncomingMessage } from "node:http";
import type { Socket } from "node:net";

/** Text frames over an upgraded connection (RFC 6455), as much of it as one browser needs. */
export class TextSocket {
  onText: (text: string) => void = () => undefined;
  private received = Buffer.alloc(0);

  constructor(request: IncomingMessage, private readonly socket: Socket) {
    const key = createHash("sha1").update(`${request.headers["sec-websocket-key"]}258EAFA5-E914-47DA-95CA-C5AB0DC85B11`).digest("base64");
    socket.setNoDelay(true);
    socket.write(`HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: ${key}\r\nSec-WebSocket-Protocol: kontur\r\n\r\n`);
    socket.on("data", (data) => this.receive(data));
    socket.on("error", () => undefined);
  }

  send(message: unknown): void {
    const body = Buffer.from(JSON.stringify(message));
    const size = body.length;
    const head = Buffer.alloc(size < 126 ? 2 : size < 65536 ? 4 : 10);
    head.set([0x81, size < 126 ? size : size < 65536 ? 126 : 127]);
    if (head.length === 4) head.writeUInt16BE(size, 2);
    if (head.length === 10) head.writeBigUInt64BE(BigInt(size), 2);
    this.socket.write(Buffer.concat([head, body]));
  }

  private receive(data: Buffer): void {
    this.received = Buffer.concat([this.received, data]);
    for (let frame = this.next(); frame; frame = this.next()) {
      if (frame.opcode === 8) return void this.socket.end();
      if (frame.opcode === 1) this.onText(frame.body.toString("utf8"));
    }
  }

  private next(): { opcode: number; body: Buffer } | null {
    const data = this.received;
    if (data.length < 6) return null;
    const short = data[1]! & 127;
    const sizeBytes = short === 127 ? 8 : short === 126 ? 2 : 0;
    if (data.length < 6 + sizeBytes) return null;
    const size = sizeBytes === 8 ? Number(data.readBigUInt64BE(2)) : sizeBytes === 2 ? data.readUInt16BE(2) : short;
    const start = 6 + sizeBytes;
    if (data.length < start + size) return null;
    const mask = data.subarray(start - 4, start);
    const body = Buffer.from(data.subarray(start, start + size)).map((byte, i) => byte ^ mask[i % 4]!);
    this.received = data.subarray(start + size);
    return { opcode: data[0]! & 15, body: Buffer.from(body) };
  }
}
