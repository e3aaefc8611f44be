// SPDX-License-Identifier: Apache-2.0
import { Http } from "../net/http";
import type { ServerEvent, Session } from "../net/protocol";
import { Socket, type ConnectionState } from "../net/socket";
import type { Outbox } from "../tools/outbox";
import { Notices, StatusBar } from "../ui/status";
import { Saving } from "./saving";

export interface ServerServices {
  receive(event: ServerEvent): void;
  connection(state: ConnectionState): void;
  outbox(): Outbox;
  session(): Session | null;
}

/** The server, what is not saved there yet, and where the user is told of both. */
export class Server {
  readonly status = new StatusBar();
  readonly notices = new Notices();
  readonly http: Http;
  readonly socket: Socket;
  readonly saving: Saving;

  constructor(
    readonly token: string,
    services: ServerServices,
  ) {
    this.http = new Http(token);
    this.saving = new Saving({
      status: this.status,
      notices: this.notices,
      outbox: services.outbox,
      project: () => services.session()?.project_path,
      token,
    });
    this.socket = new Socket(token, {
      event: services.receive,
      connection: services.connection,
      unsaved: (count, acknowledged) => this.saving.countUnsaved(count, acknowledged),
      knock: () => this.http.knock(),
    });
  }

  readonly failed = (error: unknown): void => this.saving.failed(error);
}
