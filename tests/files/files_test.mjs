// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node files_test.mjs PALMAR [--all]: whether files hold what docs/using/files.md and the pages below it say, key by
// key, with types and ranges, and the other way round. --all makes what takes minutes, too, asks the readers of TOML
// for types and ranges, and fails if no file has a documented field.
import assert from "node:assert/strict";
import {spawnSync} from "node:child_process";
import {cpSync, existsSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync} from "node:fs";
import {tmpdir} from "node:os";
import {dirname, join, resolve} from "node:path";
import {fileURLToPath} from "node:url";

import {check, checkCsv, parseToml, readFormats, unseen} from "./documented.mjs";
import {makeLongFiles, rare} from "./long_files.mjs";
import {checkReaders} from "./toml_readers.mjs";

const palmar = resolve(process.argv[2]);
const hasHands = existsSync(join(dirname(palmar), "palmar-hands"));  // ./check builds it with --hands alone
const isAll = process.argv.includes("--all");
const source = join(dirname(fileURLToPath(import.meta.url)), "../..");
const pages = join(source, "docs/using/files");
const formats = readFormats(
  [...readdirSync(pages).map((one) => join("files", one)), "holds.md", "study-store.md"].map((one) => join(pages, "..", one)));
const folder = mkdtempSync(join(tmpdir(), "palmar-files-"));
const faults = [];
const made = new Set();  // formats of which there was a file
// What people write: readers say which fields there may be.
const readOnly = ["study.toml", "tissue.toml", "population.toml", "curves.csv", "angles.json", "hold.toml", "palmar"];

function ask(words) {
  const run = spawnSync(palmar, ["--quiet", ...words], {cwd: folder, encoding: "utf8", maxBuffer: 1 << 28});
  return {code: run.status, out: run.stdout, error: run.stderr.trim()};
}

/** Runs a command in the folder; the words are split at spaces. */
function palmarDoes(line, codes = [0]) {
  const run = ask(line.split(" "));
  assert.ok(codes.includes(run.code), `palmar ${line}: ${run.code} ${run.error}`);
  return run.out;
}

function formatOf(name) {
  made.add(name);
  const root = formats.get(name);
  assert.ok(root, `${name} isn't documented`);
  return root;
}

const text = (file) => readFileSync(join(folder, file), "utf8");
const json = (name, file) => check(JSON.parse(text(file)), formatOf(name), `${name} (${file})`, faults);
const csv = (name, file) => checkCsv(text(file), formatOf(name), `${name} (${file})`, faults);
const toml = (name, file) => check(parseToml(text(file)), formatOf(name), `${name} (${file})`, faults);
const printed = (name, line, codes) => {
  check(JSON.parse(palmarDoes(`${line} --json`, codes)), formatOf(name), `${name} (palmar ${line})`, faults);
};
/** Tables and columns of a study, if sqlite3 is installed. */
const sqlite = (name, file) => {
  const asked = "SELECT t.name || '.' || c.name FROM sqlite_master t, pragma_table_info(t.name) c WHERE t.type = 'table'";
  const run = spawnSync("sqlite3", [file, asked], {cwd: folder, encoding: "utf8"});
  if (run.error) return;
  const columns = run.stdout.trim().split("\n");
  const documented = [...formatOf(name).children].flatMap(([table, {row, children}]) =>
    row?.isOptional ? [] : [...children.keys()].map((one) => `${table}.${one}`));
  assert.deepEqual(columns.sort(), documented.sort());
};
/** Names of the data arrays of a VTK file. */
const vtp = (name, file) => {
  const fields = [...text(file).matchAll(/<(?:DataArray|Array)[^>]* Name="([^"]*)"/g)].map(([, one]) => one);
  const own = fields.filter((one) => !["connectivity", "offsets", "position_mm"].includes(one));
  const words = formatOf(name);
  for (const one of own) if (!words.children.has(one)) faults.push(`${name}: ${one} isn't documented`);
  for (const [one, node] of words.children) {
    if (own.includes(one)) node.isSeen = true;
    else if (!node.row.isOptional) faults.push(`${name}: ${one} is documented and isn't there`);
  }
  words.isSeen = true;
};
/** What Palmar keeps in a glTF file beside the scene. */
const glb = (name, file) => {
  const bytes = readFileSync(join(folder, file));
  const {extras} = JSON.parse(bytes.subarray(20, 20 + bytes.readUInt32LE(12)).toString());
  check(extras, formatOf(name), `${name} (${file})`, faults);
};

function products() {
  palmarDoes("product make cylinder --diameter-mm 36 --length-mm 120 --out bar.stl");
  palmarDoes("product make prism --width-mm 35 --depth-mm 35 --length-mm 120 --fillet-mm 3 --out prism.step");
  printed("parts", "product parts prism.step");
  printed("check", "product info prism.step");
  printed("check", "product info bar.stl --unit mm");
}

function grasps() {
  palmarDoes("grasp close bar.stl --unit mm --out grasp.json");
  json("grasp.json", "grasp.json");
  printed("holds", "grasp holds bar.stl --unit mm --most 3 --out holds");
  toml("hold.toml", "holds/hold-1.toml");
  palmarDoes("product make cylinder --diameter-mm 60 --length-mm 100 --out can.stl");
  const points = ["wrist", "thumb", "index", "middle", "ring", "little"].flatMap((one) => ["x", "y", "z"].map((axis) => `${one}_${axis}_mm`));
  writeFileSync(join(folder, "people.csv"), ["object", ...points, "up_x", "up_y", "up_z"].join() +
    "\nbar,-20,-130,0,20,0,10,-22,15,30,-22,15,10,-22,15,-10,-22,10,-30,0,0,1\ncan,0,-20,180,32,0,50,-32,10,50,-34,0,50,-32,-10,50,-20,-25,50,0,0,1\n");
  csv("people-holds.csv", "people.csv");
  printed("hold-fit", "grasp fit-holds people.csv --products . --out weights.toml");
  toml("hold-weights.toml", "weights.toml");
  printed("reach", "grasp reach bar.stl --unit mm --grasp grasp.json --button b:0,18,40");
  printed("effort", "effort grasp bar.stl --unit mm --grasp grasp.json");
  printed("fingertip", "effort fingertip --finger index --posture mcp=30,pip=40,dip=20");
}

function presses() {
  palmarDoes("contact press --indenter sphere:5 --depth-mm 1,2 --coating 2,200 --out press.json");
  json("press.json", "press.json");
  palmarDoes("contact press --indenter sphere:5 --depth-mm 1,2 --out press.csv");
  csv("press.csv", "press.csv");
  const curve = join(source, "examples/fingertip-xie2014.csv");
  printed("fit", `contact fit ${curve} --specimen ellipsoid:8,10 --indenter plane --out fitted.toml`);
  toml("tissue.toml", "fitted.toml");
  cpSync(curve, join(folder, "curve.csv"));
  csv("curves.csv", "curve.csv");
}

function assessments() {
  palmarDoes("assess bar.stl --unit mm --tissue-model halfspace --no-balance --no-error-band --no-pictures " +
             "--sensors mat --out quick");
  json("assessment.json", "quick/assessment.json");
  csv("regions.csv", "quick/regions.csv");
  csv("sensors.csv", "quick/sensors.csv");
  vtp("hand.vtp", "quick/bar/hand.vtp");
  vtp("product.vtp", "quick/bar/product.vtp");
}

function populations() {
  printed("populations", "population list");
  printed("population.json", "population show ansur2");
  palmarDoes("population show ansur2_women --out women.toml");
  toml("population.toml", "women.toml");
  palmarDoes("population sample ansur2 --hands 12 --out people.csv");
  csv("sample.csv", "people.csv");
  csv("subjects.csv", "people.csv");
  printed("sample.json", "population sample ansur2 --hands 2");
  printed("describe", "population describe people.csv --by sex --dimension hand_length,hand_width");
  printed("correlate", "population correlate people.csv --by sex --dimension hand_length,hand_width");
  printed("regress", "population regress people.csv --by sex --dimension hand_width");
  palmarDoes("population describe people.csv --dimension hand_length --out tables");
  palmarDoes("population correlate people.csv --dimension hand_length,hand_width --out tables");
  palmarDoes("population regress people.csv --dimension hand_width --out tables");
  for (const name of ["description.csv", "correlation.csv", "regression.csv"]) csv(name, `tables/${name}`);
}

function studies() {
  writeFileSync(join(folder, "study.toml"), `
[study]
name = "files"
[[population]]
preset = "xie2014"
design = "percentiles"
percentiles = [20, 50, 80]
[[product]]
name = "thin"
file = "bar.stl"
unit = "mm"
sizes = [0.9, 1.0]
part = "handle"
along = 0.5
[settings]
limit_depths = true
balance = false
tissue_model = "halfspace"
[[limit]]
quantity = "peak_pressure_cells_mpa"
highest = 0.3
`);
  toml("study.toml", "study.toml");
  printed("plan.json", "study plan study.toml --no-sample");
  writeFileSync(join(folder, "held.toml"), `
[[population]]
preset = "xie2014"
hands = 1
[[product]]
file = "bar.stl"
unit = "mm"
hold = "holds/hold-1.toml"
[settings]
refine = true
torque = true
`);
  printed("plan.json", "study plan held.toml --no-sample");
  printed("run", "study run study.toml --out files.palmar");
  printed("status", "study status files.palmar");
  printed("comparison", "study compare files.palmar");
  sqlite("palmar", "files.palmar");
  palmarDoes("study export files.palmar --fields --out tables-of-study");
  for (const name of ["hands", "products", "profiles", "settings", "grasps", "indices", "postures"]) {
    csv(`${name}.csv`, `tables-of-study/${name}.csv`);
  }
  csv("study regions.csv", "tables-of-study/regions.csv");
  csv("fields.csv", "tables-of-study/skin_pressure.csv");
  csv("fields.csv", "tables-of-study/product_pressure.csv");
  json("plan.json", "tables-of-study/plan.json");
  palmarDoes("study report files.palmar --no-pictures --out report-of-study");
  for (const name of ["statistics", "comparison", "accommodation", "outcomes", "holds", "size_dependence", "sizes"]) {
    csv(`${name}.csv`, `report-of-study/${name}.csv`);
  }
  csv("report regions.csv", "report-of-study/regions.csv");
}

function hands() {
  printed("hand-info", "hand info");
  printed("measure", "hand measure");
  writeFileSync(join(folder, "measure.csv"), palmarDoes("hand measure"));
  csv("measure.csv", "measure.csv");
  printed("tissue", "hand tissue");
  palmarDoes("hand tissue --out tissue.toml");
  toml("tissue.toml", "tissue.toml");
  palmarDoes("hand mirror --out left.hand.glb");
  glb("hand.glb", "left.hand.glb");
  palmarDoes("hand pose --posture fist --out fist.json --out fist.csv");
  json("posture.json", "fist.json");
  csv("posture.csv", "fist.csv");
  writeFileSync(join(folder, "angles.json"), JSON.stringify({
    index_pip_flexion_deg: 200, thumb_ip_flexion_rad: 0.2, time_s: 0.5, grip: "tripod",
    product_from_hand: {quaternion_wxyz: [1, 0, 0, 0], translation_mm: [0, 0, -60]},
  }));
  json("angles.json", "angles.json");
  printed("posture.json", "hand pose --angles angles.json");
  const markers = join(source, "examples/closing-hand-markers.csv");
  printed("posture.json", `hand pose --markers ${markers} --marker-height-mm 6 --frame 1 --out closing.csv`);
  csv("posture.csv", "closing.csv");
  cpSync(markers, join(folder, "markers.csv"));
  csv("markers.csv", "markers.csv");
  if (hasHands) printed("quick", "hand quick --hand-length-mm 181 --circumference-mm 190 --population ansur2_women");
}

/** A page that was typed here, and what is wrong with files beside it. */
function checksItself() {
  const page = join(folder, "page.md");
  writeFileSync(page, `
<!-- format part -->

| field | unit | type and range | meaning |
|-|-|-|-|
| \`size_mm\` | mm | number, above 0 | of it |

<!-- format box, as part -->

| field | unit | type and range | meaning |
|-|-|-|-|
| \`kind\` | | \`a\`, \`b\` or null | which |
| \`share\` | | optional number, 0 to 1 | of all |
| \`parts\` | | list of [part](#part) | its own |
| \`by.NAME_n\` | N | whole number | by name |
`);
  const box = readFormats([page]).get("box");
  const said = (value) => {
    const found = [];
    check(value, box, "box", found);
    return found.map((one) => one.replace(/page\.md:\d+/, "page").replace(folder + "/", ""));
  };
  const good = {size_mm: 1, kind: null, parts: [{size_mm: 2}], by: {left_n: 3}};
  assert.deepEqual(said(good), []);
  assert.deepEqual(said({...good, more: 1}), ['box: "more" isn\'t documented (1)']);
  assert.deepEqual(said({...good, parts: [{}]}), ['box.parts[0]: "size_mm" is documented and isn\'t there']);
  assert.deepEqual(said({...good, size_mm: 0}), ["box.size_mm: is 0; page says above 0 to "]);
  assert.deepEqual(said({...good, share: 1.5}), ["box.share: is 1.5; page says 0 to 1"]);
  assert.deepEqual(said({...good, kind: "c"}), ['box.kind: is "c"; page says a, b']);
  assert.deepEqual(said({...good, by: {left_n: 0.5}}), ["box.by.left_n: is 0.5; page says whole number"]);
  assert.deepEqual(said({...good, by: {left: 1}}), ['box.by: "left" isn\'t documented (1)']);
  const cells = [];
  assert.equal(checkCsv('# by hand\nsize_mm,kind\n"1",a\n,"x, ""y"""\n', readFormats([page]).get("part"), "csv", cells), 2);
  assert.deepEqual(cells.map((one) => one.replace(/ [^ ]*page\.md:\d+/, " page")),
                   ['csv: column "kind" isn\'t documented', "csv, row 2, size_mm: is null; page says no null"]);
  assert.deepEqual(parseToml('a = 1  # "x"\n[b.c]\nd = [1,\n  2,\n]\n[[e]]\nf = { g = "h # i" }\n'),
                   {a: 1, b: {c: {d: [1, 2]}}, e: [{f: {g: "h # i"}}]});
}

try {
  checksItself();
  products();
  grasps();
  presses();
  assessments();
  populations();
  studies();
  hands();
  if (isAll) await makeLongFiles({palmar, folder, source, ask, palmarDoes, printed, text, json, csv, toml, vtp, glb});
  const readers = checkReaders(formats, folder, (words) => ask(words).error, isAll, hasHands);
  faults.push(...readers.faults);
  if (isAll) {
    const written = [...made].filter((name) => !readOnly.includes(name));
    const never = written.flatMap((name) => unseen(formats.get(name)).map((field) => `${name}: ${field}`));
    for (const one of new Set(never)) if (!rare.includes(one)) faults.push(`${one}: no file has it`);
  }
  assert.equal(faults.slice(0, 40).join("\n"), "");
  console.log(`${made.size} formats are as documented, ${readers.asked} files refused as they should be`);
} finally {
  rmSync(folder, {recursive: true, force: true});
}
