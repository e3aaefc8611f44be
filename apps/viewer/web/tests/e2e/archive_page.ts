// SPDX-License-Identifier: Apache-2.0
// `kontur open --archive` with an archive of its own, for all tests of a file.
import { join } from "node:path";
import { after, before } from "node:test";
import type { Browser } from "playwright-core";
import { launch } from "./browsers";
import { Orthanc } from "./orthanc";
import { cleanUp, Server, temporaryFolder } from "./support";

interface Choice {
  /** The archive has a whole patient (Orthanc.makePatient). */
  patient?: boolean;
  /** By which address the program reaches the archive; the archive's own where left out. */
  reached?(address: string): Promise<string>;
}

export class ArchivePage {
  readonly folder = temporaryFolder();
  readonly archive = new Orthanc(join(this.folder.path, "orthanc"));
  /** Of the archive; "" where Orthanc is not installed, and then there is neither a server nor a browser. */
  address = "";
  server!: Server;
  browser!: Browser;

  constructor(private readonly choice: Choice = {}) {
    before(async () => {
      if (choice.patient) this.archive.makePatient();
      this.address = await this.archive.serve();
      if (this.address === "") return;
      this.browser = await launch();
      await this.start();
    });
    after(() => {
      this.archive.end();
    });
    cleanUp(this.folder, () => [this.browser, this.server]);
  }

  /** Starts the program, another time where it has ended. */
  async start(): Promise<void> {
    const { path } = this.folder;
    const address = (await this.choice.reached?.(this.address)) ?? this.address;
    this.server = await Server.startAt({ HOME: path, XDG_CACHE_HOME: join(path, "cache") }, path, "--archive", address);
  }
}
