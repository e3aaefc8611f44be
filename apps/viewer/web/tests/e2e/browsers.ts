// SPDX-License-Identifier: Apache-2.0
// The browsers of Debian that the tests drive: Chromium, or Firefox ESR where KONTUR_BROWSER is "firefox".
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdtempSync, readdirSync, readFileSync, rmSync, statSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import type { Readable } from "node:stream";
import { setTimeout as sleep } from "node:timers/promises";
import { chromium, firefox, type Browser, type Page } from "playwright-core";

export const BROWSER = process.env["KONTUR_BROWSER"] ?? "chromium";
/** Long, because other programs may keep the machine busy, and sanitizers the program; every wait is for a state. */
export const PATIENCE_MS = process.env["KONTUR_SANITIZED"] ? 240_000 : 60_000;

/** Of a test: runs only in Chromium, and why. */
export const onlyChromium = (why: string) => ({ skip: BROWSER === "chromium" ? false : why });

export interface Wish {
  webgl: boolean;
  /** What the system asks of all pages. Of Firefox alone: Playwright emulates media in Chromium only. */
  scheme?: "dark" | "light";
}
export const EMULATES_MEDIA = onlyChromium("Playwright does not emulate media in Firefox");
export const NO_WEBGL: Wish = { webgl: false };

export function launch(wish: Wish = { webgl: true }): Promise<Browser> {
  return BROWSER === "firefox" ? launchFirefox(wish) : launchChromium(wish);
}

/** As Chromium does where there is no graphics processor: WebGL in software, and the page itself without it. */
function launchChromium({ webgl }: Wish): Promise<Browser> {
  const args = webgl ? ["--enable-unsafe-swiftshader"] : ["--disable-gpu", "--disable-software-rasterizer"];
  return chromium.launch({ executablePath: process.env["KONTUR_CHROMIUM"] ?? "/usr/bin/chromium-headless-shell", args });
}

/** As it is, by WebDriver BiDi. Without a window Firefox has no WebGL, so it gets a screen of its own. */
async function launchFirefox({ webgl, scheme }: Wish): Promise<Browser> {
  const folder = mkdtempSync(join(tmpdir(), "kontur-downloads-"));
  const browser = await firefox.launch({
    channel: "moz-firefox",
    executablePath: process.env["KONTUR_FIREFOX"] ?? "/usr/bin/firefox-esr",
    headless: false,
    firefoxUserPrefs: {
      "webgl.disabled": !webgl,
      "layout.css.prefers-color-scheme.content-override": scheme ? ["dark", "light"].indexOf(scheme) : 2, // 2: the system's
      "browser.download.folderList": 2,
      "browser.download.dir": folder,
      "browser.download.alwaysOpenPanel": false, // which would take the keyboard from the page
    },
    env: { ...process.env, DISPLAY: await virtualScreen() },
  });
  browser.once("disconnected", () => rmSync(folder, { recursive: true }));
  downloads.set(browser, folder);
  return browser;
}

/** An X server without a screen, on the first display that is free; it ends a while after its last window. */
async function virtualScreen(): Promise<string> {
  const words = ["-displayfd", "3", "-screen", "0", "1920x1200x24", "-nolisten", "tcp", "-terminate", "10"];
  const server = spawn("/usr/bin/Xvfb", words, { stdio: ["ignore", "ignore", "inherit", "pipe"] });
  const [number] = (await once(server.stdio[3] as Readable, "data")) as [Buffer];
  server.unref();
  return `:${number.toString().trim()}`;
}

/** Where each Firefox puts what it downloads. */
const downloads = new WeakMap<Browser, string>();

interface File {
  name: string;
  bytes: Buffer;
}

/** What the browser downloads when `act` has been done. Playwright hears of it from Chromium only. */
export async function downloaded(page: Page, act: () => Promise<void>): Promise<File> {
  const folder = downloads.get(page.context().browser()!);
  if (folder !== undefined) {
    await act();
    return takeFrom(folder);
  }
  const download = page.waitForEvent("download");
  await act();
  const file = await download;
  return { name: file.suggestedFilename(), bytes: readFileSync(await file.path()) };
}

/** Takes the one file out of the folder, once it is whole: until then it is empty, or just being renamed, and its bytes are in a .part beside it. */
async function takeFrom(folder: string): Promise<File> {
  for (const end = Date.now() + PATIENCE_MS; Date.now() < end; await sleep(50)) {
    const names = readdirSync(folder);
    const path = join(folder, names[0] ?? "");
    const size = names.length === 1 && !path.endsWith(".part") ? statSync(path, { throwIfNoEntry: false })?.size : 0;
    if (size !== undefined && size > 0) {
      const bytes = readFileSync(path);
      rmSync(path);
      return { name: names[0]!, bytes };
    }
  }
  throw new Error(`nothing was downloaded in ${PATIENCE_MS} ms`);
}
