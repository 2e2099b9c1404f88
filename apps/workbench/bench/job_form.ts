// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What a study, a comparison or a redesign is to be of: designs, hands, how firmly.
import { Api, Job, JobKind, JobSettings, KeptProject, OwnHand, ServerState, ShelvedProduct } from "./api";
import { el, fill } from "./dom";
import { FilePicker } from "./file_picker";
import { people, personWords, populations } from "./people";
import { benchLanguage, say, TextKey } from "./say";

const verbs = ["press", "region", "fillet", "features"] as const;
const kUsualHands = 12; // six pairs are the fewest that show anything

/// How many designs each kind takes.
export type DesignJob = Exclude<JobKind, "hand">;
const counts: Record<DesignJob, { fewest: number; most: number }> = {
  study: { fewest: 1, most: 12 }, compare: { fewest: 2, most: 3 }, redesign: { fewest: 1, most: 1 },
};

export class JobForm {
  private chosen: ShelvedProduct[] = [];
  private projects: KeptProject[] = [];
  private readonly list = el("ol", { class: "designs", "aria-label": say("form.designs") });
  private readonly message = el("p", { class: "message", role: "status" });
  private readonly more: HTMLSelectElement;
  private readonly submit = el("button", { type: "submit", class: "primary", disabled: true });
  private readonly fields = {
    population: el("select", { name: "population" }, populations.map((one) => el("option", { value: one.key }, say(`population.${one.key}`)))),
    hands: el("input", { type: "number", name: "hands", min: 1, max: 2000, step: 1, value: kUsualHands }),
    person: el("select", { name: "person" }, people.map((one) => el("option", { value: one }, personWords(one)))),
    side: el("select", { name: "side" }, el("option", { value: "right" }, say("bench.right")), el("option", { value: "left" }, say("bench.left"))),
    force: el("input", { type: "number", name: "force", min: 1, max: 1000, step: 1, placeholder: say("form.usual") }),
    mass: el("input", { type: "number", name: "mass", min: 0.001, max: 100, step: 0.001, placeholder: say("form.nothing") }),
    verb: el("select", { name: "verb" }, verbs.map((one) => el("option", { value: one }, say(`redesign.${one}`)))),
    depth: el("input", { type: "number", name: "depth", min: 0.1, max: 50, step: 0.1, placeholder: say("form.usual") }),
    low: el("input", { type: "number", name: "low", min: 0.1, max: 200, step: 0.1, value: 1 }),
    high: el("input", { type: "number", name: "high", min: 0.1, max: 200, step: 0.1, value: 15 }),
    preview: el("input", { type: "number", name: "preview", min: 0.1, max: 200, step: 0.1, placeholder: say("form.middle") }),
    vary: el("input", { type: "text", name: "vary", placeholder: say("form.propose"), maxlength: 100 }),
  };
  private readonly verbHint = el("p", { class: "soft" });
  private readonly depthRow: HTMLElement;
  private readonly radiusRow: HTMLElement;
  private readonly handsRow: HTMLElement;
  private readonly previewRow: HTMLElement;
  private readonly varyRow: HTMLElement;

  /// `before`: what an earlier one was asked for, to be changed.
  constructor(root: HTMLElement, private readonly api: Api, private readonly state: ServerState, private readonly kind: DesignJob,
              begin: ShelvedProduct[], back: () => void, private readonly made: (job: Job) => void, before: JobSettings | null = null) {
    const picker = new FilePicker(api, (text) => { this.message.textContent = text; }, (product) => this.add(product), null);
    this.more = el("select", { "data-more": true, "aria-label": say("form.add_known"), onchange: () => void this.addKnown() });
    const field = (key: TextKey, ...inputs: (HTMLElement | string)[]) => el("label", { class: "field" }, el("span", {}, say(key)), el("span", { class: "inputs" }, inputs));
    const { fields } = this;
    this.handsRow = field("form.hands", fields.hands);
    this.depthRow = field("form.depth", fields.depth, "mm");
    this.radiusRow = el("div", { class: "field", role: "group", "aria-label": say("form.radius") }, el("span", {}, say("form.radius")),
      el("span", { class: "inputs" }, fields.low, "–", fields.high, "mm"));
    this.previewRow = field("form.preview_radius", fields.preview, "mm");
    this.varyRow = field("form.vary", fields.vary);
    fields.low.setAttribute("aria-label", `${say("form.radius")}, ${say("form.from")}, mm`);
    fields.high.setAttribute("aria-label", `${say("form.radius")}, ${say("form.to")}, mm`);
    fields.side.setAttribute("aria-label", `${say("bench.right")}, ${say("bench.left")}`);
    const many = [field("form.population", fields.population), this.handsRow];
    const task = [field("form.force", fields.force, "N"), field("form.mass", fields.mass, "kg")];
    const own = {
      study: [...many, ...task],
      compare: [field("bench.who", fields.person, fields.side), ...task],
      redesign: [field("form.verb", fields.verb), this.verbHint, this.depthRow, this.radiusRow, this.previewRow, this.varyRow, ...many],
    }[kind];
    const form = el("form", { class: "job-form" },
      el("fieldset", {}, el("legend", {}, say(kind === "redesign" ? "form.design" : "form.designs")), this.list,
        el("div", { class: "buttons" }, el("button", { type: "button", onclick: () => picker.choose() }, say("form.add_file")), picker.input, this.more)),
      el("fieldset", {}, el("legend", {}, say(kind === "compare" ? "form.hand" : "form.people")), own),
      this.message, el("div", { class: "buttons" }, this.submit));
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      void this.send();
    });
    for (const select of [fields.population, fields.verb]) select.addEventListener("change", () => this.show());
    picker.takeDrops(root, form);
    fields.vary.addEventListener("input", () => this.show());
    if (before) this.take(before);
    fill(root, el("header", { class: "top" }, el("button", { type: "button", onclick: back }, say("bench.back")), el("div", { class: "title" }, el("strong", {}, say(`job.new.${kind}`)))),
      el("div", { class: "start narrow" }, el("h1", {}, say(`job.new.${kind}`)), el("p", { class: "lead" }, say(`job.about.${kind}`)), form));
    begin.forEach((product) => this.add(product));
    this.show();
    void api.projects().then((projects) => { this.projects = projects; this.show(); }, () => {});
    if (kind === "compare") void api.hands().then((hands) => this.addHands(hands), () => {});
  }

  private addHands(hands: OwnHand[]): void {
    this.fields.person.append(...hands.map((one) => el("option", { value: `hand:${one.key}` }, say("hand.own", { name: one.name }))));
  }

  private take(before: JobSettings): void {
    const { fields } = this;
    const set = (input: HTMLInputElement | HTMLSelectElement, value: unknown) => { if (value !== null && value !== undefined) input.value = String(value); };
    set(fields.verb, before.verb);
    set(fields.depth, before.largest_depth_mm);
    set(fields.low, before.radius_mm?.[0]);
    set(fields.high, before.radius_mm?.[1]);
    set(fields.preview, before.preview_mm);
    set(fields.vary, before.vary?.join(" "));
    set(fields.population, populations.find((one) => one.names.join() === before.populations?.join())?.key);
    if (before.hands) set(fields.hands, before.hands);
  }

  private add(product: ShelvedProduct): void {
    if (this.kind === "redesign") this.chosen = [];
    this.message.textContent = "";
    this.chosen.push(product);
    this.show();
  }

  private async addKnown(): Promise<void> {
    const [what, name] = this.more.value.split("/");
    this.more.value = "";
    try {
      if (what === "example") this.add(await this.api.example(name));
      else if (what === "project") this.add((await this.api.project(name)).product);
      else if (what === "given") this.add(this.state.given.find((one) => one.key === name)!);
    } catch (error) {
      this.message.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private show(): void {
    const { fewest, most } = counts[this.kind];
    fill(this.list, this.chosen.length === 0 && el("li", { class: "soft" }, say(fewest > 1 ? "form.none_of_two" : "form.none")),
      this.chosen.map((product, k) => el("li", {}, el("strong", {}, product.file_name), product.unit && el("span", { class: "soft" }, product.unit),
        el("button", { type: "button", "aria-label": say("form.without", { file: product.file_name }), onclick: () => { this.chosen.splice(k, 1); this.show(); } }, "×"))));
    const group = (key: TextKey, options: HTMLElement[]) => options.length > 0 && el("optgroup", { label: say(key) }, options);
    fill(this.more, el("option", { value: "" }, say("form.add_known")),
      group("start.given", this.state.given.map((one) => el("option", { value: `given/${one.key}` }, one.file_name))),
      group("start.recent", this.projects.map((one) => el("option", { value: `project/${one.key}` }, one.file_name))),
      group("form.examples", this.state.examples.map((one) => el("option", { value: `example/${one}` }, say(`example.${one}` as TextKey)))));
    this.submit.disabled = this.chosen.length < fewest || this.chosen.length > most;
    this.handsRow.hidden = !this.population().areDrawn;
    const verb = this.fields.verb.value as (typeof verbs)[number];
    this.verbHint.textContent = say(`redesign.about.${verb}`);
    this.depthRow.hidden = verb !== "press" && verb !== "region";
    this.radiusRow.hidden = this.previewRow.hidden = verb !== "fillet";
    this.varyRow.hidden = verb !== "features";
    const isPreviewed = this.kind === "redesign" && (verb !== "features" || this.varied().length > 0);
    this.submit.textContent = say(this.kind === "study" ? "form.estimate" : isPreviewed ? "form.preview" : "form.start");
  }

  private population() { return populations.find((one) => one.key === this.fields.population.value)!; }

  private varied(): string[] { return this.fields.vary.value.trim().split(/\s+/).filter(Boolean); }

  private async send(): Promise<void> {
    const { fields, kind } = this;
    const number = (input: HTMLInputElement) => (input.value === "" ? null : Number(input.value));
    const request: Record<string, unknown> = { kind, products: this.chosen.map((one) => one.key), language: benchLanguage() };
    if (kind === "compare") Object.assign(request, { person: fields.person.value || null, left: fields.side.value === "left" });
    else Object.assign(request, { populations: this.population().names, hands: this.population().areDrawn ? number(fields.hands) : 0 });
    if (kind === "redesign") Object.assign(request, { verb: fields.verb.value, largest_depth_mm: number(fields.depth), radius_mm: [Number(fields.low.value), Number(fields.high.value)], preview_mm: number(fields.preview), vary: this.varied() });
    else Object.assign(request, { grip_force_n: number(fields.force), mass_kg: number(fields.mass) });
    this.submit.disabled = true;
    try {
      this.made(await this.api.addJob(request));
    } catch (error) {
      this.message.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
      this.submit.disabled = false;
    }
  }
}
