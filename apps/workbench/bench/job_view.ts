// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A study, comparison, redesign or person's hand: how far it is, what can be done with it, what it gave
// to look at, and its report.
import { Api, HandSettings, Job, ShelvedProduct } from "./api";
import { BonesView } from "./bones_view";
import { DotsChart } from "./dots_chart";
import { el, fill } from "./dom";
import { jobSentence, jobStateWords } from "./job_words";
import { MarksView } from "./marks_view";
import { proposalsList } from "./proposals";
import { QuickView } from "./quick_view";
import { say } from "./say";
import { ShapeView } from "./shape_view";

interface Looked {
  element: HTMLElement;
  load(): Promise<void>;
  close(): void;
}

const kBetweenLooks = 400; // ms

export class JobView {
  private job: Job | null = null;
  private timer = 0;
  private isClosed = false;
  private shownReport: string | null = null;
  private looked: Looked | null = null; // in place of the report
  private readonly els = {
    title: el("div", { class: "title" }),
    badge: el("span"),
    state: el("p", { class: "status", role: "status" }),
    bar: el("progress", { max: 1, value: 0, "aria-label": say("job.progress") }),
    buttons: el("div", { class: "buttons" }),
    lost: el("p", { class: "lost", role: "alert", hidden: true }, say("bench.lost")),
    commands: el("div", { class: "command" }),
    files: el("ul", { class: "files" }),
    filesPart: el("details", { class: "part", hidden: true }),
    dots: el("div", { class: "dots" }),
    tabs: el("div", { class: "tabs", role: "group", hidden: true }),
    report: el("div", { class: "report" }),
  };
  private readonly section: HTMLElement;

  constructor(root: HTMLElement, private readonly api: Api, private readonly key: string, private readonly back: () => void,
              private readonly open: (product: ShelvedProduct, hand?: string) => void, private readonly openJob: (key: string) => void,
              private readonly change: (job: Job) => void) {
    const { els } = this;
    fill(els.filesPart, el("summary", {}, el("h2", {}, say("job.files"))), els.files);
    this.section = el("section", { class: "job" },
      el("aside", {}, els.state, els.bar, els.buttons, els.dots, els.filesPart,
        el("details", { class: "part" }, el("summary", {}, el("h2", {}, say("bench.command"))), els.commands)),
      el("div", { class: "seen" }, els.tabs, els.report));
    fill(root, el("header", { class: "top" }, el("button", { type: "button", onclick: back }, say("bench.back")), els.title), els.lost, this.section);
    void this.look();
  }

  close(): void {
    this.isClosed = true;
    this.looked?.close();
    clearTimeout(this.timer);
  }

  private async look(): Promise<void> {
    clearTimeout(this.timer);
    try {
      this.show(await this.api.job(this.key));
      this.els.lost.hidden = true;
    } catch {
      this.els.lost.hidden = false;
    }
    if (!this.isClosed) this.timer = window.setTimeout(() => void this.look(), kBetweenLooks);
  }

  private async act(what: "/start" | "/cancel"): Promise<void> {
    try {
      this.show(await this.api.job(this.key, what));
    } catch (error) {
      this.els.state.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private async toBench(name: string): Promise<void> {
    try {
      this.open(await this.api.shape(this.key, name));
    } catch (error) {
      this.els.state.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private async remove(): Promise<void> {
    if (!confirm(say("job.remove_asked"))) return;
    try {
      await this.api.removeJob(this.key);
      this.back();
    } catch (error) {
      this.els.state.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private show(job: Job): void {
    if (this.isClosed) return;
    const before = this.job;
    this.job = job;
    const { els } = this;
    this.section.dataset.state = job.state;
    this.section.dataset.kind = job.kind;
    els.bar.hidden = job.state !== "running" && job.state !== "estimating";
    els.bar.value = job.share;
    const sentence = jobSentence(job);
    if (els.state.textContent !== sentence) els.state.textContent = sentence;
    els.badge.className = `state ${job.state}`;
    els.badge.textContent = jobStateWords(job);
    els.state.className = `status ${{ failed: "bad", stopped: "fair" }[job.state as string] ?? ""}`;
    if (before && before.state === job.state && before.has_report === job.has_report && before.has_preview === job.has_preview && before.files.length === job.files.length) return;
    this.showStanding(job);
  }

  // What changes with the state alone.
  private showStanding(job: Job): void {
    const { els } = this;
    fill(els.title, el("strong", {}, job.title), el("span", { class: "soft" }, say(`job.kind.${job.kind}`)), els.badge);
    const button = (act: string, words: string, isMain: boolean, does: () => void) =>
      el("button", { type: "button", class: isMain ? "primary" : "", "data-job-act": act, onclick: does }, words);
    const canStart = job.state === "new" || job.state === "stopped" || job.state === "failed" || job.state === "estimating";
    const isGoing = job.state === "running" || job.state === "waiting";
    fill(els.buttons,
      canStart && button("start", say(job.kind === "redesign" && job.state === "new" ? "job.start_redesign" : job.state === "new" || job.state === "estimating" ? "job.start" : job.kind === "study" ? "job.resume" : "job.again"), true, () => void this.act("/start")),
      isGoing && button("cancel", say("job.cancel"), false, () => void this.act("/cancel")),
      job.kind === "redesign" && !isGoing && job.state !== "estimating" && button("change", say("job.change"), false, () => this.change(job)),
      job.has_hand && job.state === "done" && button("use", say("hand.use"), true, () => void this.useHand()),
      !isGoing && job.state !== "estimating" && button("remove", say("job.remove"), false, () => void this.remove()));
    fill(els.commands, job.commands.map((command) => el("code", {}, command)));
    els.filesPart.hidden = job.files.length === 0;
    els.filesPart.open = job.kind === "redesign" || job.kind === "hand"; // what goes back to CAD
    const isShape = (name: string) => job.kind === "redesign" && /\.(stl|obj|ply|step)$/.test(name);
    fill(els.files, job.files.map((name) => el("li", {}, el("a", { href: this.api.address(job.key, `files/${encodeURIComponent(name)}`), download: name }, name),
      isShape(name) && [" ", el("button", { type: "button", "data-on-bench": name, onclick: () => void this.toBench(name) }, say("job.on_bench"))])));
    this.showReport(job);
  }

  private showReport(job: Job): void {
    const isResting = !(job.state === "running" || job.state === "waiting" || job.state === "estimating");
    const what = isResting ? `${job.state} ${job.has_report} ${job.has_preview}` : "";
    if (what === this.shownReport) return;
    this.shownReport = what;
    fill(this.els.dots);
    const first = isResting ? this.toLookAt(job) : null;
    const hasPage = isResting && job.has_report;
    this.els.tabs.hidden = !(first && hasPage);
    const tab = (name: "look" | "report", words: string, act: () => void) => el("button", { type: "button", "data-tab": name, "aria-pressed": "false", onclick: act }, words);
    fill(this.els.tabs, first && tab("look", say(job.kind === "hand" ? "found.heading" : "shape.view"), () => this.showLook(this.toLookAt(this.job!))), tab("report", say("job.report"), () => this.showPage(this.job!)));
    // A hand is corrected first; a redesign that was held is read about.
    if (first && (job.kind === "hand" || !hasPage)) this.showLook(first);
    else if (hasPage) this.showPage(job);
    else {
      this.showLook(null);
      fill(this.els.report, job.kind === "redesign" && job.state === "done" ? proposalsList(this.api, job, (key) => this.openJob(key)) : el("p", { class: "soft empty" }, say("job.no_report")));
    }
  }

  private pressTab(name: string): void {
    for (const button of this.els.tabs.querySelectorAll<HTMLElement>("[data-tab]")) button.setAttribute("aria-pressed", String(button.dataset.tab === name));
  }

  private showLook(look: Looked | null): void {
    this.looked?.close();
    this.looked = look;
    if (!look) return;
    fill(this.els.report, look.element);
    this.pressTab("look");
    void look.load();
  }

  // What there is besides a report, if anything.
  private toLookAt(job: Job): Looked | null {
    if (job.kind === "redesign") {
      const isMade = job.files.some((one) => /^(pressed|redesign)\.stl$|^region\.ply$/.test(one));
      return isMade && job.state === "done" ? new ShapeView(this.api, job, "result") : job.has_preview ? new ShapeView(this.api, job, "preview") : null;
    }
    if (job.kind !== "hand") return null;
    const revise = (settings: Partial<HandSettings>) => void this.revise(settings);
    if (job.request.method === "quick" && job.made.includes("found/quick.json")) return new QuickView(this.api, job, revise);
    if (job.made.includes("found/marks.csv")) return new MarksView(this.api, job, (corrections) => revise({ corrections }));
    if (job.made.some((one) => one.startsWith("found/reference/bones/"))) return new BonesView(this.api, job, (corrections) => revise({ corrections }));
    return null;
  }

  private async revise(settings: Partial<HandSettings>): Promise<void> {
    try {
      this.shownReport = null;
      this.show(await this.api.reviseJob(this.key, { ...this.job!.request, ...settings }));
    } catch (error) {
      this.els.state.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private async useHand(): Promise<void> {
    try {
      this.open(await this.api.example("round-handle"), `hand:${this.key}`);
    } catch (error) {
      this.els.state.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private showPage(job: Job): void {
    this.showLook(null);
    this.pressTab("report");
    const frame = el("iframe", { src: this.api.address(job.key, "report"), title: say("job.report"), sandbox: "allow-scripts allow-downloads" });
    fill(this.els.report, frame);
    if (job.kind === "study") void new DotsChart(this.els.dots, this.api, job.key, frame).load();
  }
}
