// SPDX-License-Identifier: Apache-2.0
// A slow line to an archive: what a server on this machine answers, a piece at a time.
import { connect, createServer, type AddressInfo, type Server, type Socket } from "node:net";

const PIECE_BYTES = 16_384;
const PAUSE_MS = 50;

export class SlowLink {
  private readonly sockets = new Set<Socket>();
  private server: Server | undefined;
  isSlow = false;

  /** The address by which the service at `address` is reached over this line. */
  to(address: string): Promise<string> {
    const { port, pathname } = new URL(address);
    const server = (this.server = createServer((near) => this.join(near, connect(Number(port), "127.0.0.1"))));
    return new Promise((resolve) => server.listen(0, "127.0.0.1", () => resolve(`http://127.0.0.1:${(server.address() as AddressInfo).port}${pathname}`)));
  }

  close(): void {
    this.server?.close();
    for (const socket of this.sockets) socket.destroy();
  }

  private join(near: Socket, far: Socket): void {
    for (const [socket, other] of [
      [near, far],
      [far, near],
    ] as const) {
      this.sockets.add(socket);
      socket.on("error", () => other.destroy());
      socket.on("close", () => void this.sockets.delete(socket));
    }
    near.pipe(far);
    void this.carry(far, near);
  }

  private async carry(far: Socket, near: Socket): Promise<void> {
    try {
      for await (const bytes of far as AsyncIterable<Buffer>) {
        for (let at = 0; at < bytes.length; at += PIECE_BYTES) {
          near.write(bytes.subarray(at, at + PIECE_BYTES));
          if (this.isSlow) await new Promise((resolve) => setTimeout(resolve, PAUSE_MS));
        }
      }
    } catch {
      // whoever waits sees the end
    }
    near.end();
  }
}
