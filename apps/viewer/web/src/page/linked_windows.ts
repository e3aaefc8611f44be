// SPDX-License-Identifier: Apache-2.0
import type { Navigation, SharedPlace } from "../model/navigation";

const CHANNEL = "kontur"; // pages of one server have an origin of their own
const SECOND = "kontur-second";
const LINKED = "kontur-linked";

interface Message {
  project: string;
  place: SharedPlace;
}

/** A second window of the project, for another screen: both look at the same place, each with a layout and a zoom of its own. */
export class LinkedWindows {
  /** This is the second one: what is kept for the next visit is the first one's. */
  readonly isSecond = window.name.startsWith(SECOND);
  private channel: BroadcastChannel | null = null;
  private project: string | null = null;
  private isFollowing = false;

  constructor(private readonly navigation: Navigation) {
    navigation.on(["planes", "window", "time"], () => this.tell());
  }

  start(project: string): void {
    this.project = project;
    if (this.isSecond || sessionStorage.getItem(LINKED)) this.join(); // also after a reload
  }

  /** False where the browser lets the page open no window. */
  open(token: string): boolean {
    sessionStorage.setItem(LINKED, "yes");
    this.join();
    const { availWidth, availHeight } = window.screen;
    return window.open(`/#${token}`, SECOND, `popup,width=${Math.round(0.8 * availWidth)},height=${Math.round(0.8 * availHeight)}`) !== null;
  }

  private join(): void {
    if (this.channel) return;
    this.channel = new BroadcastChannel(CHANNEL);
    this.channel.addEventListener("message", ({ data }: MessageEvent<Message>) => this.follow(data));
  }

  private tell(): void {
    if (!this.channel || this.isFollowing || this.project === null) return;
    const message: Message = { project: this.project, place: this.navigation.place() };
    this.channel.postMessage(message);
  }

  private follow({ project, place }: Message): void {
    if (project !== this.project) return;
    this.isFollowing = true; // and does not tell in turn
    this.navigation.follow(place);
    this.isFollowing = false;
  }
}
