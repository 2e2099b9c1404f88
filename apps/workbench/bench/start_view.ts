// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The first page: a file dropped or chosen, an example, what `palmar serve FILE` was given, what was
// done before.
import { Api, Job, JobKind, KeptProject, newKey, ServerState, ShelvedProduct } from "./api";
import { BenchStart } from "./bench_view";
import { el, fill } from "./dom";
import { FilePicker } from "./file_picker";
import { jobStateWords } from "./job_words";
import { keptHistory } from "./kept_steps";
import { parseProject, parseState } from "./project";
import { dateText, say, TextKey } from "./say";

const kShownAtFirst = 6; // of recent projects

export interface StartEvents {
  open(start: BenchStart): void;
  newJob(kind: JobKind): void;
  openJob(key: string): void;
}

export class StartView {
  private readonly message = el("p", { class: "message", role: "status" });
  private readonly recent = el("div", { class: "recent" });
  private readonly jobs = el("div", { class: "recent" });

  constructor(root: HTMLElement, private readonly api: Api, state: ServerState, private readonly events: StartEvents) {
    // All at once: nothing moves away under the pointer when more of it comes.
    void Promise.all([this.showRecent(false), this.showJobs()]).then(() => this.show(root, state));
  }

  private show(root: HTMLElement, state: ServerState): void {
    const { api, events } = this;
    const picker = new FilePicker(api, (text) => { this.message.textContent = text; }, (product) => this.fresh(product), (file) => void this.reopen(file));
    const drop = el("div", { class: "drop" },
      el("p", {}, say("start.drop")),
      el("button", { class: "primary", type: "button", onclick: () => picker.choose() }, say("start.choose")), picker.input);
    picker.takeDrops(root, drop);
    const given = state.given.map((product) => el("li", {},
      el("button", { type: "button", class: "card", onclick: () => this.fresh(product) }, el("strong", {}, product.file_name))));
    const examples = state.examples.map((name) => el("li", {},
      el("button", { type: "button", class: "card", "data-example": name, onclick: () => void this.example(name) },
        shape(name), el("strong", {}, say(`example.${name}` as TextKey)))));
    const task = (kind: JobKind) => el("li", {}, el("button", { type: "button", class: "card task", "data-new": kind, onclick: () => events.newJob(kind) },
      el("strong", {}, say(`job.new.${kind}`)), el("span", { class: "soft" }, say(`job.about.${kind}`))));
    fill(root, el("div", { class: "start" },
      el("h1", {}, say("start.heading")), el("p", { class: "lead" }, say("start.lead")), drop, this.message,
      given.length > 0 && [el("h2", {}, say("start.given")), el("ul", { class: "cards" }, given)],
      this.recent, this.jobs,
      el("h2", {}, say("start.examples")), el("ul", { class: "cards" }, examples),
      el("h2", {}, say("start.more")), el("ul", { class: "cards" }, task("study"), task("compare"), task("redesign"), task("hand")),
      el("p", { class: "soft" }, say("start.local"), ` Palmar ${state.version}`)));
  }

  private fresh(product: ShelvedProduct): void {
    this.events.open({ product, project: newKey(), state: null, history: null });
  }

  private async showRecent(all: boolean): Promise<void> {
    let projects: KeptProject[];
    try {
      projects = await this.api.projects();
    } catch {
      return; // a server that keeps nothing
    }
    if (projects.length === 0) return fill(this.recent);
    const shown = all ? projects : projects.slice(0, kShownAtFirst);
    const card = (project: KeptProject) => el("li", { class: "removable" },
      el("button", { type: "button", class: "card project", "data-recent": project.key, onclick: () => void this.openKept(project) },
        project.picture.startsWith("data:image/") ? el("img", { src: project.picture, alt: "", width: 144, height: 92 }) : el("span", { class: "no-picture" }),
        el("strong", {}, project.file_name), el("span", { class: "soft" }, dateText(project.changed_ms))),
      el("button", { type: "button", class: "remove", title: say("start.remove", { file: project.file_name }), "aria-label": say("start.remove", { file: project.file_name }),
        onclick: () => void this.remove(project) }, "×"));
    fill(this.recent, el("h2", {}, say("start.recent")), el("ul", { class: "cards" }, shown.map(card)),
      projects.length > shown.length && el("button", { type: "button", class: "more", onclick: () => void this.showRecent(true) }, say("start.all", { count: projects.length })));
  }

  private async openKept(project: KeptProject): Promise<void> {
    try {
      const { product, state, history } = await this.api.project(project.key);
      this.events.open({ product, project: project.key, state: { ...parseState(state as Record<string, unknown>), product: product.key }, history: keptHistory(history, product.key) });
    } catch (error) {
      this.fail(`${project.file_name}: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  private async remove(project: KeptProject): Promise<void> {
    if (!confirm(say("start.remove_asked", { file: project.file_name }))) return;
    try {
      await this.api.removeProject(project.key);
    } catch (error) {
      this.fail(String(error));
    }
    await this.showRecent(true);
  }

  private async showJobs(): Promise<void> {
    let jobs: Job[];
    try {
      jobs = await this.api.jobs();
    } catch {
      return;
    }
    if (jobs.length === 0) return;
    fill(this.jobs, el("h2", {}, say("start.jobs")), el("ul", { class: "rows" }, jobs.map((job) => el("li", {},
      el("button", { type: "button", class: "row", "data-job": job.key, onclick: () => this.events.openJob(job.key) },
        el("span", { class: "soft" }, say(`job.kind.${job.kind}`)), el("strong", {}, job.title), el("span", { class: `state ${job.state}` }, jobStateWords(job)),
        el("span", { class: "soft" }, dateText(job.created_ms)))))));
  }

  // A project's product goes to the server as its file was, then the bench is as it was left.
  private async reopen(file: File): Promise<void> {
    try {
      const project = parseProject(await file.text());
      const query = new URLSearchParams({ name: project.fileName, unit: project.unit ?? "" });
      const product = await this.api.get<ShelvedProduct>("POST", `/api/products?${query.toString()}`, new Blob([project.bytes]));
      const own = project.hand ? `hand:${await this.api.addHand(project.hand.fileName, project.hand.bytes)}` : null;
      const holder = own ? { ...project.state.holder, person: own } : project.state.holder;
      this.events.open({ product, project: newKey(), state: { ...project.state, holder, product: product.key }, history: null });
    } catch (error) {
      this.fail(`${file.name}: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  private fail(message: string): void {
    this.message.textContent = say("bench.failed", { message });
  }

  private async example(name: string): Promise<void> {
    try {
      this.fresh(await this.api.example(name));
    } catch (error) {
      this.fail(String(error));
    }
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
