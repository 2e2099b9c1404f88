// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// A product's file, chosen or dropped, on its way to the server; asks for the unit if the file doesn't
// say it.
import { Api, ShelvedProduct, UnitQuestion } from "./api";
import { el, fill } from "./dom";
import { projectEnding } from "./project";
import { say, sidesText } from "./say";

const kEndings = ".stl,.obj,.ply,.3mf,.gltf,.glb,.step,.stp,.iges,.igs";

export class FilePicker {
  readonly input: HTMLInputElement;

  /// `told`: what is being done or went wrong. `projects`: what becomes of a project's file; without it
  /// only products are taken.
  constructor(private readonly api: Api, private readonly told: (text: string) => void,
              private readonly taken: (product: ShelvedProduct) => void, private readonly projects: ((file: File) => void) | null) {
    this.input = el("input", { type: "file", class: "unseen", tabindex: -1, "aria-hidden": "true", accept: projects ? `${kEndings},${projectEnding}` : kEndings });
    this.input.addEventListener("change", () => {
      const file = this.input.files?.[0];
      if (file) void this.send(file);
    });
  }

  choose(): void { this.input.click(); }

  takeDrops(root: HTMLElement, shown: HTMLElement): void {
    const over = (isOver: boolean) => (event: Event) => {
      event.preventDefault();
      shown.classList.toggle("is-over", isOver);
    };
    for (const name of ["dragenter", "dragover"]) root.addEventListener(name, over(true));
    root.addEventListener("dragleave", over(false));
    root.addEventListener("drop", (event) => {
      over(false)(event);
      const file = (event as DragEvent).dataTransfer?.files[0];
      if (file) void this.send(file);
    });
  }

  private async send(file: File, unit = ""): Promise<void> {
    this.told(say("start.reading", { file: file.name }));
    if (this.projects && file.name.endsWith(projectEnding)) return this.projects(file);
    try {
      const query = new URLSearchParams({ name: file.name, unit });
      const { status, json } = await this.api.ask("POST", `/api/products?${query.toString()}`, file);
      this.told("");
      if (status === 200) this.taken(json as ShelvedProduct);
      else if (status === 409) this.askUnit(file, json as UnitQuestion);
      else this.told(say("bench.failed", { message: (json as { error: string }).error }));
    } catch (error) {
      this.told(say("bench.failed", { message: String(error) }));
    }
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
}
