// SPDX-License-Identifier: Apache-2.0
import { BinaryReply } from "./binary";
import { Link } from "./link";
import type { CodedMesh } from "./mesh_code";
import type {
  ArchivedRequest,
  ArchivedSeries,
  ArchivedStudies,
  ArrivingHeader,
  Comparison,
  Folder,
  ImportReply,
  NearDrawing,
  OpenRequest,
  SavedArrangement,
  SendRequest,
  SentReply,
  SliceHeader,
  SliceRequest,
  Statistics,
  Volume,
  WaitingReply,
} from "./protocol";

export interface FileChoices {
  /** So many are in the file, and one has to be named. */
  frames?: number;
  /** Of two ways in which a NIfTI file says where it lies one has to be named. */
  transforms?: boolean;
  /** The slices of a series can be resampled. */
  uneven?: boolean;
}

/**
 * An answer that the server gave, or that it gave none; `message` is a sentence for the user. Of calls over the socket two more
 * kinds: "offline" was not sent, "lost" was, but the connection ended before the reply came. "gone" is what has been
 * closed or removed meanwhile: an event tells of it, so users need not be told where they did not ask for it themselves.
 */
export class ServerError extends Error {
  constructor(
    readonly kind: string,
    message: string,
    /** Whether the call would have changed the project. */
    readonly edits = false,
    /** What has to be chosen before the file can be read. */
    readonly choices: FileChoices = {},
  ) {
    super(message);
  }
}

export interface MeshHeader extends CodedMesh {
  structure: number;
  revision: number;
  stage: string;
  half_width_step_mm: number;
  distance_step_mm: number;
}

export interface MeshExtras {
  widths?: boolean;
  origins?: boolean;
  farFrom?: number | undefined;
  /** Of the image; the one that was opened where none is given. */
  time?: number | undefined;
}

/** Requests for bulk data below `/api/`. One that is aborted costs the server nothing more. */
export class Http {
  /** Names this load of the page: a later slice overtakes an earlier one of the same view of the same page only. */
  private readonly page = [...crypto.getRandomValues(new Uint8Array(16))].map((byte) => byte.toString(16).padStart(2, "0")).join("");

  private readonly link = new Link();

  /** The session that the page shows: requests for another one are refused. */
  opening: string | null = null;

  /** Of the image the volume that is seen: what moves is measured and exported there. Null: the one that was opened. */
  time: number | null = null;

  constructor(private readonly token: string) {}

  async folder(path: string, signal: AbortSignal): Promise<Folder> {
    return (await (await this.request(`folder?${new URLSearchParams({ path })}`, { signal })).json()) as Folder;
  }

  /** The volumes of the DICOM files in a folder, or below it. */
  async volumes(path: string, signal: AbortSignal): Promise<Volume[]> {
    const reply = await this.request(`series?${new URLSearchParams({ path })}`, { signal });
    return ((await reply.json()) as { volumes: Volume[] }).volumes;
  }

  /** A small grey picture of one slice. */
  async thumbnail(file: string, frame: number, signal: AbortSignal): Promise<BinaryReply<{ width: number; height: number }>> {
    const reply = await this.request(`thumbnail?${new URLSearchParams({ file, frame: String(frame) })}`, { signal });
    return new BinaryReply(await reply.arrayBuffer());
  }

  /** Of the middle slice of a file's frame, from 0. */
  async frameThumbnail(file: string, frame: number): Promise<BinaryReply<{ width: number; height: number }>> {
    const reply = await this.request(`thumbnail?${new URLSearchParams({ file, frame: String(frame + 1), volume: "1" })}`);
    return new BinaryReply(await reply.arrayBuffer());
  }

  /** Begins to read; events tell the rest. */
  async open(request: OpenRequest): Promise<void> {
    await this.post("open", JSON.stringify(request));
  }

  /** Of the archive that the command named; `filter`: name, id, date, modality. */
  async archivedStudies(filter: Record<string, string>, signal: AbortSignal): Promise<ArchivedStudies> {
    return (await (await this.request(`archive/studies?${new URLSearchParams(filter)}`, { signal })).json()) as ArchivedStudies;
  }

  async archivedSeries(study: string, signal: AbortSignal): Promise<ArchivedSeries[]> {
    const reply = await this.request(`archive/series?${new URLSearchParams({ study })}`, { signal });
    return ((await reply.json()) as { series: ArchivedSeries[] }).series;
  }

  /** A JPEG of the middle slice of a series. */
  async archivedPicture(study: string, series: string, signal: AbortSignal): Promise<Blob> {
    return (await this.request(`archive/picture?${new URLSearchParams({ study, series })}`, { signal })).blob();
  }

  /** Begins to fetch and to read; events tell the rest. */
  async openArchived(request: ArchivedRequest): Promise<void> {
    await this.post("archive/open", JSON.stringify(request));
  }

  /** Of the series that is being fetched the slice nearest to a place, or the one that came last. */
  async arriving(at: number | null, signal: AbortSignal): Promise<BinaryReply<ArrivingHeader>> {
    const query = new URLSearchParams(at === null ? {} : { at_mm: String(at) });
    return new BinaryReply(await (await this.request(`archive/arriving?${query}`, { signal })).arrayBuffer());
  }

  /** Sends an export to the archive that the image came from; `again`: what did not arrive last time. */
  async send(name: SendRequest["name"], again: boolean, signal: AbortSignal): Promise<SentReply> {
    return (await (await this.request("archive/send", { method: "POST", body: JSON.stringify({ name, again }), signal })).json()) as SentReply;
  }

  /** Exports that did not arrive in the archive that the image came from; they are sent again as they were. */
  async waitingForArchive(): Promise<SendRequest["name"][]> {
    return ((await (await this.request("archive/waiting", {})).json()) as WaitingReply).names as SendRequest["name"][];
  }

  /** Gives up what is being read. */
  async cancelOpening(): Promise<void> {
    await this.post("cancel", "");
  }

  /** Goes back to the start page, in all pages. */
  async close(): Promise<void> {
    await this.post("close", "");
  }

  /** How the page is arranged, for later images of the modality. */
  async keepArrangement(modality: string, state: SavedArrangement): Promise<void> {
    await this.post("arrangement", JSON.stringify({ modality, state }));
  }

  /** Shows an image over the project's own; settles when it is there. */
  async putImage(request: OpenRequest, signal: AbortSignal): Promise<void> {
    await this.request("image", { method: "POST", body: JSON.stringify({ image: 1, ...request }), signal });
  }

  async slice(request: SliceRequest, signal?: AbortSignal): Promise<BinaryReply<SliceHeader>> {
    const body = JSON.stringify({ page: this.page, ...request, ...(this.link.isSlow && { compressed: true }) });
    return new BinaryReply(await this.timed(await this.request("slice", { method: "POST", body, signal: signal ?? null })));
  }

  /** Where that is wanted with how sure it is at its points, who made it there, and how far they are from the surface of another structure. */
  async mesh(structure: number, extras: MeshExtras = {}): Promise<BinaryReply<MeshHeader>> {
    const query = new URLSearchParams({ coded: "1" });
    if (extras.time !== undefined) query.set("time", String(extras.time));
    if (extras.widths) query.set("widths", "1");
    if (extras.origins) query.set("origins", "1");
    if (extras.farFrom !== undefined) query.set("far_from", String(extras.farFrom));
    if (this.link.isSlow) query.set("compressed", "1");
    return new BinaryReply(await this.timed(await this.request(`mesh/${structure}?${query}`)));
  }

  private atTime(): { time?: string } {
    return this.time === null ? {} : { time: String(this.time) };
  }

  /** The bytes of a reply. */
  private async timed(reply: Response): Promise<ArrayBuffer> {
    const began = performance.now();
    const bytes = await reply.arrayBuffer();
    this.link.took(Number(reply.headers.get("Content-Length")), performance.now() - began);
    return bytes;
  }

  /** The file and the name that the server proposes for it. */
  async export(name: string, structure: number | null, signal?: AbortSignal): Promise<{ blob: Blob; name: string }> {
    const query = new URLSearchParams({ ...(structure !== null && { structure: String(structure) }), ...this.atTime() });
    const path = `export/${name}` + (query.size > 0 ? `?${query}` : "");
    const reply = await this.request(path, { signal: signal ?? null }, "The structure has been removed meanwhile: there is nothing to export.");
    const proposed = /filename="([^"]+)"/.exec(reply.headers.get("Content-Disposition") ?? "");
    return { blob: await reply.blob(), name: proposed?.[1] ?? name };
  }

  async statistics(signal: AbortSignal): Promise<Statistics> {
    return (await (await this.request(`statistics?${new URLSearchParams(this.atTime())}`, { signal })).json()) as Statistics;
  }

  async compare(first: number, second: number, signal: AbortSignal): Promise<Comparison> {
    const gone = "One of the two has been removed meanwhile: they cannot be compared.";
    return (await (
      await this.request(`compare?${new URLSearchParams({ first: String(first), second: String(second), ...this.atTime() })}`, { signal }, gone)
    ).json()) as Comparison;
  }

  async import(what: "contours" | "mask", file: File, options: Record<string, string> = {}, signal?: AbortSignal): Promise<ImportReply> {
    const query = new URLSearchParams({ name: file.name, ...options });
    const reply = await this.request(`import/${what}?${query}`, { method: "POST", body: file, signal: signal ?? null });
    return (await reply.json()) as ImportReply;
  }

  /** What others have drawn on the image, in files near it. */
  async drawings(signal: AbortSignal): Promise<NearDrawing[]> {
    return ((await (await this.request("drawings", { signal })).json()) as { drawings: NearDrawing[] }).drawings;
  }

  async importNear(file: string, options: Record<string, string> = {}, signal?: AbortSignal): Promise<ImportReply> {
    const query = new URLSearchParams({ file, ...options });
    return (await (await this.request(`import/near?${query}`, { method: "POST", signal: signal ?? null })).json()) as ImportReply;
  }

  /** Settles when the server answers: for a file of the page it needs neither the project nor much time. */
  async knock(): Promise<void> {
    await fetch("/icon.svg", { cache: "no-store" });
  }

  private post(path: string, body: BodyInit): Promise<Response> {
    return this.request(path, { method: "POST", body });
  }

  /** `gone`: what is said where the server has no more of what is asked for. */
  private async request(path: string, options: RequestInit = {}, gone = "The image was closed."): Promise<Response> {
    const headers: Record<string, string> = { Authorization: `Bearer ${this.token}` };
    if (this.opening !== null) headers["Kontur-Opening"] = this.opening;
    let reply: Response;
    try {
      reply = await fetch(`/api/${path}`, { ...options, headers });
    } catch {
      if (options.signal?.aborted) throw new ServerError("cancelled", "Cancelled.");
      throw new ServerError("io", "kontur does not answer.");
    }
    if (!reply.ok) throw await errorOf(reply);
    if (reply.status === 204) throw new ServerError("gone", gone);
    return reply;
  }
}

async function errorOf(reply: Response): Promise<ServerError> {
  try {
    const { error } = (await reply.json()) as { error: { kind: string; message: string } & FileChoices };
    return new ServerError(error.kind, error.message, false, error);
  } catch {
    return new ServerError("io", `kontur answered with status ${reply.status}.`);
  }
}
