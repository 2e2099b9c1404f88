// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/draw_modules.mjs [--check]
//
// Reads modules.txt of both houses (src/palmar, src/hands) and every #include of production code, and writes
// docs/developing/modules.md and the drawing docs/developing/modules.svg. With --check it writes nothing
// and ends with 1 unless both show the present modules and arrows; lines of code aren't compared.
import { existsSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));
const houses = ["palmar", "hands"];  // each may use those before it
const page_path = join(root, "docs", "developing", "modules.md");
const drawing_path = join(root, "docs", "developing", "modules.svg");

// ---- What there is ------------------------------------------------------------------------------

/** [{house, name, purpose}] of the houses' modules.txt, bottom to top. */
function read_modules() {
  return houses.flatMap((house) => readFileSync(join(root, "src", house, "modules.txt"), "utf8").split("\n")
    .map((line) => /^([a-z_]+):\s*(.*)$/.exec(line)).filter(Boolean)
    .map(([, name, purpose]) => ({ house, name, purpose })));
}

function code_files(folder) {
  if (!existsSync(folder)) return [];
  return readdirSync(folder, { withFileTypes: true, recursive: true })
    .filter((entry) => entry.isFile() && /\.(h|cpp)$/.test(entry.name))
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name)).sort();
}

/**
 * Every file of the modules and programs: path, module, text, includes, and whether it is test code. Test code is
 * what includes GoogleTest, and what only such files include.
 */
function read_code(modules) {
  const files = new Map();
  const read = (folder, module) => {
    for (const path of code_files(folder)) {
      const text = readFileSync(path, "utf8");
      const includes = [...text.matchAll(/^#include "([^"]+)"/gm)].map((match) => match[1]);
      files.set(relative(join(root, "src"), path).replaceAll("\\", "/"),
                { module, lines: text.split("\n").length - 1, includes,
                  is_test: /^#include <(gtest|gmock)\//m.test(text) });
    }
  };
  for (const { house, name } of modules) read(join(root, "src", house, name), name);
  for (const program of programs()) read(program === "python" ? join(root, program) : join(root, "apps", program), program);
  for (let has_changed = true; has_changed;) {
    has_changed = false;
    const users = new Map();
    for (const file of files.values()) {
      for (const include of file.includes) users.set(include, [...(users.get(include) ?? []), file]);
    }
    for (const [path, file] of files) {
      const of_header = users.get(path) ?? [];
      if (path.endsWith(".h") && !file.is_test && of_header.length > 0 && of_header.every((user) => user.is_test)) {
        file.is_test = true;
        has_changed = true;
      }
    }
  }
  return files;
}

/** What stands on the modules: what command lines share, the programs, and the Python package. */
function programs() {
  return readdirSync(join(root, "apps"), { withFileTypes: true })
    .filter((entry) => entry.isDirectory() && existsSync(join(root, "apps", entry.name, "CMakeLists.txt")))
    .map((entry) => entry.name).sort().concat("python");
}
const shared = "command_line";  // the part of apps that programs include

/** uses: name -> modules (and the shared part of apps) that its production code includes, in their order. */
function arrows(modules, files) {
  const order = [...modules.map(({ name }) => name), shared];
  const uses = new Map([...modules.map(({ name }) => name), ...programs()].map((name) => [name, new Set()]));
  const place = new Map(modules.map(({ house, name }) => [`${house}/${name}`, name]));
  const is_shared = (include) => !include.startsWith("..") && existsSync(join(root, "apps", shared, include));
  for (const file of files.values()) {
    if (file.is_test) continue;
    for (const include of file.includes) {
      const other = place.get(include.split("/").slice(0, 2).join("/")) ??
        (programs().includes(file.module) && is_shared(include) ? shared : undefined);
      if (other !== undefined && other !== file.module) uses.get(file.module).add(other);
    }
  }
  return new Map([...uses].map(([name, set]) => [name, order.filter((other) => set.has(other))]));
}

/** The arrows that no chain of other arrows implies. */
function without_implied(uses) {
  const reach = new Map();
  const reached = (name) => {
    if (!reach.has(name)) reach.set(name, new Set(uses.get(name).flatMap((other) => [other, ...reached(other)])));
    return reach.get(name);
  };
  return new Map([...uses].map(([name, others]) =>
    [name, others.filter((other) => !others.some((between) => between !== other && reached(between).has(other)))]));
}

// ---- The drawing: layers by the longest chain, dummy points where an arrow passes a layer ----------

const box = { width: 128, height: 38 };
const gap = { x: 34, y: 42 };

function lay_out(uses) {
  const direct = without_implied(uses);
  const layer = new Map();
  const layer_of = (name) => {
    if (!layer.has(name)) layer.set(name, Math.max(-1, ...uses.get(name).map(layer_of)) + 1);
    return layer.get(name);
  };
  for (const name of uses.keys()) layer_of(name);
  const program_layer = Math.max(...layer.values());
  for (const program of programs()) if (program !== shared) layer.set(program, program_layer);

  const rows = Array.from({ length: program_layer + 1 }, () => []);
  const nodes = new Map();
  const add = (id, row, width) => {
    nodes.set(id, { id, row, width, below: [], above: [], x: 0 });
    rows[row].push(id);
  };
  for (const name of uses.keys()) add(name, layer.get(name), box.width);
  const chains = [];  // of each arrow: the nodes that it passes, from user to used
  for (const [name, others] of direct) {
    for (const other of others) {
      const chain = [name];
      for (let row = layer.get(name) - 1; row > layer.get(other); --row) {
        const id = `→${other}@${row}`;  // arrows to one module share their way down
        if (!nodes.has(id)) add(id, row, 8);
        chain.push(id);
      }
      chain.push(other);
      chains.push(chain);
    }
  }
  const linked = new Set();
  for (const chain of chains) {
    for (let i = 0; i + 1 < chain.length; ++i) {
      if (linked.has(chain[i] + "|" + chain[i + 1])) continue;
      linked.add(chain[i] + "|" + chain[i + 1]);
      nodes.get(chain[i]).below.push(chain[i + 1]);
      nodes.get(chain[i + 1]).above.push(chain[i]);
    }
  }

  // Order within the rows: medians of the neighbours, up and down; the order with the fewest crossings is kept.
  const place_of = () => new Map(rows.flatMap((row) => row.map((id, index) => [id, index])));
  const crossings = () => {
    const place = place_of();
    let count = 0;
    for (const row of rows) {
      const links = row.flatMap((id) => nodes.get(id).below.map((other) => [place.get(id), place.get(other)]));
      for (let i = 0; i < links.length; ++i) {
        for (let j = 0; j < i; ++j) {
          if ((links[i][0] - links[j][0]) * (links[i][1] - links[j][1]) < 0) ++count;
        }
      }
    }
    return count;
  };
  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;
  let best = { count: Infinity, rows: [] };
  for (let sweep = 0; sweep < 60; ++sweep) {
    const side = sweep % 2 === 0 ? "below" : "above";
    const order = rows.keys();
    for (const r of side === "below" ? order : [...order].reverse()) {
      const place = place_of();
      const key = (id) => {
        const others = nodes.get(id)[side];
        return others.length > 0 ? mean(others.map((other) => (place.get(other) + 0.5) / rows[nodes.get(other).row].length))
                                 : (place.get(id) + 0.5) / rows[r].length;
      };
      const keys = new Map(rows[r].map((id) => [id, key(id)]));
      rows[r].sort((a, b) => keys.get(a) - keys.get(b));
    }
    // Neighbours change places where that saves crossings.
    for (const row of rows) {
      for (let i = 0; i + 1 < row.length; ++i) {
        const before = crossings();
        [row[i], row[i + 1]] = [row[i + 1], row[i]];
        if (crossings() >= before) [row[i], row[i + 1]] = [row[i + 1], row[i]];
      }
    }
    const count = crossings();
    if (count < best.count) best = { count, rows: rows.map((row) => [...row]) };
  }
  rows.splice(0, rows.length, ...best.rows);

  // Places: each node goes to the mean of its neighbours as far as those beside it leave room.
  for (const row of rows) {
    let x = 0;
    for (const id of row) {
      nodes.get(id).x = x + nodes.get(id).width / 2;
      x += nodes.get(id).width + gap.x;
    }
    for (const id of row) nodes.get(id).x -= x / 2;
  }
  const room = (a, b) => (nodes.get(a).width + nodes.get(b).width) / 2 + gap.x;
  for (let round = 0; round < 1000; ++round) {
    for (const row of rows) {
      for (const id of row) {
        const node = nodes.get(id);
        const passes = (other) => id.startsWith("→") && other.startsWith("→");  // long arrows run straight
        const others = [...node.below, ...node.above].flatMap((other) => Array(passes(other) ? 8 : 1).fill(nodes.get(other).x));
        if (others.length > 0) node.x += 0.5 * (mean(others) - node.x);
      }
      for (let pass = 0; pass < 8; ++pass) {
        for (let i = 0; i + 1 < row.length; ++i) {
          const [a, b] = [nodes.get(row[i]), nodes.get(row[i + 1])];
          const lack = room(row[i], row[i + 1]) - (b.x - a.x);
          if (lack > 0) {
            a.x -= lack / 2;
            b.x += lack / 2;
          }
        }
      }
    }
  }
  return { nodes, chains, rows };
}

function draw(modules, uses) {
  const { nodes, chains, rows } = lay_out(uses);
  const margin = 28;
  const left = Math.min(...[...nodes.values()].map((node) => node.x - node.width / 2)) - margin;
  const right = Math.max(...[...nodes.values()].map((node) => node.x + node.width / 2)) + margin;
  const x_of = (id) => Math.round(nodes.get(id).x - left);
  const y_of = (id) => margin + (rows.length - 1 - nodes.get(id).row) * (box.height + gap.y);
  const width = Math.round(right - left);
  const height = rows.length * (box.height + gap.y) - gap.y + 2 * margin;
  const purpose = new Map(modules.map(({ name, purpose: text }) => [name, text]));
  const kind = new Map(modules.map(({ house, name }) => [name, house === "hands" ? "hands" : "module"]));
  const kind_of = (name) => kind.get(name) ?? (name === shared ? "shared" : "program");

  // Where the arrows leave and meet a box: side by side, in the order of where they come from.
  const port = (name, side, other) => {
    const others = [...nodes.get(name)[side]].sort((a, b) => nodes.get(a).x - nodes.get(b).x);
    const step = Math.min(18, (box.width - 24) / Math.max(1, others.length));
    return x_of(name) + Math.round((others.indexOf(other) - (others.length - 1) / 2) * step);
  };
  const lines = new Set();
  for (const chain of chains) {
    for (let i = 0; i + 1 < chain.length; ++i) {
      const [from, to] = [chain[i], chain[i + 1]];
      const from_box = i === 0;
      const to_box = i + 2 === chain.length;
      const x0 = from_box ? port(from, "below", to) : x_of(from);
      const x1 = to_box ? port(to, "above", from) : x_of(to);
      const y0 = from_box ? y_of(from) + box.height : y_of(from) + box.height / 2;
      const y1 = to_box ? y_of(to) - 7 : y_of(to) + box.height / 2;
      const bend = Math.round((y1 - y0) * 0.45);
      lines.add(`<path d="M${x0} ${y0}C${x0} ${y0 + bend} ${x1} ${y1 - bend} ${x1} ${y1}"` +
                `${to_box ? ' marker-end="url(#tip)"' : ""}/>`);
    }
  }
  const escape = (text) => text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
  const boxes = [...uses.keys()].map((name) => {
    const x = x_of(name) - box.width / 2;
    return `<g class="${kind_of(name)}"><title>${escape(purpose.get(name) ?? "program")}</title>` +
      `<rect x="${x}" y="${y_of(name)}" width="${box.width}" height="${box.height}" rx="7"/>` +
      `<text x="${x_of(name)}" y="${y_of(name) + box.height / 2 + 5}">${escape(name)}</text></g>`;
  });
  // What the colours mean, at the bottom on the left: the lowest rows have one or two boxes in the middle.
  const colours = [["program", "programs"], ["shared", "shared by programs"], ["hands", "src/hands"], ["module", "src/palmar"]];
  const legend = colours.map(([name, text], i) => {
    const y = height - margin - (colours.length - i) * 26;
    return `<g class="${name}"><rect x="${margin}" y="${y}" width="30" height="16" rx="4"/>` +
      `<text class="legend" x="${margin + 40}" y="${y + 13}">${text}</text></g>`;
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}" role="img" aria-labelledby="title">
<title id="title">Modules of Palmar: each uses what its arrows point to, and what that uses</title>
<defs><marker id="tip" viewBox="0 0 8 8" refX="1" refY="4" markerWidth="7" markerHeight="7" markerUnits="userSpaceOnUse" orient="auto"><path d="M0 0.5L8 4L0 7.5Z" fill="#6b7a8d"/></marker></defs>
<style>
  .ground { fill: #ffffff }
  .arrows path { fill: none; stroke: #8b98a8; stroke-width: 1.5 }
  .module rect { fill: #eaf1f8; stroke: #4a6f94; stroke-width: 1.3 }
  .hands rect { fill: #e9f5ec; stroke: #4c8a5d; stroke-width: 1.3 }
  .shared rect { fill: #ffffff; stroke: #b07a2a; stroke-width: 1.3; stroke-dasharray: 5 3 }
  .program rect { fill: #fdf3e4; stroke: #b07a2a; stroke-width: 1.3 }
  text { font: 600 15px system-ui, "Segoe UI", "DejaVu Sans", sans-serif; fill: #1f2d3d; text-anchor: middle }
  text.legend { text-anchor: start; font-weight: 400 }
</style>
<rect class="ground" width="${width}" height="${height}" rx="10"/>
<g class="arrows">
${[...lines].join("\n")}
</g>
${boxes.join("\n")}
${legend.join("\n")}
</svg>
`;
}

// ---- The page -----------------------------------------------------------------------------------

function page(modules, files, uses) {
  const lines = (name, is_test) => [...files.values()]
    .filter((file) => file.module === name && file.is_test === is_test)
    .reduce((sum, file) => sum + file.lines, 0);
  const row = (name, purpose) => `| \`${name}\` | ${purpose} | ${uses.get(name).join(", ") || "–"} | ` +
    `${lines(name, false)} | ${lines(name, true)} |`;
  const names = [...modules.map(({ name }) => name), ...programs()];
  const sum = (these, is_test) => these.reduce((total, name) => total + lines(name, is_test), 0);
  const of_house = (house) => modules.filter((module) => module.house === house);
  const table = (rows, title, these) => `| module | what it is | uses | lines | of tests |
|---|---|---|---:|---:|
${rows.join("\n")}
| | ${title} | | ${sum(these, false)} | ${sum(these, true)} |`;
  const house_table = (house, title) =>
    table(of_house(house).map(({ name, purpose }) => row(name, purpose)), title, of_house(house).map(({ name }) => name));
  const program_purpose = {
    [shared]: "what the programs' command lines share: help, messages, progress, options of several commands",
    palmar: "program: assess, contact, doctor, effort, grasp, hand, population, product, study",
    "palmar-hands": "program: hands from MR images, scans and photographs; mri, phantom, photos",
    "palmar-redesign": "program: redesign, validate",
    "palmar-serve": "program: serve, the workbench",
    "palmar-cad": "child: reads and writes STEP; `palmar` and `palmar-redesign` start it",
    "palmar-dicom": "child: unpacks compressed DICOM pixels; `palmar-hands` starts it",
    "palmar-photo": "child: finds the board in photographs; `palmar-hands` starts it",
    python: "Python package `palmar`: the extension over the tasks (its Python isn't counted)",
  };
  return `<!-- Made by: node scripts/draw_modules.mjs. Edit the script or a modules.txt, not this page. -->
# Modules

The sources are two houses. \`src/palmar\` is Palmar: hands, products, contact, studies, redesigns. \`src/hands\` makes hands
from measurements of people. Palmar uses nothing of it; a hand and what is known of a person go from one to the other in
files alone (\`*.hand.glb\`, \`person.toml\`).

The folders of a house are its modules. Their order stands in the house's \`modules.txt\`, and CMake, a test and this
page read it there. A module includes and links only modules that come before it, and those of \`src/hands\` any
module of Palmar: \`cmake/PalmarModule.cmake\` refuses a link against the order, and the test \`layers\` refuses such an
\`#include\` and folders inside a module that include each other in a circle. Each module has a namespace of its own
(\`palmar::contact\`); \`core\` alone stands in \`palmar\`. The test \`types\` refuses a type that is defined twice at one
namespace.

![Modules of both houses and the programs, bottom to top](modules.svg)

Each module uses what its arrows point to. An arrow that follows from others is left out of the drawing; the tables have
all of them. Only production code counts.

## Palmar (\`src/palmar\`)

${house_table("palmar", "together")}

## From people to hands (\`src/hands\`)

${house_table("hands", "together")}

## Programs (\`apps\`, \`python\`)

${table(programs().map((name) => row(name, program_purpose[name] ?? "program")), "together", programs())}

All of it has ${sum(names, false)} lines, and ${sum(names, true)} of tests beside the sources.

\`X.h\`, \`X.cpp\` and \`X_test.cpp\` are side by side. Users' files are read and written in \`formats\` and
\`records\`, images and files of persons in \`images\` and \`person_records\`, CAD files by the kernel in \`cad\`. Only the
programs in \`apps\` read arguments, print or exit; \`python\` is the same tasks for Python. Tests of whole programs are in
\`tests/\`, benchmarks in \`benchmarks/\`.

## The values that flow

\`TriangleMesh\` → \`Product\` (mesh, signed distance, unit and how it was known).
\`Hand\` (skin, skeleton, weights, bones, segments, regions, dimensions, tissue, provenance) → \`PreparedHand\` (geodesics
and responses).
\`Posture\` → posed skin → \`Grasp\` (posture, \`product_from_hand\`, what stopped each segment) → \`ContactResult\` →
\`Assessment\` → \`AssessmentSet\` → report.
None of these values is changed once it is made.
`;
}

// ---- The command ----------------------------------------------------------------------------------

const modules = read_modules();
const files = read_code(modules);
const uses = arrows(modules, files);
const new_page = page(modules, files, uses);
const new_drawing = draw(modules, uses);

const is_check = process.argv.includes("--check");
const without_lines = (text) => text.replace(/ \d+ \| \d+ \|$/gm, "").replace(/^All of it has .*$/m, "");
const read = (path) => (existsSync(path) ? readFileSync(path, "utf8") : "");
if (is_check) {
  const stale = [];
  if (without_lines(read(page_path)) !== without_lines(new_page)) stale.push(page_path);
  if (read(drawing_path) !== new_drawing) stale.push(drawing_path);
  if (stale.length > 0) {
    console.error(`Not up to date with modules.txt and the includes: ${stale.map((path) => relative(root, path)).join(", ")}.\n` +
                  "Run: node scripts/draw_modules.mjs");
    process.exit(1);
  }
  console.log(`${modules.length} modules: page and drawing are up to date`);
} else {
  writeFileSync(page_path, new_page);
  writeFileSync(drawing_path, new_drawing);
  console.log(`Wrote ${relative(root, page_path)} and ${relative(root, drawing_path)}`);
}
