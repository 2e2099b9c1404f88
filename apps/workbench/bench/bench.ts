// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The workbench in a browser; `palmar serve` prints the address with its token.
import { Api, Job, JobKind, newKey, ServerState, ShelvedProduct } from "./api";
import { BenchState, firstState } from "./bench_state";
import { BenchStart, BenchView } from "./bench_view";
import { el, fill } from "./dom";
import { HandForm } from "./hand_form";
import { DesignJob, JobForm } from "./job_form";
import { JobView } from "./job_view";
import { keptHistory } from "./kept_steps";
import { BenchLanguage, benchLanguage, chooseLanguage, say, startLanguage } from "./say";
import { StartView } from "./start_view";

const kLeft = "palmar-bench";

/// What this tab had before it was loaded anew.
type Left = { token: string; state: BenchState; project: string } | { token: string; job: string };

class App {
  private readonly main = el("main");
  private readonly language: HTMLSelectElement = el("select", { class: "language", onchange: () => this.speak(this.language.value as BenchLanguage) });
  private view: { close(): void } | null = null;
  private again: () => void = () => this.start(); // what is seen, in another language
  private state: ServerState | null = null;
  private readonly api = new Api(new URLSearchParams(location.search).get("token") ?? "");

  async run(): Promise<void> {
    fill(document.body, this.main, this.language);
    fill(this.language, el("option", { value: "en" }, "English"), el("option", { value: "de" }, "Deutsch"));
    this.name();
    try {
      this.state = await this.api.state();
    } catch (error) {
      fill(this.main, el("div", { class: "start" }, el("h1", {}, say("title")), el("p", { class: "message", role: "alert" }, say("bench.failed", { message: String(error) }))));
      return;
    }
    if (await this.goOn()) return;
    if (this.state.given.length === 1) this.open(this.fresh(this.state.given[0]));
    else this.start();
  }

  private fresh(product: ShelvedProduct, person = ""): BenchStart {
    return { product, project: newKey(), state: person ? { ...firstState(product.key), holder: { person, left: false } } : null, history: null };
  }

  // What this tab showed when it was loaded anew; of this server alone, whose token it is.
  private async goOn(): Promise<boolean> {
    try {
      const left = JSON.parse(sessionStorage.getItem(kLeft) ?? "null") as Left | null;
      if (left?.token !== this.api.token) return false;
      if ("job" in left) {
        await this.api.job(left.job);
        this.openJob(left.job);
        return true;
      }
      const product = await this.api.product(left.state.product);
      if (!product) return false;
      const kept = await this.api.project(left.project).catch(() => null);
      this.open({ product, project: left.project, state: left.state, history: kept && keptHistory(kept.history, product.key) });
      return true;
    } catch {
      return false; // a browser that keeps nothing, or a job that is gone
    }
  }

  private keep(left: Left | null): void {
    try {
      if (left) sessionStorage.setItem(kLeft, JSON.stringify(left));
      else sessionStorage.removeItem(kLeft);
    } catch {
      // As above.
    }
  }

  private name(): void {
    document.title = say("title");
    this.language.value = benchLanguage();
    this.language.setAttribute("aria-label", say("bench.language"));
  }

  // An element without listeners of what stood there before.
  private freshRoot(view: "start" | "bench" | "form" | "job", again: () => void): HTMLElement {
    this.view?.close();
    this.view = null;
    this.again = again;
    document.body.dataset.view = view;
    const root = el("div", { class: "root" });
    fill(this.main, root);
    return root;
  }

  private start(): void {
    this.keep(null);
    new StartView(this.freshRoot("start", () => this.start()), this.api, this.state!, {
      open: (start) => this.open(start), newJob: (kind) => this.newJob(kind), openJob: (key) => this.openJob(key),
    });
  }

  private open(start: BenchStart): void {
    const root = this.freshRoot("bench", () => {});
    const view = new BenchView(root, this.api, start, () => this.start(), (state) => this.keep({ token: this.api.token, state, project: start.project }));
    this.view = view;
    this.again = () => this.open(view.current);
  }

  private newJob(kind: JobKind): void {
    this.keep(null);
    if (kind === "hand") new HandForm(this.freshRoot("form", () => this.newJob(kind)), this.api, () => this.start(), (job) => this.openJob(job.key));
    else this.newDesignJob(kind);
  }

  private newDesignJob(kind: DesignJob): void {
    new JobForm(this.freshRoot("form", () => this.newJob(kind)), this.api, this.state!, kind, this.state!.given, () => this.start(), (job) => this.openJob(job.key));
  }

  private openJob(key: string): void {
    this.keep({ token: this.api.token, job: key });
    this.view = new JobView(this.freshRoot("job", () => this.openJob(key)), this.api, key, () => this.start(), (product, hand) => this.open(this.fresh(product, hand)),
      (other) => this.openJob(other), (job) => void this.changeJob(job));
  }

  // The same product with other settings: a new one.
  private async changeJob(job: Job): Promise<void> {
    const product = await this.api.jobProduct(job.key).catch(() => null);
    const form = () => {
      this.keep(null);
      new JobForm(this.freshRoot("form", form), this.api, this.state!, job.kind as DesignJob, product ? [product] : [], () => this.openJob(job.key), (made) => this.openJob(made.key), job.request);
    };
    form();
  }

  private speak(language: BenchLanguage): void {
    chooseLanguage(language);
    this.name();
    if (this.state) this.again();
  }
}

startLanguage();
void new App().run();
