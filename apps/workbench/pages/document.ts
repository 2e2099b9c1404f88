// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Desk, Maker } from "../types";
import { language, say } from "../texts";
import { Child, Markup, html, trusted } from "../components/markup";
import { Section, contents, sections } from "../components/parts";
import { glossaryEntries, glossaryList } from "../components/glossary";

/// What the report is made for, over its title.
function projectLine(project: NonNullable<Desk["project"]>): Markup {
  return html`<div class="project">${project.logo && html`<img src="${project.logo}" alt="">`}<p>${project.name && html`<strong>${project.name}</strong>`}${project.name && project.author && " · "}${project.author}${project.remarks && html`<br>${project.remarks}`}</p></div>`;
}

/// A whole page that needs no other file and no network; its content policy forbids both. `first`:
/// its first screen; then contents and sections that unfold. `data`: JSON by id that stands in the
/// page; <attachment:NAME> is replaced by the program that writes it.
export function documentPage(options: {
  title: string;
  first: Child;
  sections: (Section | null)[];
  maker: Maker;
  data: { id: string; attachment: string }[];
  hasViewer: boolean;
  desk?: Desk;
}): string {
  const project = options.desk && options.desk.project;
  const data = options.data.map((one) =>
    html`<script type="application/json" id="${one.id}">${trusted("<attachment:" + one.attachment + ">")}</script>
`);
  const all = [...options.sections, { id: "glossary", title: say("section.glossary"), content: glossaryList() }];
  return html`<!DOCTYPE html>
<html lang="${language()}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:">
<meta name="generator" content="Palmar ${options.maker.version}">
<title>${options.title}</title>
<style>${trusted("<attachment:style>")}</style>
</head>
<body${options.desk && options.desk.units === "us" && html` data-units="us"`}>
<a class="skip" href="#answer">${say("page.skip")}</a>
<header>${project && projectLine(project)}<h1>${options.title}</h1><button type="button" class="units" data-metric="${say("units.metric")}" data-us="${say("units.us")}" hidden></button></header>
<main>
${options.first}${contents(all)}${sections(all)}</main>
<footer><p>${say("page.footer", { version: options.maker.version })}</p></footer>
${glossaryEntries()}${data}<script>${trusted("<attachment:page>")}</script>
${options.hasViewer && html`<script>${trusted("<attachment:viewer>")}</script>
`}</body>
</html>
`.text;
}
