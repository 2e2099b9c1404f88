// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A person's hand: what it is to be made from, and the files for it.
import { Api, HandMethod, HandSettings, Job, newKey } from "./api";
import { el, fill } from "./dom";
import { postureInName, postures } from "./hand_names";
import { populations } from "./people";
import { benchLanguage, say, TextKey } from "./say";

const methods: HandMethod[] = ["quick", "scan", "photos", "mri", "file"];
const colours = ["green", "blue", "red", "black", "purple", "orange"] as const;
const accepts: Record<HandMethod, string> = {
  quick: ".png,.jpg,.jpeg", scan: ".obj,.mtl,.ply,.glb,.gltf,.bin,.stl,.png,.jpg,.jpeg", photos: ".png,.jpg,.jpeg,.json", mri: "", file: ".glb",
};
const isMesh = (name: string) => /\.(obj|ply|glb|gltf|stl)$/i.test(name);
const isKnown = (file: File) => /\.toml$/i.test(file.name); // says what is known of the person

interface Sent {
  file: File;
  name: string; // from the chosen folder on
  posture: string; // of a scan's mesh
}

/// From the folder that was chosen on, without that folder's own name.
function nameFrom(file: File): string {
  const path = (file as File & { webkitRelativePath?: string }).webkitRelativePath || file.name;
  const parts = path.split("/");
  return parts.length > 1 ? parts.slice(1).join("/") : path;
}

export class HandForm {
  private method: HandMethod = "quick";
  private files: Sent[] = [];
  private known: File | null = null;
  private readonly message = el("p", { class: "message", role: "status" });
  private readonly list = el("ul", { class: "designs" });
  private readonly submit = el("button", { type: "submit", class: "primary" }, say("hand.make"));
  private readonly input = el("input", { type: "file", class: "unseen", tabindex: -1, "aria-hidden": "true", multiple: true });
  private readonly folder = el("input", { type: "file", class: "unseen", tabindex: -1, "aria-hidden": "true", multiple: true, webkitdirectory: true, "data-folder": true });
  private readonly about = el("p", { class: "soft" });
  private readonly rows: Partial<Record<string, HTMLElement>> = {};
  private readonly chooseFolder = el("button", { type: "button", onclick: () => this.folder.click() }, say("hand.choose_folder"));
  private readonly fields = {
    name: el("input", { type: "text", name: "name", maxlength: 40, pattern: "[A-Za-z0-9_\\-]+", value: "my-hand" }),
    side: el("select", { name: "side" }, el("option", { value: "" }, say("hand.found")), el("option", { value: "right" }, say("bench.right")), el("option", { value: "left" }, say("bench.left"))),
    unit: el("select", { name: "unit" }, el("option", { value: "" }, say("hand.found")), ["mm", "cm", "m", "inch"].map((one) => el("option", { value: one }, one))),
    crease: this.inks("crease", "green"),
    dot: this.inks("dot", "blue"),
    population: el("select", { name: "population" }, populations.filter((one) => one.areDrawn).map((one) => el("option", { value: one.names[0] }, say(`population.${one.key}`)))),
    sheet: el("select", { name: "sheet" }, el("option", { value: "" }, say("hand.found")), el("option", { value: "a4" }, "A4"), el("option", { value: "letter" }, say("hand.letter")), el("option", { value: "card" }, say("hand.card"))),
    wrist: el("input", { type: "number", name: "wrist", min: -200, max: 200, step: 1, value: 0 }),
    palmUp: el("input", { type: "checkbox", name: "palm_up" }),
    length: el("input", { type: "number", name: "hand_length", min: 100, max: 300, step: 0.5 }),
    circumference: el("input", { type: "number", name: "hand_circumference", min: 100, max: 350, step: 0.5 }),
    width: el("input", { type: "number", name: "hand_width", min: 40, max: 150, step: 0.5 }),
  };

  constructor(root: HTMLElement, private readonly api: Api, back: () => void, private readonly made: (job: Job) => void) {
    const field = (key: string, label: TextKey, ...inputs: (HTMLElement | string)[]) => {
      const row = el("label", { class: "field" }, el("span", {}, say(label)), el("span", { class: "inputs" }, inputs));
      this.rows[key] = row;
      return row;
    };
    const { fields } = this;
    const choice = (method: HandMethod) => el("label", { class: "method" },
      el("input", { type: "radio", name: "method", value: method, checked: method === this.method, onchange: () => this.choose(method) }),
      el("span", {}, el("strong", {}, say(`hand.method.${method}`)), el("span", { class: "soft" }, say(`hand.method_says.${method}`))));
    const form = el("form", { class: "job-form hand-form" },
      el("fieldset", {}, el("legend", {}, say("hand.from")), methods.map(choice)),
      el("fieldset", {}, el("legend", {}, say("hand.files")), this.about, this.list,
        el("div", { class: "buttons" }, el("button", { type: "button", onclick: () => this.input.click() }, say("hand.choose")), this.chooseFolder, this.input, this.folder)),
      el("fieldset", {}, el("legend", {}, say("hand.settings")),
        field("name", "hand.name", fields.name), field("length", "hand.length", fields.length, "mm"), field("circumference", "hand.circumference", fields.circumference, "mm"), field("width", "hand.width", fields.width, "mm"),
        field("population", "form.population", fields.population), field("sheet", "hand.sheet", fields.sheet), field("wrist", "hand.wrist_inside", fields.wrist, "mm"), field("palmUp", "hand.palm_up", fields.palmUp),
        field("side", "hand.side", fields.side), field("unit", "hand.unit", fields.unit), field("crease", "hand.crease_colour", fields.crease), field("dot", "hand.dot_colour", fields.dot)),
      this.message, el("div", { class: "buttons" }, this.submit));
    form.addEventListener("submit", (event) => { event.preventDefault(); void this.send(); });
    for (const input of [this.input, this.folder]) input.addEventListener("change", () => { this.take([...(input.files ?? [])]); input.value = ""; });
    form.addEventListener("dragover", (event) => event.preventDefault());
    form.addEventListener("drop", (event) => { event.preventDefault(); this.take([...((event as DragEvent).dataTransfer?.files ?? [])]); });
    for (const one of [fields.length, fields.circumference, fields.width]) one.addEventListener("input", () => this.show());
    fill(root, el("header", { class: "top" }, el("button", { type: "button", onclick: back }, say("bench.back")), el("div", { class: "title" }, el("strong", {}, say("job.new.hand")))),
      el("div", { class: "start narrow" }, el("h1", {}, say("job.new.hand")), el("p", { class: "lead" }, say("job.about.hand")), form));
    this.show();
  }

  private inks(name: string, usual: string): HTMLSelectElement {
    const select = el("select", { name }, colours.map((one) => el("option", { value: one }, say(`ink.${one}`))));
    select.value = usual;
    return select;
  }

  private choose(method: HandMethod): void {
    this.method = method;
    this.files = [];
    this.known = null;
    this.message.textContent = "";
    this.show();
  }

  private take(files: File[]): void {
    const many = this.method !== "quick" && this.method !== "file";
    if (this.method !== "file") this.known = files.filter(isKnown).pop() ?? this.known;
    const sent = files.filter((file) => !isKnown(file)).map((file) => ({ file, name: nameFrom(file), posture: postureInName(file.name) }));
    this.files = many ? [...this.files, ...sent] : [...sent, ...this.files].slice(0, 1);
    this.show();
  }

  private show(): void {
    const { method, rows } = this;
    this.input.accept = accepts[method] && method !== "file" ? `${accepts[method]},.toml` : accepts[method];
    this.about.textContent = say(`hand.files_says.${method}`);
    this.chooseFolder.hidden = method !== "photos" && method !== "mri";
    const shown: Record<string, HandMethod[]> = {
      name: ["quick", "scan", "photos", "mri", "file"], length: ["quick"], circumference: ["quick"], width: ["quick"], population: ["quick"], sheet: ["quick"], wrist: ["quick"], palmUp: ["quick"],
      side: ["quick", "scan", "photos", "mri"], unit: ["scan"], crease: ["scan", "photos"], dot: ["scan", "photos"],
    };
    for (const [key, of] of Object.entries(shown)) rows[key]!.hidden = !of.includes(method);
    if (method === "photos" || method === "mri") {
      fill(this.list, this.files.length > 0 && el("li", {}, el("strong", {}, say("hand.count", { count: this.files.length })),
        el("span", { class: "soft" }, [...new Set(this.files.map((one) => one.name.split("/").slice(0, -1).join("/")).filter(Boolean))].slice(0, 9).join(", ")), this.without(() => { this.files = []; })));
    } else {
      fill(this.list, this.files.map((one, k) => {
        const posture = method === "scan" && isMesh(one.name) && el("select", { "aria-label": say("found.posture"), onchange: (event) => { one.posture = (event.target as HTMLSelectElement).value; } },
          postures.map((name) => el("option", { value: name, selected: name === one.posture }, say(`found.posture.${name}` as TextKey))));
        return el("li", {}, el("strong", {}, one.name), posture || null, this.without(() => { this.files.splice(k, 1); }));
      }));
    }
    const { known } = this;
    if (known) this.list.append(el("li", {}, el("strong", {}, known.name), el("span", { class: "soft" }, say("hand.known")), this.without(() => { this.known = null; })));
    this.submit.disabled = this.files.length === 0 && !(method === "quick" && (this.sizes() !== null || known));
  }
  private without(act: () => void): HTMLElement {
    return el("button", { type: "button", "aria-label": say("hand.without"), onclick: () => { act(); this.show(); } }, "×");
  }

  private sizes(): Record<string, number> | null {
    const all: Record<string, number> = {};
    for (const one of [this.fields.length, this.fields.circumference, this.fields.width]) if (one.value !== "") all[one.name] = Number(one.value);
    return Object.keys(all).length > 0 ? all : null;
  }

  private settings(uploads: string): HandSettings & { kind: string; language: string } {
    const { fields, method } = this;
    const isMarked = method === "scan" || method === "photos", isQuick = method === "quick";
    return {
      kind: "hand", language: benchLanguage(), method, uploads, name: fields.name.value.trim() || "my-hand",
      side: method !== "file" ? fields.side.value || null : null, unit: method === "scan" ? fields.unit.value || null : null,
      crease_colour: isMarked ? fields.crease.value : null, dot_colour: isMarked ? fields.dot.value : null,
      population: isQuick ? fields.population.value : null, sheet: isQuick ? fields.sheet.value || null : null,
      wrist_inside_mm: isQuick ? Number(fields.wrist.value) || 0 : 0, palm_up: isQuick && fields.palmUp.checked,
      sizes_mm: isQuick ? this.sizes() ?? {} : {}, corrections: [],
    };
  }

  // A mesh is called after its posture: the command line takes it from the name.
  private sentName(one: Sent): string {
    if (this.method !== "scan" || !isMesh(one.name)) return one.name;
    const isOnly = this.files.filter((other) => isMesh(other.name)).length === 1;
    return isOnly || postureInName(one.name) === one.posture ? one.name : `${one.posture}${one.name.slice(one.name.lastIndexOf("."))}`;
  }

  private async send(): Promise<void> {
    this.submit.disabled = true;
    const sent = this.files.map((one) => ({ name: this.sentName(one), file: one.file }));
    if (this.known) sent.push({ name: this.known.name, file: this.known });
    const uploads = sent.length > 0 ? newKey() : "";
    try {
      for (const [k, one] of sent.entries()) {
        this.message.textContent = say("hand.sending", { number: k + 1, count: sent.length });
        await this.api.upload(uploads, one.name, one.file);
      }
      this.message.textContent = "";
      this.made(await this.api.addJob(this.settings(uploads)));
    } catch (error) {
      this.message.textContent = say("bench.failed", { message: error instanceof Error ? error.message : String(error) });
      this.submit.disabled = false;
    }
  }
}
