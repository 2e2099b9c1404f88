// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A hand from one photograph or from measures: what was found in the picture, and how well each dimension is
// known; what somebody measured replaces it.
import { Api, HandSettings, Job } from "./api";
import { el, fill } from "./dom";
import { decimal, say, TextKey } from "./say";
import { dimensionWords } from "./hand_words";

interface QuickJson {
  side: string;
  population: string;
  dimensions: Record<string, { value_mm: number; sd_mm: number; how: string }>;
  photograph?: { sheet: string; tilt_deg: number };
}

const kShown95 = 1.96; // 95 of 100 are within so many standard deviations

export class QuickView {
  readonly element: HTMLElement;
  private readonly rows = el("tbody");
  private readonly words = el("p", { class: "status", role: "status" });
  private readonly inputs = new Map<string, HTMLInputElement>();
  private readonly wrist: HTMLInputElement;

  constructor(private readonly api: Api, private readonly job: Job, private readonly revise: (settings: Partial<HandSettings>) => void) {
    const picture = job.made.includes("found/found.png");
    this.wrist = el("input", { type: "number", step: 1, min: -200, max: 200, value: job.request.wrist_inside_mm ?? 0, "aria-label": `${say("hand.wrist_inside")}, mm` });
    this.element = el("section", { class: "found quick", "aria-label": say("found.heading") },
      el("div", { class: "shape" }, picture
        ? el("img", { class: "found-picture", src: api.address(job.key, "made") + "&file=found%2Ffound.png", alt: say("found.picture") })
        : el("p", { class: "soft empty" }, say("found.measures_only")), picture && el("p", { class: "point" }, say("found.picture_colours")), this.words),
      el("aside", {}, el("h2", {}, say("found.sizes")), el("p", { class: "soft" }, say("found.about_sizes")),
        picture && el("label", { class: "field" }, el("span", {}, say("hand.wrist_inside")), el("span", { class: "inputs" }, this.wrist, "mm")),
        el("button", { type: "button", class: "primary", "data-found": "again", onclick: () => this.send() }, say("found.again")),
        el("table", {}, el("thead", {}, el("tr", {}, (["found.size", "found.value", "found.within", "found.measured"] as TextKey[]).map((key) => el("th", { scope: "col" }, say(key))))), this.rows)));
  }

  close(): void {}

  async load(): Promise<void> {
    try {
      const json = JSON.parse(new TextDecoder().decode(await this.api.bytes(this.job.key, "made?file=found%2Fquick.json"))) as QuickJson;
      fill(this.rows, Object.entries(json.dimensions).map(([name, one]) => {
        const input = el("input", { type: "number", step: 0.5, min: 1, max: 500, "data-size": name, value: this.job.request.sizes_mm?.[name] ?? "", "aria-label": `${say("found.measured")}: ${dimensionWords(name)}, mm` });
        this.inputs.set(name, input);
        return el("tr", {}, el("th", { scope: "row" }, dimensionWords(name)), el("td", { class: "n" }, decimal(one.value_mm, 1)), el("td", { class: "n" }, `± ${decimal(kShown95 * one.sd_mm, 1)}`), el("td", {}, input));
      }));
      this.words.textContent = say("found.quick", { side: say(json.side === "left" ? "bench.left" : "bench.right"), population: json.population });
      this.element.dataset.ready = "quick";
    } catch (error) {
      this.words.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
    }
  }

  private send(): void {
    const sizes = { ...this.job.request.sizes_mm };
    for (const [name, input] of this.inputs) {
      if (input.value !== "") sizes[name] = Number(input.value);
      else delete sizes[name];
    }
    this.revise({ sizes_mm: sizes, wrist_inside_mm: Number(this.wrist.value) || 0 });
  }
}
