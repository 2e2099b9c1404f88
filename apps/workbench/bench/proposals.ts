// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Changes of a CAD model that were proposed, best first; each can be made and looked at.
import { Api, Job } from "./api";
import { el, fill } from "./dom";
import { parseProposals, Proposal } from "./proposal_rows";
import { decimal, say } from "./say";

/// The list, which fills itself.
export function proposalsList(api: Api, job: Job, open: (key: string) => void): HTMLElement {
  const section = el("section", { class: "proposals" }, el("p", { class: "soft" }, say("job.no_report")));
  const attempt = async (one: Proposal) => {
    try {
      const product = await api.jobProduct(job.key);
      open((await api.addJob({ ...job.request, products: [product.key], vary: [one.vary] })).key);
    } catch (error) {
      fill(section, el("p", { role: "alert" }, say("bench.failed", { message: error instanceof Error ? error.message : String(error) })));
    }
  };
  const show = (all: Proposal[]) => fill(section, el("h2", {}, say("proposals.heading")), el("p", { class: "soft" }, all.length > 0 ? say("proposals.about") : say("proposals.none")),
    el("ol", {}, all.map((one, k) => el("li", {}, el("code", {}, one.vary), el("p", {}, one.reason),
      el("p", { class: "soft" }, one.gain === null ? one.failure : say(one.gain >= 0 ? "proposals.better" : "proposals.worse", { percent: decimal(Math.abs(one.gain), 1) }), !one.isFeasible && one.gain !== null ? ` ${say("proposals.outside")}` : ""),
      one.gain !== null && el("button", { type: "button", "data-proposal": k, onclick: () => void attempt(one) }, say("proposals.preview"))))));
  if (job.files.includes("proposals.csv")) {
    void api.bytes(job.key, "files/proposals.csv").then((bytes) => show(parseProposals(new TextDecoder().decode(bytes))), () => {});
  }
  return section;
}
