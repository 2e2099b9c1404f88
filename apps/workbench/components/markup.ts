// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

export type Child = Markup | string | number | null | undefined | false | Children;
export interface Children extends Array<Child> {}

/// HTML that is safe to put into a page. Only html`` and trusted() make it.
export class Markup {
  constructor(readonly text: string) {}
  toString(): string {
    return this.text;
  }
}

const entities: { [character: string]: string } = {
  "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&#39;",
};

/// Text made safe inside elements and attributes; control characters become U+FFFD.
export function escaped(text: string): string {
  if (!/[&<>"'\u0000-\u0008\u000b\u000c\u000e-\u001f]/.test(text)) return text;
  return text.replace(/[&<>"'\u0000-\u0008\u000b\u000c\u000e-\u001f]/g,
                      (one) => entities[one] || "\ufffd");
}

/// Markup from elsewhere whose maker is Palmar, such as a figure.
export function trusted(text: string): Markup {
  return new Markup(text);
}

function append(parts: string[], child: Child): void {
  if (child === null || child === undefined || child === false) return;
  if (child instanceof Markup) parts.push(child.text);
  else if (typeof child === "string") parts.push(escaped(child));
  else if (typeof child === "number") parts.push(String(child));
  else for (const one of child) append(parts, one);
}

/// html`<td>${text}</td>`: what is put in is escaped unless it is markup; lists are joined; null
/// and false leave nothing.
export function html(fixed: TemplateStringsArray, ...children: Child[]): Markup {
  const parts: string[] = [fixed[0]];
  for (let i = 0; i < children.length; ++i) {
    append(parts, children[i]);
    parts.push(fixed[i + 1]);
  }
  return new Markup(parts.join(""));
}

/// Markup with something between.
export function joined(list: Child[], between: Child): Markup {
  const all: Child[] = [];
  for (const one of list) {
    if (all.length > 0) all.push(between);
    all.push(one);
  }
  return html`${all}`;
}
