// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Talks to the server with the page's token.

import { CorrectionRow } from "./corrections";
import { Colours } from "./scene";

export interface ShelvedProduct {
  key: string;
  file_name: string;
  argument: string;
  unit: string | null;
  made_by: string;
  is_read: boolean;
  name?: string;
  triangles?: number;
  sides_mm?: [number, number, number];
  notes?: string[];
}

export interface ServerState {
  version: string;
  colours: Colours;
  examples: string[];
  given: ShelvedProduct[];
  largest_upload_bytes: number;
}

export interface UnitQuestion {
  file_name: string;
  units: { unit: string; sides_mm: [number, number, number] }[];
}

/// What was kept by itself.
export interface KeptProject {
  key: string;
  file_name: string;
  changed_ms: number;
  picture: string;
}

export interface OpenedProject {
  product: ShelvedProduct;
  state: unknown; // as stateMembers() of project.ts wrote it
  history: unknown;
}

export type JobKind = "study" | "compare" | "redesign" | "hand";
export type JobState = "estimating" | "new" | "waiting" | "running" | "stopped" | "failed" | "done";

export interface Job {
  key: string;
  kind: JobKind;
  title: string;
  created_ms: number;
  state: JobState;
  message: string;
  estimate_seconds: number | null;
  grasps: number;
  share: number;
  doing: string;
  commands: string[];
  product_files: string[];
  request: JobSettings;
  has_report: boolean;
  has_preview: boolean;
  has_hand: boolean;
  files: string[];
  made: string[]; // files of a preview, and of what was found of a hand
}

export type HandMethod = "file" | "quick" | "scan" | "photos" | "mri";

/// What a hand is made from (src/palmar/server/hand_request.h).
export interface HandSettings {
  method: HandMethod;
  uploads: string;
  name: string;
  side: string | null;
  unit: string | null;
  crease_colour: string | null;
  dot_colour: string | null;
  population: string | null;
  sheet: string | null;
  wrist_inside_mm: number;
  palm_up: boolean;
  sizes_mm: Record<string, number>;
  corrections: CorrectionRow[];
}

/// As it was asked for (src/palmar/server/job_request.h).
export interface JobSettings extends Partial<HandSettings> {
  kind: JobKind;
  products: string[];
  language?: string;
  verb?: string;
  hands?: number;
  populations?: string[];
  largest_depth_mm?: number | null;
  radius_mm?: [number, number];
  preview_mm?: number | null;
  vary?: string[];
}

/// A hand that was made here.
export interface OwnHand {
  key: string;
  name: string;
  created_ms: number;
}

export class Api {
  constructor(readonly token: string) {}

  async ask(method: string, path: string, body?: Blob | string): Promise<{ status: number; json: unknown }> {
    const answer = await fetch(path, { method, body, headers: { Authorization: `Bearer ${this.token}` } });
    return { status: answer.status, json: await answer.json() };
  }
  /// Throws the server's words for what went wrong.
  async get<T>(method: string, path: string, body?: Blob | string): Promise<T> {
    const { status, json } = await this.ask(method, path, body);
    if (status !== 200) throw new Error((json as { error: string }).error);
    return json as T;
  }
  state(): Promise<ServerState> { return this.get("GET", "/api/state"); }
  /// A product that is still on the server's shelf.
  async product(key: string): Promise<ShelvedProduct | null> {
    const answer = await this.ask("GET", `/api/products/${encodeURIComponent(key)}`);
    return answer.status === 200 ? (answer.json as ShelvedProduct) : null;
  }
  example(name: string): Promise<ShelvedProduct> { return this.get("POST", `/api/examples?name=${encodeURIComponent(name)}`); }
  async file(key: string): Promise<Uint8Array> {
    const answer = await fetch(`/api/products/${encodeURIComponent(key)}/file`, { headers: { Authorization: `Bearer ${this.token}` } });
    if (!answer.ok) throw new Error(`${answer.status}`);
    return new Uint8Array(await answer.arrayBuffer());
  }

  async projects(): Promise<KeptProject[]> { return (await this.get<{ projects: KeptProject[] }>("GET", "/api/projects")).projects; }
  project(key: string): Promise<OpenedProject> { return this.get("GET", `/api/projects/${encodeURIComponent(key)}`); }
  async keepProject(key: string, content: string): Promise<void> { await this.get("POST", `/api/projects/${encodeURIComponent(key)}`, content); }
  async removeProject(key: string): Promise<void> { await this.get("DELETE", `/api/projects/${encodeURIComponent(key)}`); }

  async jobs(): Promise<Job[]> { return (await this.get<{ jobs: Job[] }>("GET", "/api/jobs")).jobs; }
  job(key: string, act: "" | "/start" | "/cancel" = ""): Promise<Job> {
    return this.get(act ? "POST" : "GET", `/api/jobs/${encodeURIComponent(key)}${act}`);
  }
  addJob(request: object): Promise<Job> { return this.get("POST", "/api/jobs", JSON.stringify(request)); }
  /// A hand again, from the same files.
  reviseJob(key: string, request: object): Promise<Job> { return this.get("POST", `/api/jobs/${encodeURIComponent(key)}/revise`, JSON.stringify(request)); }
  async bytes(key: string, what: string): Promise<ArrayBuffer> {
    const answer = await fetch(`/api/jobs/${encodeURIComponent(key)}/${what}`, { headers: { Authorization: `Bearer ${this.token}` } });
    if (!answer.ok) throw new Error(((await answer.json()) as { error: string }).error);
    return answer.arrayBuffer();
  }
  async upload(key: string, name: string, file: Blob): Promise<void> {
    await this.get("POST", `/api/uploads/${encodeURIComponent(key)}?name=${encodeURIComponent(name)}`, file);
  }
  async hands(): Promise<OwnHand[]> { return (await this.get<{ hands: OwnHand[] }>("GET", "/api/hands")).hands; }
  /// A hand's file and what it is called.
  async handFile(key: string): Promise<{ fileName: string; bytes: Uint8Array }> {
    const answer = await fetch(`/api/hands/${encodeURIComponent(key)}/file`, { headers: { Authorization: `Bearer ${this.token}` } });
    if (!answer.ok) throw new Error(((await answer.json()) as { error: string }).error);
    const fileName = /filename="([^"]+)"/.exec(answer.headers.get("Content-Disposition") ?? "")?.[1] ?? "hand.hand.glb";
    return { fileName, bytes: new Uint8Array(await answer.arrayBuffer()) };
  }
  /// A hand's file on the server; its key once it was checked.
  async addHand(fileName: string, bytes: Uint8Array): Promise<string> {
    const uploads = newKey(), name = fileName.replace(/(\.hand)?\.glb$/, "").replace(/[^A-Za-z0-9_-]/g, "_").slice(0, 40);
    await this.upload(uploads, fileName, new Blob([bytes]));
    let job = await this.addJob({ kind: "hand", method: "file", uploads, name });
    while (job.state === "waiting" || job.state === "running") {
      await new Promise((done) => setTimeout(done, 200));
      job = await this.job(job.key);
    }
    if (job.state !== "done") throw new Error(job.message || job.state);
    return job.key;
  }
  async removeJob(key: string): Promise<void> { await this.get("DELETE", `/api/jobs/${encodeURIComponent(key)}`); }
  /// A shape that a redesign made, on the shelf.
  shape(key: string, name: string): Promise<ShelvedProduct> {
    return this.get("POST", `/api/jobs/${encodeURIComponent(key)}/shelve?name=${encodeURIComponent(name)}`);
  }
  /// The job's own copy of its product, on the shelf.
  jobProduct(key: string): Promise<ShelvedProduct> { return this.get("POST", `/api/jobs/${encodeURIComponent(key)}/shelve?product=1`); }
  dots<T>(key: string): Promise<T> { return this.get("GET", `/api/jobs/${encodeURIComponent(key)}/dots`); }
  /// An address that a frame or a link can open.
  address(key: string, what: string): string {
    return `/api/jobs/${encodeURIComponent(key)}/${what}?token=${encodeURIComponent(this.token)}`;
  }
}

/// A name for something new: letters and digits, by chance.
export function newKey(): string {
  return [...crypto.getRandomValues(new Uint8Array(12))].map((one) => one.toString(16).padStart(2, "0")).join("");
}
