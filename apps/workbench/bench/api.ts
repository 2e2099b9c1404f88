// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Talks to the server with the page's token.

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

export type JobKind = "study" | "compare" | "redesign";
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
  request: { products: string[]; verb?: string; hands?: number };
  has_report: boolean;
  files: string[];
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
  async removeJob(key: string): Promise<void> { await this.get("DELETE", `/api/jobs/${encodeURIComponent(key)}`); }
  /// A shape that a redesign made, on the shelf.
  shape(key: string, name: string): Promise<ShelvedProduct> {
    return this.get("POST", `/api/jobs/${encodeURIComponent(key)}/shelve?name=${encodeURIComponent(name)}`);
  }
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
