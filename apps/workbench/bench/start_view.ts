// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The first page: a file dropped or chosen, an example, or what `palmar serve FILE` was given.
import { decimal, say, TextKey } from "./say";
import { BenchState } from "./bench_state";
import { el, fill } from "./dom";
import { parseProject, projectEnding } from "./project";

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

interface UnitQuestion {
  file_name: string;
  units: { unit: string; sides_mm: [number, number, number] }[];
}

export function sidesText(sides: number[]): string {
  return sides.map((side) => decimal(side, side < 10 ? 1 : 0)).join(" × ");
}

/// Talks to the server with the page's token.
export class Api {
  constructor(readonly token: string) {}
  async ask(method: string, path: string, body?: Blob): Promise<{ status: number; json: unknown }> {
    const answer = await fetch(path, { method, body, headers: { Authorization: `Bearer ${this.token}` } });
    return { status: answer.status, json: await answer.json() };
  }
  /// A product that is still on the server's shelf.
  async product(key: string): Promise<ShelvedProduct | null> {
    const answer = await this.ask("GET", `/api/products/${encodeURIComponent(key)}`);
    return answer.status === 200 ? (answer.json as ShelvedProduct) : null;
  }
  async file(key: string): Promise<Uint8Array> {
    const answer = await fetch(`/api/products/${encodeURIComponent(key)}/file`, { headers: { Authorization: `Bearer ${this.token}` } });
    if (!answer.ok) throw new Error(`${answer.status}`);
    return new Uint8Array(await answer.arrayBuffer());
  }
  async state(): Promise<ServerState> {
    const answer = await this.ask("GET", "/api/state");
    if (answer.status !== 200) throw new Error((answer.json as { error: string }).error);
    return answer.json as ServerState;
  }
}

export class StartView {
  private readonly message = el("p", { class: "message", role: "status" });
  private readonly picker = el("input", { type: "file", class: "unseen", tabindex: -1, accept: ".stl,.obj,.ply,.3mf,.gltf,.glb,.step,.stp,.iges,.igs,.palmar-project",
    onchange: () => { if (this.picker.files?.[0]) void this.send(this.picker.files[0]); } });

  constructor(root: HTMLElement, private readonly api: Api, state: ServerState,
              private readonly open: (product: ShelvedProduct, state: BenchState | null) => void) {
    this.picker.setAttribute("aria-hidden", "true");
    const drop = el("div", { class: "drop" },
      el("p", {}, say("start.drop")),
      el("button", { class: "primary", type: "button", onclick: () => this.picker.click() }, say("start.choose")), this.picker);
    const over = (isOver: boolean) => (event: Event) => {
      event.preventDefault();
      drop.classList.toggle("is-over", isOver);
    };
    for (const name of ["dragenter", "dragover"]) root.addEventListener(name, over(true));
    root.addEventListener("dragleave", over(false));
    root.addEventListener("drop", (event) => {
      over(false)(event);
      const file = (event as DragEvent).dataTransfer?.files[0];
      if (file) void this.send(file);
    });
    const given = state.given.map((product) => el("li", {},
      el("button", { type: "button", class: "card", onclick: () => this.open(product, null) }, el("strong", {}, product.file_name))));
    const examples = state.examples.map((name) => el("li", {},
      el("button", { type: "button", class: "card", "data-example": name, onclick: () => void this.example(name) },
        shape(name), el("strong", {}, say(`example.${name}` as TextKey)))));
    fill(root, el("div", { class: "start" },
      el("h1", {}, say("start.heading")), el("p", { class: "lead" }, say("start.lead")), drop, this.message,
      given.length > 0 && [el("h2", {}, say("start.given")), el("ul", { class: "cards" }, given)],
      el("h2", {}, say("start.examples")), el("ul", { class: "cards" }, examples),
      el("p", { class: "soft" }, say("start.local"), ` Palmar ${state.version}`)));
  }

  private async send(file: File, unit = ""): Promise<void> {
    this.message.textContent = say("start.reading", { file: file.name });
    if (file.name.endsWith(projectEnding)) return this.reopen(file);
    try {
      const query = new URLSearchParams({ name: file.name, unit });
      const { status, json } = await this.api.ask("POST", `/api/products?${query.toString()}`, file);
      this.message.textContent = "";
      if (status === 200) this.open(json as ShelvedProduct, null);
      else if (status === 409) this.askUnit(file, json as UnitQuestion);
      else this.fail((json as { error: string }).error);
    } catch (error) {
      this.fail(String(error));
    }
  }

  // A project's product goes to the server as its file was, then the bench is as it was left.
  private async reopen(file: File): Promise<void> {
    try {
      const project = parseProject(await file.text());
      const query = new URLSearchParams({ name: project.fileName, unit: project.unit ?? "" });
      const { status, json } = await this.api.ask("POST", `/api/products?${query.toString()}`, new Blob([project.bytes]));
      if (status !== 200) throw new Error((json as { error: string }).error);
      const product = json as ShelvedProduct;
      this.open(product, { ...project.state, product: product.key });
    } catch (error) {
      this.fail(`${file.name}: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  private fail(message: string): void {
    this.message.textContent = say("bench.failed", { message });
  }

  private askUnit(file: File, question: UnitQuestion): void {
    const dialog = el("dialog", { "aria-label": say("unit.heading", { file: file.name }) });
    const choose = (unit: string) => () => {
      dialog.close();
      if (unit) void this.send(file, unit);
    };
    fill(dialog, el("h2", {}, say("unit.heading", { file: file.name })), el("p", {}, say("unit.lead")),
      el("ul", { class: "choices" }, question.units.map((one) => el("li", {},
        el("button", { type: "button", "data-unit": one.unit, onclick: choose(one.unit) },
          say("unit.choice", { unit: one.unit, sides: sidesText(one.sides_mm) }))))),
      el("button", { type: "button", class: "plain", onclick: choose("") }, say("unit.cancel")));
    dialog.addEventListener("close", () => dialog.remove());
    document.body.append(dialog);
    dialog.showModal();
  }

  private async example(name: string): Promise<void> {
    const { status, json } = await this.api.ask("POST", `/api/examples?name=${encodeURIComponent(name)}`);
    if (status === 200) this.open(json as ShelvedProduct, null);
    else this.fail((json as { error: string }).error);
  }
}

// A drawing of an example: its outline from the side.
function shape(name: string): SVGSVGElement {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 120 72");
  svg.setAttribute("aria-hidden", "true");
  const outline: Record<string, string> = {
    "round-handle": '<ellipse cx="24" cy="36" rx="7" ry="20"/><path d="M24 16H96M24 56H96"/><path d="M96 16a7 20 0 0 1 0 40"/>',
    "edged-handle": '<path d="M16 26l12-8H104l-12 8zM16 26V54H92V26M92 54l12-8V18"/>',
    ball: '<circle cx="60" cy="36" r="28"/><path d="M32 36q28 14 56 0" />',
  };
  svg.innerHTML = `<g fill="none" stroke="currentColor" stroke-width="2.5" stroke-linejoin="round">${outline[name] ?? ""}</g>`;
  return svg;
}
