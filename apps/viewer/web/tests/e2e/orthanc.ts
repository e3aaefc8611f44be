// SPDX-License-Identifier: Apache-2.0
// Debian's Orthanc with its DICOMweb plugin, for tests of the page.
import assert from "node:assert/strict";
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { mkdirSync } from "node:fs";
import { dirname, join } from "node:path";
import { createInterface } from "node:readline";

const python = process.env["KONTUR_TEST_PYTHON"];
const series = process.env["KONTUR_DICOM_SERIES"];
const script = (name: string) => join(dirname(series!), "..", "archive", name);

/** One archive, with its files in a folder. */
export class Orthanc {
  private child: ChildProcess | undefined;

  constructor(private readonly folder: string) {
    mkdirSync(folder);
  }

  /** Fills the folder with a patient before the first `serve`. */
  makePatient(): void {
    if (!python || !series) return;
    assert.equal(spawnSync(python, [script("make_patient.py"), this.folder], { stdio: "inherit" }).status, 0);
  }

  /** Its address; "" where Orthanc is not installed. With a port the archive of before comes back. */
  serve(...port: string[]): Promise<string> {
    if (!python || !series) return Promise.resolve("");
    const child = (this.child = spawn(python, [script("serve.py"), this.folder, ...port], { stdio: ["pipe", "pipe", "inherit"] }));
    return new Promise((resolve, reject) => {
      createInterface(child.stdout).once("line", resolve);
      child.once("exit", (code) => (code === 77 ? resolve("") : reject(new Error(`the archive ended: ${code}`))));
    });
  }

  /** Asks it to end. */
  end(): void {
    this.child?.stdin?.end();
  }

  /** Until it has ended. */
  async ended(): Promise<void> {
    this.end();
    await new Promise((resolve) => this.child!.once("exit", resolve));
  }
}
