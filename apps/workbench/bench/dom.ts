// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0

type Attributes = Record<string, string | number | boolean | null | undefined | ((event: Event) => void)>;
type Child = Node | string | null | undefined | false | Child[];

/// An element with attributes ("onclick" and the like take functions) and children.
export function el<K extends keyof HTMLElementTagNameMap>(name: K, attributes: Attributes = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") made.addEventListener(key.slice(2), value);
    else made.setAttribute(key, value === true ? "" : String(value));
  }
  put(made, children);
  return made;
}

function put(into: Element, children: Child[]): void {
  for (const child of children) {
    if (Array.isArray(child)) put(into, child);
    else if (child) into.append(child);
  }
}

/// Replaces what is in an element.
export function fill(into: Element, ...children: Child[]): void {
  into.replaceChildren();
  put(into, children);
}

/// Offers a text as a file.
export function saveText(name: string, text: string): void {
  const link = el("a", { download: name, href: URL.createObjectURL(new Blob([text], { type: "application/json" })) });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
