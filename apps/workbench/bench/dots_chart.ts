// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Every grasp of a study as a dot over the length of the hand. Hands can be left out by their length; a
// click on a dot shows that hand in the report's 3-D view.
import { Api } from "./api";
import { Dots, dotSummaries } from "./dots";
import { el, fill } from "./dom";
import { decimal, say } from "./say";
import { tickStep } from "./ticks";

const kShapes = ["●", "■", "▲", "◆", "▼", "★"]; // beside the colours, for those who don't see them apart

export class DotsChart {
  private dots: Dots | null = null;
  private readonly isLoaded: Promise<void>; // the report, which hears nothing before
  private readonly chart = el("div", { class: "dot-chart" });
  private readonly table = el("table", { class: "dot-table" });
  private readonly quantity = el("select", { "data-dots": "quantity", "aria-label": say("dots.quantity"), onchange: () => this.show() });
  private readonly low = el("input", { type: "number", "data-dots": "low", step: 1, "aria-label": say("dots.low"), onchange: () => this.show() });
  private readonly high = el("input", { type: "number", "data-dots": "high", step: 1, "aria-label": say("dots.high"), onchange: () => this.show() });
  private readonly says = el("p", { class: "soft", role: "status" }, say("dots.hint"));

  constructor(private readonly root: HTMLElement, private readonly api: Api, private readonly key: string, private readonly frame: HTMLIFrameElement) {
    this.isLoaded = new Promise((done) => frame.addEventListener("load", () => done(), { once: true }));
  }

  async load(): Promise<void> {
    try {
      this.dots = await this.api.dots<Dots>(this.key);
    } catch {
      return; // the report says what there is
    }
    fill(this.quantity, this.dots.quantities.map((one, k) => el("option", { value: k }, one.unit ? `${one.name}, ${one.unit}` : one.name)));
    const lengths = this.dots.hands.map((one) => one.length_mm).filter((one): one is number => one !== null);
    if (lengths.length > 0) {
      this.low.value = String(Math.floor(Math.min(...lengths)));
      this.high.value = String(Math.ceil(Math.max(...lengths)));
      this.low.min = this.high.min = this.low.value;
      this.low.max = this.high.max = this.high.value;
    }
    fill(this.root, el("h2", {}, say("dots.heading")), this.quantity, this.chart,
      lengths.length > 0 && el("p", { class: "range" }, say("dots.range"), " ", this.low, " – ", this.high, " mm"), this.table, this.says);
    this.show();
  }

  private show(): void {
    const dots = this.dots;
    if (!dots || dots.quantities.length === 0) return;
    const q = Number(this.quantity.value), low = Number(this.low.value), high = Number(this.high.value);
    const isAll = this.low.value === this.low.min && this.high.value === this.high.max;
    const summaries = dotSummaries(dots, q, low, high, isAll);
    const places = (value: number) => Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value) || 1))); // three digits
    const meanWords = (mean: number | null, sd: number | null) =>
      mean === null ? "–" : decimal(mean, places(mean)) + (sd === null ? "" : ` ± ${decimal(sd, places(mean))}`);
    fill(this.table, el("thead", {}, el("tr", {}, [say("bench.product"), say("dots.held"), say("dots.mean")].map((words, k) => el("th", { scope: "col", class: k ? "n" : "" }, words)))),
      el("tbody", {}, summaries.map((one, p) => el("tr", { "data-product": p }, el("th", { scope: "row" }, this.mark(p), ` ${one.name}`),
        el("td", { class: "n" }, `${one.held} / ${one.hands}`), el("td", { class: "n" }, meanWords(one.mean, one.sd))))));
    this.draw(q, low, high, isAll);
  }

  private colour(product: number): string { return `rgb(${this.dots!.products[product].colour.join(",")})`; }
  private mark(product: number): HTMLElement {
    const mark = el("span", { "aria-hidden": "true" }, kShapes[product % kShapes.length]);
    mark.style.color = this.colour(product);
    return mark;
  }

  private draw(q: number, low: number, high: number, isAll: boolean): void {
    const dots = this.dots!;
    const width = 340, height = 220, left = 52, right = 8, top = 8, bottom = 34;
    const shown = dots.grasps.filter((one) => {
      const length = dots.hands[one.hand].length_mm;
      return one.values[q] !== null && length !== null && (isAll || (length >= low && length <= high));
    });
    const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("role", "group");
    svg.setAttribute("aria-label", say("dots.heading"));
    const lengths = shown.map((one) => dots.hands[one.hand].length_mm!);
    const from = Math.min(...lengths) - 3, to = Math.max(...lengths) + 3, most = Math.max(...shown.map((one) => one.values[q]!)) * 1.08 || 1;
    const x = (value: number) => left + ((value - from) / (to - from)) * (width - left - right);
    const y = (value: number) => height - bottom - (value / most) * (height - top - bottom);
    const parts: string[] = [];
    if (shown.length > 0) {
      const step = tickStep(most), decimals = Math.max(0, Math.ceil(-Math.log10(step) - 1e-9) + (/2\.5/.test((step / 10 ** Math.floor(Math.log10(step) + 1e-9)).toFixed(2)) ? 1 : 0));
      for (let value = 0; value <= most; value += step) parts.push(`<path d="M${left} ${y(value).toFixed(1)}H${width - right}" stroke="#d9dee3"/><text x="${left - 6}" y="${(y(value) + 4).toFixed(1)}" text-anchor="end">${decimal(value, decimals)}</text>`);
      const across = Math.max(1, tickStep((to - from) * 1.6));
      for (let value = Math.ceil(from / across) * across; value <= to; value += across) parts.push(`<text x="${x(value).toFixed(1)}" y="${height - bottom + 16}" text-anchor="middle">${decimal(value, 0)}</text>`);
    }
    parts.push(`<text x="${(left + width - right) / 2}" y="${height - 3}" text-anchor="middle">${say("dots.length")}</text>`);
    svg.innerHTML = `<g font-size="11" fill="#1d2329">${parts.join("")}</g>`;
    for (const grasp of shown) {
      const { length_mm, shown: inView } = dots.hands[grasp.hand];
      const dot = document.createElementNS("http://www.w3.org/2000/svg", "text");
      dot.textContent = kShapes[grasp.product % kShapes.length];
      const set: Record<string, string> = {
        x: x(length_mm!).toFixed(1), y: (y(grasp.values[q]!) + 4).toFixed(1), "text-anchor": "middle", "font-size": "13", fill: this.colour(grasp.product), "fill-opacity": "0.85",
        class: "dot", tabindex: "0", role: "button", "data-hand": String(grasp.hand), "data-of": String(grasp.product),
        "aria-label": say("dots.dot", { product: dots.products[grasp.product].name, length: decimal(length_mm!, 0), value: decimal(grasp.values[q]!, 3), unit: dots.quantities[q].unit }),
      };
      for (const [name, value] of Object.entries(set)) dot.setAttribute(name, value);
      const open = () => this.open(grasp.product, inView, dot);
      dot.addEventListener("click", open);
      dot.addEventListener("keydown", (event) => { if (event.key === "Enter" || event.key === " ") { event.preventDefault(); open(); } });
      svg.append(dot);
    }
    fill(this.chart, svg);
  }

  // The report is a page of its own, which takes this as a message (viewer/page.ts).
  private open(product: number, hand: number | null, dot: SVGElement): void {
    this.says.textContent = hand === null ? say("dots.not_in_view") : dot.getAttribute("aria-label")!;
    for (const one of this.chart.querySelectorAll(".dot.is-open")) one.classList.remove("is-open");
    dot.classList.add("is-open");
    if (hand !== null) void this.isLoaded.then(() => this.frame.contentWindow?.postMessage({ palmar: "show-hand", product, hand }, "*"));
  }
}
