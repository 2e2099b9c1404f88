// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

import { Maker } from "../types";
import { Child, html, trusted } from "../components/markup";

/// A whole page that needs no other file and no network; its content policy forbids both. `data`:
/// JSON by id that stands in the page; <attachment:NAME> is replaced by the program that writes it.
export function documentPage(options: {
  title: string;
  summary: Child;
  body: Child;
  maker: Maker;
  data: { id: string; attachment: string }[];
  hasViewer: boolean;
}): string {
  const scripts = options.hasViewer ? "script-src 'unsafe-inline'; " : "";
  const data = options.data.map((one) =>
    html`<script type="application/json" id="${one.id}">${trusted("<attachment:" + one.attachment + ">")}</script>
`);
  return html`<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="${trusted("default-src 'none'; " + scripts + "style-src 'unsafe-inline'; img-src data: blob:")}">
<meta name="generator" content="Palmar ${options.maker.version}">
<title>${options.title}</title>
<style>${trusted("<attachment:style>")}</style>
</head>
<body>
<header><h1>${options.title}</h1>${options.summary}</header>
<main>
${options.body}</main>
<footer><p>Made by Palmar ${options.maker.version}. This file works without a network.</p></footer>
${data}${options.hasViewer && html`<script>${trusted("<attachment:viewer>")}</script>
`}</body>
</html>
`.text;
}
