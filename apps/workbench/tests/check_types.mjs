// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Holds types/ to what Palmar writes: node check_types.mjs PALMAR [--hands] makes reports, takes the JSON
// that stands in each page and has tsc check it as a literal of its type, so that a key that is renamed,
// missing or new on either side fails: reports of one hand and of a study, with --hands those of a hand made
// from a scan and from MR images, which take minutes.
import { execFileSync, spawnSync } from "node:child_process";
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const palmar = resolve(process.argv[2]);
const workbench = resolve(dirname(fileURLToPath(import.meta.url)), "..");
const folder = mkdtempSync(join(tmpdir(), "palmar-types-"));

function run(words) {
  execFileSync(palmar, words.split(" "), { cwd: folder, stdio: ["ignore", "ignore", "pipe"], maxBuffer: 1 << 26 });
}

/// The JSON with that id in a page.
function inside(page, id) {
  const html = readFileSync(join(folder, page), "utf8");
  const found = html.match(new RegExp(`<script type="application/json" id="${id}">([^]*?)</script>`));
  if (!found) throw new Error(`${page} holds no ${id}`);
  return JSON.parse(found[1]);
}

const checks = [];
function check(name, type, json) {
  checks.push(`export const ${name}: ${type} = ${JSON.stringify(json)};`);
}

function assessments() {
  run("product make prism --width-mm 35 --depth-mm 35 --length-mm 120 --fillet-mm 3 --out prism.step");
  run("product make cylinder --diameter-mm 16 --length-mm 130 --out pen.stl");
  run("assess prism.step --mass-kg 0.4 --friction 0.5 --coating 3,100,0.4,-99,-99,-99,99,99,99 --no-pictures --out power");
  run("assess pen.stl --unit mm --grip tripod --grip-force-n 10 --no-error-band --out tripod");
  for (const name of ["power", "tripod"]) {
    check(`${name}_report`, "t.AssessmentReport", inside(`${name}/report.html`, "palmar-assessment"));
    check(`${name}_file`, "t.AssessmentReport", JSON.parse(readFileSync(join(folder, name, "assessment.json"), "utf8")));
    check(`${name}_view`, "t.AssessmentView", inside(`${name}/report.html`, "palmar-view"));
  }
}

function studies() {
  writeFileSync(join(folder, "study.toml"), `
[study]
name = "types"
seed = 5
[[population]]
preset = "xie2014"
hands = 3
[[profile]]
name = "long nails"
nail_length_mm = 8
[[product]]
name = "prism"
kind = "prism"
width_mm = 35
depth_mm = 35
length_mm = 120
fillet_mm = 5
sizes = [0.9, 1.0]
[[limit]]
quantity = "peak_pressure_cells_mpa"
highest = 0.3
`);
  run("study run study.toml --out study.palmar --quiet");
  run("study report study.palmar --out study --quiet");
  check("study", "t.StudyPage", inside("study/report.html", "palmar-study"));
}

function scans() {
  run("phantom scan --seed 3 --postures reference,finger_flexion --out scan");
  run("hand from-scan scan/scan/reference.ply scan/scan/finger_flexion.ply " +
      "--truth scan/truth/subject.json --out a.hand.glb");
  check("scan_report", "t.HandFromScan", inside("a.scan/report.html", "palmar-scan"));
  check("scan_view", 't.HandFromScanPage["view"]', inside("a.scan/report.html", "palmar-view"));
}

function images() {
  const postures = ["reference", "thumb_flexion", "grasp"];
  run(`phantom mri --seed 4 --pixel-mm 3 --slice-mm 4 --slices 30 --postures ${postures.join(",")} --out mri`);
  const truth = JSON.parse(readFileSync(join(folder, "mri/truth/subject.json"), "utf8"));
  for (const posture of postures) {
    // Surfaces as `palmar mri surfaces` leaves them: finding them in images takes minutes.
    const from = join(folder, "mri/truth", posture), to = join(folder, "surfaces", posture);
    mkdirSync(to, { recursive: true });
    cpSync(join(from, "skin.ply"), join(to, "skin.ply"));
    cpSync(join(from, "bones"), join(to, "bones"), { recursive: true });
    const state = truth.postures[posture];
    writeFileSync(join(to, "scan.json"), JSON.stringify({
      palmar_scan_version: 1, key: "", side: truth.side, air_threshold: 40, bone_threshold: 90, noise: 0,
      bone_error_estimate_mm: 0.1, fat_shift_mm: [0, 0, 0], skin: "skin.ply",
      bones: Object.keys(state.patient_from_reference).map((name) => ({ name, file: `bones/${name}.ply`, is_cut: false })),
      markers_mm: state.markers_mm, notes: [],
    }));
  }
  run("hand from-mri surfaces --out b.hand.glb --product mri/truth/grasp/product.ply");
  check("images_report", "t.HandFromMri", inside("b.mri/report.html", "palmar-scan"));
  check("images_view", 't.HandFromMriPage["view"]', inside("b.mri/report.html", "palmar-view"));
  // No hand comes of it: what was found until then.
  const index = join(folder, "surfaces/reference/scan.json");
  const scan = JSON.parse(readFileSync(index, "utf8"));
  scan.bones = scan.bones.filter(({ name }) => !name.startsWith("little_"));
  writeFileSync(index, JSON.stringify(scan));
  spawnSync(palmar, "hand from-mri surfaces --out c.hand.glb".split(" "), { cwd: folder });
  check("refused_report", "t.RefusedScans", inside("c.mri/report.html", "palmar-scan"));
  check("refused_view", 't.RefusedScansPage["view"]', inside("c.mri/report.html", "palmar-view"));
}

try {
  if (process.argv.includes("--hands")) {
    scans();
    images();
  } else {
    assessments();
    studies();
  }
  const source = join(folder, "check.ts");
  writeFileSync(source, `import * as t from ${JSON.stringify(join(workbench, "types"))};\n${checks.join("\n")}\n`);
  const tsc = resolve(workbench, "../../node_modules/.bin/tsc");
  const result = spawnSync(tsc, ["--noEmit", "--strict", "--lib", "ES5", source], { cwd: folder, encoding: "utf8" });
  // Lines of literals are long; what matters stands before them.
  const said = result.stdout.split("\n").map((line) => line.slice(0, 400)).join("\n");
  if (result.status !== 0) {
    console.error(said);
    process.exitCode = 1;
  } else {
    console.log(`${checks.length} documents have the types that they should have`);
  }
} finally {
  rmSync(folder, { recursive: true, force: true });
}
