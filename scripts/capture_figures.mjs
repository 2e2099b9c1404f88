// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/capture_figures.mjs [--set development|final] [--only photos,scan,quick,mri] [--subjects N]
//                                  [--seeds SEED,SEED] [--program PALMAR --commit HASH] [--page]
//
// How far hands from photographs, scans, one photograph and MR images are off, from scratch: makes free persons
// (docs/method/phantom.md) of the seeds in docs/method/capture_seeds.toml, gives their pictures to the program that
// people use, and compares with the truth. A case that ends in a refusal or breaks down is a row of the table like
// any other. --subjects: only the first N seeds of each kind; --seeds: only these of the set's. --page: puts the tables into docs/method, with date
// and commit. Seeds for development may be looked at as often as one likes; those of the final run are for one run
// after all decisions.
//
// A case that was finished isn't run again while the program is the same file (build/capture_figures/SET). Two
// cores: photographs 5 min a case, scans 1 to 2, one photograph 10 s, MR images 6.
import { execFileSync, spawnSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const root = dirname(dirname(fileURLToPath(import.meta.url)));

function option(name, otherwise) {
  const k = process.argv.indexOf(name);
  return k < 0 ? otherwise : process.argv[k + 1];
}

const set = option("--set", "development");
const program = option("--program", join(root, "build", "release", "bin", "palmar"));
const most = Number(option("--subjects", "1000"));
const chosen = option("--seeds", "").split(",").filter(Boolean).map(Number);
const folder = join(root, "build", "capture_figures", set);
/** Of everything that makes and measures: the program and those that it starts. */
const version = ["palmar", "palmar-hands", "palmar-photo", "palmar-dicom"].map((name) => join(dirname(program), name))
  .filter(existsSync).reduce((hash, file) => hash.update(readFileSync(file)), createHash("sha256")).digest("hex");

/** Seeds by kind of one set: lines `photos = [1, 2]` under `[development]` or `[final]`. */
function read_seeds() {
  const seeds = {};
  let here = "";
  for (const line of readFileSync(join(root, "docs", "method", "capture_seeds.toml"), "utf8").split("\n")) {
    const head = /^\[(\w+)\]/.exec(line);
    if (head) here = head[1];
    const row = /^(\w+) = \[([\d, ]*)\]/.exec(line);
    if (row && here === set) seeds[row[1]] = row[2].split(",").map(Number);
  }
  if (!Object.keys(seeds).length) throw new Error(`capture_seeds.toml has no set "${set}"`);
  return seeds;
}

// ---- What is made and measured ------------------------------------------------------------------

/** Skins and sides go round with the seeds. */
const skins = ["#e0b59c", "#cc9980", "#a87558", "#6b4733"];
const skin_names = ["light", "light", "middle", "dark"];
const tables = ["wood", "grey", "blue", "dark"], card_tables = ["grey", "blue"]; // a card must not lie on wood
const skin_of = (seed) => ["--skin-colour", skins[seed % skins.length]];
const side_of = (seed) => ["--side", seed % 2 ? "right" : "left"];

/** What photographers and cameras do: lenses beyond the calibrated model, JPEG, a skin that shines a little. */
const cameras = ["--jpeg", "70", "--decentring", "0.0005", "--sixth", "0.05", "--vignetting", "0.3", "--tone", "0.3",
  "--gloss", "0.04", "--noise", "6"];

/** What scanners do: fat off by a voxel, edges that ring, a coil that falls to 0.4, uneven marrow, masked air. */
const scanner = ["--fat-shift-mm", "0.8", "--acquired", "0.8", "--marrow-texture", "0.12", "--mask", "3", "--bias", "0.6"];

const kinds = {
  photos: {
    title: "Photographs",
    page: "photos.md",
    cases: {
      "standing still": [],
      "moves": ["--motion-mm", "1", "--motion-deg", "0.5", "--finger-motion-mm", "1"],
    },
    make: (seed, words) => ["phantom", "photos", "--free", ...cameras, ...skin_of(seed), ...side_of(seed), ...words],
    find: () => ["hand", "from-photos", "person/photos", "--posture", "person/photos=reference", "--lenses",
      "person/calibration", "--truth", "person/truth/subject.json", "--out", "a.hand.glb", "--work", "w"],
    measure: (at, found) => ({ ...skeleton_errors(at, found), ...surface_errors(at) }),
  },
  scan: {
    title: "Scans",
    page: "scan.md",
    cases: { "lines and dots": [], "no lines": ["--no-creases"] },
    make: (seed, words) => ["phantom", "scan", "--free", ...skin_of(seed), ...side_of(seed), ...words],
    find: () => ["hand", "from-scan", "person/scan/reference.ply", "person/scan/finger_flexion.ply", "person/scan/finger_abduction.ply", "--truth", "person/truth/subject.json", "--out", "a.hand.glb", "--work", "w"],
    measure: skeleton_errors,
  },
  quick: {
    title: "One photograph",
    page: "outline.md",
    cases: { "sheet": [], "card": ["--sheet", "card"] }, // both for making and for finding
    make: (seed, words) => ["phantom", "sheet", "--free", ...side_of(seed), "--skin", skin_names[seed % 4],
      "--table", words.length ? card_tables[(seed >> 2) % 2] : tables[(seed >> 2) % 4], "--tilt-deg", String(2 + seed % 9), ...words],
    find: (words) => ["hand", "quick", "person/photo.jpg", "--out", "a.hand.glb", ...words],
    measure: quick_errors,
  },
  mri: {
    title: "MR images",
    page: "mri.md",
    cases: { "surface coil": [] },
    make: (seed, words) => ["phantom", "mri", "--free", ...side_of(seed), ...scanner, ...words],
    find: () => ["hand", "from-mri", "person/mri", "--out", "a.hand.glb", "--work", "w", "--no-report"],
    measure: image_errors,
  },
};

const rows_of = (file) => readFileSync(file, "utf8").trim().split("\n").map((row) => row.split(","));
const mean = (values) => values.reduce((sum, v) => sum + v, 0) / values.length;
const root_mean_square = (values) => Math.sqrt(mean(values.map((v) => v * v)));

/** Errors of dimensions, axes and places, as the program compares itself with the truth. */
function skeleton_errors(at, found) {
  const result = { length: [], width: [], thickness: [], girth: [], pip: [], place: [], axes: [] };
  const by_dots = {};
  for (const joint of found.joints_by_dots) by_dots[joint.segment] = joint.axis_error_deg;
  for (const [what, posture, segment, difference, axis] of rows_of(join(at, "w", "truth_errors.csv")).slice(1)) {
    const off = Number(difference);
    const kind = /(length|width|thickness|circumference)$/.exec(what);
    if (kind) result[kind[1] === "circumference" ? "girth" : kind[1]].push(off);
    if (what === "hand_length") result.hand = off;
    if (what !== "joint" || posture !== "reference" || !/_(middle|distal|proximal)$/.test(segment)) continue;
    if (/_middle$/.test(segment)) {
      result.pip.push(Number(axis));
      result.place.push(off);
    }
    // An axis' stated error is that of either direction: 95 % lie within 2.45 of it.
    if (segment in by_dots) result.axes.push(Number(axis) / (2.448 * by_dots[segment]));
  }
  return result;
}

/** Vertices (and a property of each) and triangles of a binary PLY. */
function read_ply(file) {
  const bytes = readFileSync(file);
  const end = bytes.indexOf("end_header") + "end_header\n".length;
  const sizes = { double: 8, float: 4, uchar: 1, int: 4, uint: 4, char: 1, short: 2, ushort: 2 };
  const elements = [];
  for (const line of bytes.toString("latin1", 0, end).split("\n")) {
    const words = line.split(" ");
    if (words[0] === "element") elements.push({ name: words[1], count: Number(words[2]), properties: [] });
    if (words[0] === "property") elements.at(-1).properties.push({ type: words[1], name: words.at(-1) });
  }
  const read = { double: (o) => bytes.readDoubleLE(o), float: (o) => bytes.readFloatLE(o), uchar: (o) => bytes[o] };
  const vertex = elements.find((e) => e.name === "vertex");
  const places = {};
  let stride = 0;
  for (const { type, name } of vertex.properties) {
    places[name] = { type, offset: stride };
    stride += sizes[type];
  }
  const value = (k, name) => read[places[name].type](end + k * stride + places[name].offset);
  const points = [];
  for (let k = 0; k < vertex.count; ++k) points.push([value(k, "x"), value(k, "y"), value(k, "z")]);
  const triangles = [];
  for (let offset = end + vertex.count * stride, k = 0; k < elements[1].count; ++k, offset += 13) {
    triangles.push([bytes.readInt32LE(offset + 1), bytes.readInt32LE(offset + 5), bytes.readInt32LE(offset + 9)]);
  }
  const measured = "measured" in places ? points.map((_, k) => value(k, "measured") > 0) : points.map(() => true);
  return { points, triangles, measured };
}

const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Squared distance of a point to a triangle (Ericson 2005, 5.1.5). */
function to_triangle(p, a, b, c) {
  const ab = minus(b, a), ac = minus(c, a), ap = minus(p, a);
  const at = (v, w) => {
    const d = [ap[0] - v * ab[0] - w * ac[0], ap[1] - v * ab[1] - w * ac[1], ap[2] - v * ab[2] - w * ac[2]];
    return dot(d, d);
  };
  const d1 = dot(ab, ap), d2 = dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return at(0, 0);
  const bp = minus(p, b), d3 = dot(ab, bp), d4 = dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return at(1, 0);
  const vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return at(d1 / (d1 - d3), 0);
  const cp = minus(p, c), d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return at(0, 1);
  const vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return at(0, d2 / (d2 - d6));
  const va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const w = (d4 - d3) / (d4 - d3 + d5 - d6);
    return at(1 - w, w);
  }
  const sum = va + vb + vc;
  return at(vb / sum, vc / sum);
}

/** Distances of points to a surface, mm; those beyond 6 mm count as 6. */
function distances(points, surface) {
  const cell = 3, cells = new Map();
  const key = (x, y, z) => (x + 512) * 1048576 + (y + 512) * 1024 + z + 512;
  surface.triangles.forEach((t, k) => {
    const corners = t.map((v) => surface.points[v]);
    const low = [0, 1, 2].map((d) => Math.floor(Math.min(...corners.map((p) => p[d])) / cell));
    const high = [0, 1, 2].map((d) => Math.floor(Math.max(...corners.map((p) => p[d])) / cell));
    for (let x = low[0]; x <= high[0]; ++x)
      for (let y = low[1]; y <= high[1]; ++y)
        for (let z = low[2]; z <= high[2]; ++z) {
          const at = key(x, y, z);
          if (!cells.has(at)) cells.set(at, []);
          cells.get(at).push(k);
        }
  });
  return points.map((p) => {
    const c = p.map((x) => Math.floor(x / cell));
    let best = 36;
    for (let reach = 0; reach <= 2; ++reach) {
      // What is outside of the cells looked at is at least this far away.
      if (reach > 0 && best <= ((reach - 1) * cell) ** 2) break;
      for (let x = -reach; x <= reach; ++x)
        for (let y = -reach; y <= reach; ++y)
          for (let z = -reach; z <= reach; ++z) {
            if (Math.max(Math.abs(x), Math.abs(y), Math.abs(z)) !== reach) continue;
            for (const k of cells.get(key(c[0] + x, c[1] + y, c[2] + z)) ?? [])
              best = Math.min(best, to_triangle(p, ...surface.triangles[k].map((v) => surface.points[v])));
          }
    }
    return Math.sqrt(best);
  });
}

/** Of the mesh from photographs, in the board's frame, against the skin at the first position. */
function surface_errors(at) {
  const mesh = read_ply(join(at, "w", readdirSync(join(at, "w")).find((name) => /^reference.*\.ply$/.test(name)) ?? "none"));
  const truth = read_ply(join(at, "person", "truth", "reference.ply"));
  const seen = mesh.points.filter((p, k) => mesh.measured[k] && k % 3 === 0 && p[2] > 8);
  const off = distances(seen, truth).sort((a, b) => a - b);
  return {
    surface: mean(off), surface_p95: off[Math.floor(0.95 * off.length)],
    within: off.filter((d) => d < 1).length / off.length,
    measured: mesh.measured.filter(Boolean).length / mesh.measured.length,
  };
}

/** Errors of what was measured and of what follows from it, in mm and in stated deviations. */
function quick_errors(at, found) {
  const truth = JSON.parse(readFileSync(join(at, "person", "truth.json"), "utf8"));
  const result = { measured: {}, other: [], inside: [] };
  for (const [name, { value_mm, sd_mm, how }] of Object.entries(found.dimensions)) {
    const off = value_mm - truth[`${name}_mm`];
    result.inside.push({ name, how, off, sd: sd_mm });
  }
  for (const finger of ["index", "middle", "ring", "little"]) {
    const parts = ["proximal", "middle", "distal"].map((s) => truth[`${finger}_${s}_length_mm`]);
    const length = found.photograph.fingers[finger].length_mm;
    if (length) result.measured[finger] = length - parts[0] - parts[1] - parts[2];
  }
  return result;
}

/** Bones, skin, dimensions and axes from MR images; patient frame. */
function image_errors(at, found) {
  const truth = JSON.parse(readFileSync(join(at, "person", "truth", "subject.json"), "utf8"));
  const bones = { found: 0, wrong: [], distance: [], p95: [] };
  // Fat is shown off water: what was found lies where fat is.
  const { fat_shift_mm } = JSON.parse(readFileSync(join(at, "w", "reference", "scan.json"), "utf8"));
  const placed = (points) => points.map((p) => minus(p, fat_shift_mm));
  const mine = join(at, "w", "reference", "bones"), theirs = join(at, "person", "truth", "reference", "bones");
  for (const file of readdirSync(mine).filter((name) => !/^(radius|ulna)/.test(name))) {
    if (!existsSync(join(theirs, file))) continue; // without a name
    const off = distances(placed(read_ply(join(mine, file)).points), read_ply(join(theirs, file))).sort((a, b) => a - b);
    ++bones.found;
    if (mean(off) > 3) bones.wrong.push(file.replace(".ply", ""));
    else {
      bones.distance.push(mean(off));
      bones.p95.push(off[Math.floor(0.95 * off.length)]);
    }
  }
  const skin = read_ply(join(at, "w", "reference", "skin.ply"));
  const off = distances(placed(skin.points.filter((_, k) => k % 5 === 0)), read_ply(join(at, "person", "truth", "reference", "skin.ply")))
    .filter((d) => d < 5); // the image cuts the forearm
  const result = { bones, skin: mean(off), length: [], width: [], thickness: [], girth: [], axes: [], mcp: [], pip: [] };
  const { segments, ...whole } = found.hand;
  const sizes = { ...whole };
  for (const [segment, its] of Object.entries(segments)) {
    for (const what of ["length", "width", "thickness"]) sizes[`${segment}_${what}_mm`] = its[`${what}_mm`];
  }
  for (const [name, value] of Object.entries(sizes)) {
    const kind = /(length|width|thickness|circumference)_mm$/.exec(name);
    if (kind && name in truth.dimensions) result[kind[1] === "circumference" ? "girth" : kind[1]].push(value - truth.dimensions[name]);
  }
  for (const joint of found.joints) {
    const known = truth.axes_at_reference.find((axis) => axis.joint === joint.dof);
    if (!known || !joint.is_measured) continue;
    const angle = Math.acos(Math.min(1, Math.abs(dot(joint.axis_patient, known.axis)))) * 180 / Math.PI;
    if (/mcp_flexion/.test(joint.dof)) result.mcp.push(angle);
    if (/pip_flexion/.test(joint.dof)) result.pip.push(angle);
    if (joint.axis_error_deg) result.axes.push(angle / (2.448 * joint.axis_error_deg));
  }
  return result;
}

function run_case(kind, seed, name, words) {
  const at = join(folder, `${kind}-${seed}-${name.replaceAll(" ", "_")}`);
  const kept = join(at, "result.json");
  if (existsSync(kept)) {
    const before = JSON.parse(readFileSync(kept, "utf8"));
    if (before.version === version) return before;
  }
  rmSync(at, { recursive: true, force: true });
  mkdirSync(at, { recursive: true });
  console.error(`${kind} ${seed} ${name}`);
  const palmar = (args) => spawnSync(program, ["--json", ...args], { cwd: at, encoding: "utf8", maxBuffer: 1 << 28 });
  const made = palmar(["--seed", String(seed), ...kinds[kind].make(seed, words), "--out", "person"]);
  const result = { version, seed, name };
  const start = Date.now();
  const found = made.status === 0 ? palmar(kinds[kind].find(words)) : made;
  result.seconds = (Date.now() - start) / 1000;
  if (found.status === 0) {
    const json = JSON.parse(found.stdout);
    result.notes = json.notes ?? found.stderr.trim().split("\n");
    Object.assign(result, kinds[kind].measure(at, json));
  } else {
    const said = found.stderr.trim().split("\n").filter((line) => !line.startsWith("\r")).at(-1) ?? "";
    result.refusal = `${made.status === 0 ? "" : "the phantom: "}exit ${found.status ?? found.signal}: ${said}`;
  }
  for (const heavy of ["person/photos", "person/calibration", "person/scan", "person/mri"]) rmSync(join(at, heavy), { recursive: true, force: true });
  writeFileSync(kept, JSON.stringify(result));
  return result;
}

// ---- Tables -------------------------------------------------------------------------------------

const two = (x) => x.toFixed(2), one = (x) => x.toFixed(1), percent = (x) => `${(100 * x).toFixed(0)} %`;
const off = (values) => two(mean(values.map(Math.abs)));
const worst = (values) => one(Math.max(...values.map(Math.abs)));
const table = (head, rows) => [head, head.map(() => "---"), ...rows].map((row) => `| ${row.join(" | ")} |`).join("\n");

/** Dimensions, axes and places of every person; refusals as rows. */
function skeleton_table(results, with_surface) {
  const head = ["seed", "how", ...(with_surface ? ["surface mean, 95 %, mm", "within 1 mm; measured"] : []),
    "hand length", "lengths", "widths", "thicknesses", "girth", "largest", "PIP axes mean, worst, °", "PIP places mean, worst, mm", "s"];
  const rows = results.map((r) => r.refusal ? [r.seed, r.name, r.refusal, ...Array(head.length - 3).fill("")] : [
    r.seed, r.name,
    ...(with_surface ? [`${two(r.surface)}, ${two(r.surface_p95)}`, `${percent(r.within)}; ${percent(r.measured)}`] : []),
    one(r.hand), off(r.length), off(r.width), off(r.thickness), one(r.girth[0]),
    worst([...r.length, ...r.width, ...r.thickness, ...r.girth]),
    `${one(mean(r.pip))}, ${worst(r.pip)}`, `${one(mean(r.place))}, ${worst(r.place)}`, r.seconds.toFixed(0)]);
  const good = results.filter((r) => !r.refusal), axes = good.flatMap((r) => r.axes);
  const said = axes.length
    ? `\n\nOf ${axes.length} axes that dots were used for, ${percent(axes.filter((a) => a <= 1).length / axes.length)} are within what is stated for 95 %.`
    : "";
  return table(head, rows) + said;
}

function quick_table(results) {
  const head = ["how", "persons", "refused", "hand length", "breadth", "index", "middle", "ring", "little", "widths of fingers", "within ±, measured", "regressed, scaled"];
  const rows = [];
  const names = [...new Set(results.map((r) => r.name))];
  for (const name of names) {
    const here = results.filter((r) => r.name === name), good = here.filter((r) => !r.refusal);
    const all = good.flatMap((r) => r.inside);
    const rms = (values) => values.length ? `${one(root_mean_square(values))} (${one(mean(values))})` : "–";
    const of = (test) => rms(all.filter(test).map((d) => d.off));
    const share = (test) => {
      const some = all.filter(test);
      return some.length ? percent(some.filter((d) => Math.abs(d.off) <= 1.96 * d.sd).length / some.length) : "–";
    };
    rows.push([name, here.length, here.length - good.length, of((d) => d.name === "hand_length"), of((d) => d.name === "hand_width"),
      ...["index", "middle", "ring", "little"].map((f) => rms(good.map((r) => r.measured[f]).filter((v) => v !== undefined))),
      of((d) => /_(proximal|middle|distal)_width$/.test(d.name) && d.how === "measured"),
      share((d) => d.how === "measured"), share((d) => d.how !== "measured")]);
  }
  const refused = results.filter((r) => r.refusal).map((r) => `- ${r.name}, seed ${r.seed}: ${r.refusal}`);
  return table(head, rows) + "\n\nRMS (mean), mm." + (refused.length ? `\n\nRefused:\n\n${refused.join("\n")}` : "");
}

function image_table(results) {
  const head = ["seed", "bones found of 27, misnamed", "bones mean, 95 %, mm", "skin, mm", "lengths", "widths", "thicknesses", "girth",
    "MCP axes mean, worst, °", "PIP axes mean, worst, °", "axes within the stated 95 %", "s"];
  const rows = results.map((r) => r.refusal ? [r.seed, r.refusal, ...Array(head.length - 2).fill("")] : [
    r.seed, `${r.bones.found}, ${r.bones.wrong.length}${r.bones.wrong.length ? ` (${r.bones.wrong.join(", ")})` : ""}`,
    `${two(mean(r.bones.distance))}, ${two(mean(r.bones.p95))}`, two(r.skin), off(r.length), off(r.width), off(r.thickness), one(r.girth[0]),
    r.mcp.length ? `${one(mean(r.mcp))}, ${worst(r.mcp)}` : "–", r.pip.length ? `${one(mean(r.pip))}, ${worst(r.pip)}` : "–",
    `${r.axes.filter((a) => a <= 1).length} of ${r.axes.length}`, r.seconds.toFixed(0)]);
  return table(head, rows);
}

function text_of(kind, results) {
  if (kind === "mri") return image_table(results);
  return kind === "quick" ? quick_table(results) : skeleton_table(results, kind === "photos");
}

function put_into_page(kind, text) {
  const file = join(root, "docs", "method", kinds[kind].page);
  const page = readFileSync(file, "utf8");
  const begin = `<!-- capture_figures ${kind} -->`, end = "<!-- end -->";
  const from = page.indexOf(begin), to = page.indexOf(end, from);
  if (from < 0 || to < 0) throw new Error(`${file}: no place for the table: ${begin} ... ${end}`);
  writeFileSync(file, page.slice(0, from + begin.length) + "\n" + text + "\n" + page.slice(to));
}

const git = (...words) => execFileSync("git", words, { cwd: root, encoding: "utf8" }).trim();
/** What the program of this tree is made from; --commit says it of another one. */
const commit_here = () => git("rev-parse", "--short=8", "HEAD") + (git("status", "--porcelain", "src", "apps") ? " and changes" : "");
const seeds = read_seeds();
const wanted = option("--only", Object.keys(kinds).join(",")).split(",");
for (const kind of wanted) {
  if (!kinds[kind]) throw new Error(`--only ${kind}: ${Object.keys(kinds).join(", ")} are allowed`);
  const results = [];
  const used = seeds[kind].slice(0, most).filter((seed) => !chosen.length || chosen.includes(seed));
  for (const seed of used) {
    for (const [name, words] of Object.entries(kinds[kind].cases)) results.push(run_case(kind, seed, name, words));
  }
  const when = new Date().toISOString().slice(0, 10);
  const head = `${kinds[kind].title}, set "${set}", seeds ${used.join(", ")}: \`node scripts/capture_figures.mjs ` +
    `--set ${set} --only ${kind}${most < seeds[kind].length ? ` --subjects ${most}` : ""}${chosen.length ? ` --seeds ${chosen.join(",")}` : ""}\`, ${when}, commit ${option("--commit", commit_here())}.`;
  const text = `\n${head}\n\n${text_of(kind, results)}\n`;
  console.log(text);
  if (process.argv.includes("--page")) put_into_page(kind, text);
}
