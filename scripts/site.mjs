// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/site.mjs PALMAR OUT
//
// The documents as a static site in the folder OUT: README.md as its first page, docs/, the changelog, every
// command with its options (from what `palmar COMMAND --help` prints), and all pictures on one page. Ends with 1
// and a list if a link leads nowhere.
import {marked} from "marked";
import {spawnSync} from "node:child_process";
import {cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync, writeFileSync} from "node:fs";
import {dirname, join, posix} from "node:path";
import {fileURLToPath} from "node:url";
import {walk} from "./manual.mjs";

const source = join(dirname(fileURLToPath(import.meta.url)), "..");
const escaped = (text) => text.replace(/[&<>"]/g, (one) => ({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;"})[one]);

/** As GitHub makes the names of headings: the documents' own links are made for that. */
const slugOf = (text) => text.toLowerCase().replace(/<[^>]*>/g, "").replace(/[^\p{L}\p{N} _-]/gu, "").replaceAll(" ", "-");

const filesIn = (folder) => readdirSync(join(source, folder), {withFileTypes: true}).flatMap((one) =>
  one.isDirectory() ? filesIn(posix.join(folder, one.name)) : [posix.join(folder, one.name)]);

/** Where a document stands in the site. */
function placeOf(file) {
  if (file === "README.md") return "index.html";
  return file.replace(/README\.md$/, "index.html").replace(/\.md$/, ".html");
}

const broken = [];
const pages = new Map();  // place -> {title, html, anchors, links}
const pictures = new Map();  // place -> {caption, page}

function addMarkdown(file) {
  const place = placeOf(file), page = {title: file, html: "", anchors: new Set(), links: [], file};
  const counts = new Map();
  /** A link of this document as one of the site; null: of the repository, but not of the site. */
  const inSite = (href) => {
    if (/^[a-z]+:/.test(href)) return href;
    const [path, anchor = ""] = href.split("#");
    const target = path === "" ? file : posix.normalize(posix.join(posix.dirname(file), path));
    const isFolder = existsSync(join(source, target)) && statSync(join(source, target)).isDirectory();
    if (!existsSync(join(source, target))) {
      broken.push(`${file}: ${href}`);
      return null;
    }
    const document = isFolder && existsSync(join(source, target, "README.md")) ? posix.join(target, "README.md") : target;
    const isPage = document.endsWith(".md") && (document.startsWith("docs/") || ["README.md", "CHANGELOG.md"].includes(document));
    if (isPage) page.links.push([placeOf(document), anchor, href]);
    else if (!/^docs\/.*\.(png|svg)$/.test(document)) return null;
    const to = posix.relative(posix.dirname(place), isPage ? placeOf(document) : document);
    return to + (anchor ? `#${anchor}` : "");
  };
  const renderer = new marked.Renderer();
  renderer.heading = (text, depth, raw) => {
    const slug = slugOf(raw), count = counts.get(slug) ?? 0;
    counts.set(slug, count + 1);
    const id = count === 0 ? slug : `${slug}-${count}`;
    page.anchors.add(id);
    if (depth === 1) page.title = text.replace(/<[^>]*>/g, "");
    return `<h${depth} id="${id}">${text}</h${depth}>\n`;
  };
  renderer.link = (href, title, text) => {
    const to = inSite(href);
    return to === null ? text : `<a href="${escaped(to)}">${text}</a>`;
  };
  renderer.image = (href, title, text) => {
    const to = inSite(href);
    if (to !== null) pictures.set(posix.normalize(posix.join(posix.dirname(place), to)), {caption: text, page: place});
    return `<img src="${escaped(to ?? href)}" alt="${escaped(text)}">`;
  };
  page.html = marked.parse(readFileSync(join(source, file), "utf8"), {renderer, gfm: true});
  pages.set(place, page);
}

/** A page per command, one that lists them. */
function addReference(palmar) {
  const all = walk((words) => {
    const run = spawnSync(palmar, [...words, "--help"], {encoding: "utf8"});
    if (run.status === 0) return run.stdout;
    if (run.status !== 6) throw new Error(run.stderr);
    process.stderr.write(run.stderr);  // its program isn't built: the page says so
    return run.stderr;
  });
  const placeOfCommand = (words) => `reference/${["palmar", ...words].join("-")}.html`;
  const list = all.map(({words, page}) =>
    `<tr><td><a href="${posix.basename(placeOfCommand(words))}">${["palmar", ...words].join(" ")}</a></td><td>${escaped(page.about)}</td></tr>`);
  pages.set("reference/index.html", {title: "Commands", anchors: new Set(), links: [],
    html: `<h1>Commands</h1><table>${list.join("\n")}</table>`});
  for (const {words, page} of all) {
    const name = ["palmar", ...words].join(" ");
    const sections = page.sections.map((one) => `<h2>${escaped(one.title)}</h2><table>${one.items.map(({term, text}) => {
      const shown = one.title === "Subcommands"
        ? `<a href="${posix.basename(placeOfCommand([...words, term]))}">${escaped(term)}</a>` : `<code>${escaped(term)}</code>`;
      return `<tr><td>${shown}</td><td>${escaped(text)}</td></tr>`;
    }).join("\n")}</table>`);
    const code = (lines) => `<pre><code>${escaped(lines.join("\n"))}</code></pre>`;
    pages.set(placeOfCommand(words), {title: name, anchors: new Set(), links: [],
      html: `<h1>${name}</h1><p>${escaped(page.about)}</p>${code([page.usage])}` +
        (page.example.length ? `<h2>Example</h2>${code(page.example)}` : "") + sections.join("") +
        (page.ending.length ? `<p>${escaped(page.ending.join(" "))}</p>` : "")});
  }
  return all.length;
}

function addGallery() {
  const items = [...pictures].map(([place, {caption, page}]) =>
    `<figure><a href="${page}"><img src="${place}" alt="${escaped(caption)}"></a><figcaption>${escaped(caption)}</figcaption></figure>`);
  pages.set("gallery.html", {title: "Gallery", anchors: new Set(), links: [], html: `<h1>Gallery</h1>${items.join("\n")}`});
}

const kStyle = `body{margin:0;font:16px/1.5 system-ui,sans-serif;color:#1c2530;display:flex}
nav{flex:0 0 15rem;padding:1rem;background:#f1f4f7;min-height:100vh;box-sizing:border-box;font-size:.9rem}
nav b{display:block;margin-top:.8rem}nav a{display:block;color:#2b4b6f;text-decoration:none;padding:.1rem 0}
nav a.here{font-weight:600}main{flex:1;min-width:0;max-width:60rem;padding:1rem 2rem}a{color:#1d5fa8}
table{border-collapse:collapse;display:block;overflow-x:auto}td,th{border:1px solid #d3dae2;padding:.25rem .6rem;text-align:left;vertical-align:top}
pre{background:#f1f4f7;padding:.7rem;overflow-x:auto}code{font-size:.92em}img{max-width:100%}figure{margin:1rem 0}figcaption{color:#5a6673}
@media(max-width:50rem){body{display:block}nav{min-height:0}}`;

/** Links beside every page. */
function navigation(place) {
  const link = (to, text) =>
    `<a${to === place ? ' class="here"' : ""} href="${posix.relative(posix.dirname(place), to)}">${text}</a>`;
  const group = (folder) => [...pages].filter(([one]) => posix.dirname(one) === folder && posix.basename(one) !== "index.html")
    .sort(([, a], [, b]) => (a.title < b.title ? -1 : 1)).map(([one, page]) => link(one, page.title)).join("");
  return `<nav>${link("index.html", "<strong>Palmar</strong>")}${link("gallery.html", "Gallery")}${link("docs/glossary.html", "Glossary")}` +
    `${link("CHANGELOG.html", "Changes")}<b>Using</b>${link("docs/using/index.html", "By task")}${group("docs/using")}` +
    `<b>Reference</b>${link("reference/index.html", "Commands and options")}${group("docs/using/files")}` +
    `<b>Method</b>${link("docs/method/index.html", "Overview")}${group("docs/method")}` +
    `<b>Developing</b>${link("docs/developing/index.html", "Overview")}${group("docs/developing")}</nav>`;
}

const [palmar, out] = process.argv.slice(2);
if (out === undefined) {
  console.error("usage: node scripts/site.mjs PALMAR OUT");
  process.exit(2);
}
for (const file of ["README.md", "CHANGELOG.md", ...filesIn("docs").filter((one) => one.endsWith(".md"))]) addMarkdown(file);
const commands = addReference(palmar);
addGallery();
for (const page of pages.values()) {
  for (const [place, anchor, href] of page.links) {
    if (!pages.has(place) || (anchor && !pages.get(place).anchors.has(anchor))) broken.push(`${page.file}: ${href}`);
  }
}
rmSync(out, {recursive: true, force: true});
for (const [place, page] of pages) {
  mkdirSync(dirname(join(out, place)), {recursive: true});
  const title = place === "index.html" ? "Palmar" : `${page.title} - Palmar`;
  writeFileSync(join(out, place), `<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">` +
    `<title>${title}</title><style>${kStyle}</style>${navigation(place)}<main>${page.html}</main></html>\n`);
}
for (const file of filesIn("docs").filter((one) => /\.(png|svg)$/.test(one))) {
  mkdirSync(dirname(join(out, file)), {recursive: true});
  cpSync(join(source, file), join(out, file));
}
if (broken.length > 0) {
  console.error(`links that lead nowhere:\n  ${broken.join("\n  ")}`);
  process.exit(1);
}
console.log(`${pages.size} pages, ${commands} of them commands, in ${out}`);
