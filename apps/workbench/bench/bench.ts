// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The workbench in a browser; `palmar serve` prints the address with its token.
import { BenchState } from "./bench_state";
import { BenchView } from "./bench_view";
import { el, fill } from "./dom";
import { BenchLanguage, benchLanguage, chooseLanguage, say, startLanguage } from "./say";
import { Api, ServerState, ShelvedProduct, StartView } from "./start_view";

const kLeft = "palmar-bench";

class App {
  private readonly main = el("main");
  private readonly language: HTMLSelectElement = el("select", { class: "language", onchange: () => this.speak(this.language.value as BenchLanguage) });
  private view: BenchView | null = null;
  private product: ShelvedProduct | null = null;
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
    const before = await this.leftBefore();
    if (before) this.open(before.product, before.state);
    else if (this.state.given.length === 1) this.open(this.state.given[0], null);
    else this.start();
  }

  // What this tab had on the bench when it was loaded anew; of this server alone, whose token it is.
  private async leftBefore(): Promise<{ product: ShelvedProduct; state: BenchState } | null> {
    try {
      const left = JSON.parse(sessionStorage.getItem(kLeft) ?? "null") as { token: string; state: BenchState } | null;
      const product = left?.token === this.api.token ? await this.api.product(left.state.product) : null;
      return left && product ? { product, state: left.state } : null;
    } catch {
      return null; // a browser that keeps nothing
    }
  }

  private keep(state: BenchState | null): void {
    try {
      if (state) sessionStorage.setItem(kLeft, JSON.stringify({ token: this.api.token, state }));
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

  private start(): void {
    this.view?.close();
    this.view = null;
    this.product = null;
    this.keep(null);
    document.body.dataset.view = "start";
    new StartView(this.freshRoot(), this.api, this.state!, (product, state) => this.open(product, state));
  }

  // An element without listeners of what stood there before.
  private freshRoot(): HTMLElement {
    const root = el("div", { class: "root" });
    fill(this.main, root);
    return root;
  }

  private open(product: ShelvedProduct, state: BenchState | null): void {
    this.view?.close();
    this.product = product;
    document.body.dataset.view = "bench";
    this.view = new BenchView(this.freshRoot(), this.api, product, state, () => this.start(), (now) => this.keep(now));
  }

  private speak(language: BenchLanguage): void {
    chooseLanguage(language);
    this.name();
    if (this.view && this.product) this.open(this.product, this.view.current);
    else if (this.state) this.start();
  }
}

startLanguage();
void new App().run();
