// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The files that take minutes to make, for files_test.mjs --all.
import {spawn} from "node:child_process";
import {cpSync, existsSync, mkdirSync, writeFileSync} from "node:fs";
import {join} from "node:path";

/** Documented fields that none of these files has: faults, ridges that few hands touch, images in full. */
export const rare = [
  "parts: parts[].opening", "parts: parts[].face_normal", "check: cad.faces[].colour",
  "run: failed.REASON", "status: stores[].failed.REASON", "status: stores[].seconds_left", "status: stores[].detail",
  "progress: reasons.REASON", "posture.json: swapped[]", "press-answer: gains", "region-answer: gains",
  "search-answer: gains", "shape-answer: history[].failure", "shape.json: history[].failure",
  "search-answer: history[].failure", "search.json: history[].failure", "proposals: proposals[].failure",
  ...["redesign", "unrolled", "cad.redesign"].flatMap((one) => [`region.json: ${one}`, `region-answer: ${one}`]),
  ...["correlation", "overlap", "turn_error_deg", "shift_error_mm"].map((one) => `mri scan.json: image.${one}`),
  "found.json: bone_motions.POSTURE",
];

/** What takes minutes. */
function longResults({folder, palmarDoes, printed, json, csv, toml, vtp}) {
  printed("reach", "grasp reach bar.stl --unit mm --grasp grasp.json --button b:0,18,40 --map reach.vtp");
  vtp("reach.vtp", "reach.vtp");
  printed("placements", "grasp place bar.stl --unit mm --grip tripod");
  printed("capacity", "effort capacity bar.stl --unit mm");
  printed("effort", "effort grasp bar.stl --unit mm");
  writeFileSync(join(folder, "areas.csv"), "depth_mm,force_mN,area_cm2,subject,weight\n0.5,20,0.1,A,1\n1,80,0.2,A,1\n" +
                                           "1.5,190,0.3,A,1\n2,380,0.4,A,2\n");
  printed("fit", "contact fit areas.csv --specimen ellipsoid:8,10 --indenter plane");
  printed("holds", "grasp holds bar.stl --unit mm --grip tripod --most 1 --out tripods");
  toml("hold.toml", "tripods/hold-1.toml");
  printed("validation.json", "validate --quick --out validation.json", [0, 5]);
  json("validation.json", "validation.json");
  palmarDoes("product make bottle --waist-depth-mm 5 --out bottle.stl");
  printed("parts", "product parts bottle.stl --unit mm");
  printed("check", "product check prism.step");
  palmarDoes("assess prism.step --no-pictures --mass-kg 0.4 --friction 0.5 --sensors mat " +
             "--coating 3,100,0.4,-99,-99,-99,99,99,99 --out full");
  writeFileSync(join(folder, "measured.csv"), "row,column,force_n\n1,1,0.5\n10,3,1.5\n");
  palmarDoes("assess prism.step --no-pictures --error-budget --skin-on-skin --sensors mat " +
             "--measured measured.csv --out budget");
  palmarDoes("assess bar.stl --unit mm --grip tripod --grip-force-n 10 --no-pictures --out tripod");
  palmarDoes("assess bar.stl prism.step --unit mm --no-pictures --out pair");
  for (const one of ["full", "budget", "tripod", "pair"]) json("assessment.json", `${one}/assessment.json`);
  csv("faces.csv", "full/faces.csv");
  vtp("hand.vtp", "full/prism/hand.vtp");
}

/** What stands beside a store while it is written. */
async function progressOfStudy({palmar, folder, text, json}) {
  const store = join(folder, "many.palmar");
  const run = spawn(palmar, ["--quiet", "study", "run", "--product", "bar.stl", "--unit", "mm", "--population",
                             "ansur2_women", "--hands", "500", "--out", store], {cwd: folder, stdio: "ignore"});
  const ended = new Promise((resolve) => run.on("close", resolve));
  const isBegun = () => existsSync(`${store}-progress`) && JSON.parse(text("many.palmar-progress")).done > 0;
  while (!isBegun() && run.exitCode === null) await new Promise((resolve) => setTimeout(resolve, 20));
  json("progress", "many.palmar-progress");
  run.kill("SIGTERM");
  await ended;
}

function longStudies({palmarDoes, printed, csv}) {
  palmarDoes("study run --product bar.stl --product prism.step --unit mm --population ansur2_women --hands 6 " +
             "--out two.palmar");
  printed("comparison", "study compare two.palmar");
  palmarDoes("study report two.palmar --no-pictures --out report-of-two");
  csv("comparison.csv", "report-of-two/comparison.csv");
  csv("study faces.csv", "report-of-two/faces.csv");
  printed("plan.json", "study plan --product bar.stl --unit mm --population ansur2_women --hands 2");
}

function redesigns({printed, json, csv, toml}) {
  const prism = "prism.step --hands 2";
  const compared = "--hands 6 --no-pictures";
  printed("press-answer", `redesign press ${prism} --no-pictures --no-compare --keep-box -9,-9,-9,9,9,9 --out press`);
  json("pressed.json", "press/pressed.json");
  printed("region-answer", `redesign region ${prism} --no-pictures --no-compare --out region`);
  json("region.json", "region/region.json");
  csv("region.csv", "region/region.csv");
  printed("shape-answer",
          `redesign shape prism.step --vary width=34 --use weight=9 --use hand=left ${compared} --out shape`);
  json("shape.json", "shape/shape.json");
  csv("history.csv", "shape/history.csv");
  csv("gains.csv", "shape/gains.csv");
  toml("handle.toml", "shape/handle.toml");
  printed("search-answer", `redesign fillet ${prism} --radius-mm 2:8 --evaluations 3 --no-compare --out fillet`);
  json("search.json", "fillet/search.json");
  csv("history.csv", "fillet/history.csv");
  printed("proposals", `redesign features ${prism} --propose --out proposals`);
  csv("proposals.csv", "proposals/proposals.csv");
}

function scans({source, palmarDoes, printed, json, csv, toml, glb}) {
  palmarDoes("phantom scan --seed 3 --posture reference,finger_flexion,thumb_flexion --out scan");
  json("scan subject.json", "scan/truth/subject.json");
  palmarDoes("hand from-scan scan/scan/reference.ply scan/scan/finger_flexion.ply scan/scan/thumb_flexion.ply " +
             "--truth scan/truth/subject.json --out scanned.hand.glb");
  json("surface scan.json", "scanned.scan/scan.json");
  for (const name of ["dimensions", "joints_by_dots", "truth_errors", "marks"]) {
    csv(`${name}.csv`, `scanned.scan/${name}.csv`);
  }
  toml("found.toml", "scanned.scan/found.toml");
  glb("hand.glb", "scanned.hand.glb");
  palmarDoes("hand pose --posture cylinder_grip --out grip.ply");
  printed("posture.json", "hand pose --mesh grip.ply --unit mm");
  const markers = join(source, "examples/closing-hand-markers.csv");
  printed("posture.json", `hand pose --markers ${markers} --marker-height-mm 6`);
  palmarDoes("phantom sheet --seed 3 --out sheet");
  json("sheet truth.json", "sheet/truth.json");
  printed("quick", "hand quick sheet/photo.jpg");
}

/** Surfaces as `palmar mri surfaces` leaves them: finding them in images takes minutes. */
function surfacesOf({folder, text, json}, postures) {
  const truth = JSON.parse(text("mri/truth/subject.json"));
  for (const posture of postures) {
    const to = join(folder, "surfaces", posture), from = join(folder, "mri/truth", posture);
    mkdirSync(to, {recursive: true});
    cpSync(join(from, "skin.ply"), join(to, "skin.ply"));
    cpSync(join(from, "bones"), join(to, "bones"), {recursive: true});
    const state = truth.postures[posture];
    writeFileSync(join(to, "scan.json"), JSON.stringify({
      palmar_scan_version: 1, key: "", side: truth.side, air_threshold: 40, bone_threshold: 90, noise: 0,
      voxel_mm: [0.8, 0.8, 1], bone_error_estimate_mm: 0.1, skin: "skin.ply",
      bones: Object.keys(state.patient_from_reference)
        .map((name) => ({name, file: `bones/${name}.ply`, is_cut: false})),
      markers_mm: state.markers_mm, notes: [],
    }));
    json("surfaces scan.json", `surfaces/${posture}/scan.json`);
  }
}

function images({folder, palmarDoes, printed, text, json, csv, toml}) {
  const postures = ["reference", "thumb_flexion", "grasp"];
  palmarDoes(`phantom mri --seed 4 --pixel-mm 3 --slice-mm 4 --slices 30 --posture ${postures.join(",")} --out mri`);
  json("mri subject.json", "mri/truth/subject.json");
  printed("series", "mri series mri/mri");
  printed("image", "mri info mri/mri/reference");
  surfacesOf({folder, text, json}, postures);
  palmarDoes("hand from-mri surfaces --out imaged.hand.glb --product mri/truth/grasp/product.ply");
  json("mri scan.json", "imaged.mri/scan.json");
  toml("found.toml", "imaged.mri/found.toml");
  for (const name of ["bone_errors", "skin_errors", "grasp_contact"]) csv(`${name}.csv`, `imaged.mri/${name}.csv`);
  const index = JSON.parse(text("surfaces/reference/scan.json"));
  index.bones = index.bones.filter(({name}) => !name.startsWith("little_"));
  writeFileSync(join(folder, "surfaces/reference/scan.json"), JSON.stringify(index));
  palmarDoes("hand from-mri surfaces --out refused.hand.glb", [3, 4]);
  json("found.json", "refused.mri/found.json");
}

function photographs({ask, palmarDoes, json}) {
  palmarDoes("phantom photos --seed 3 --cameras 4 --positions 5 --width-px 540 --height-px 720 --calibration 6 " +
             "--decentring 1e-5 --sixth 1e-4 --out photos");
  json("cameras.json", "photos/truth/cameras.json");
  json("scan subject.json", "photos/truth/subject.json");
  if (ask("photos calibrate photos/calibration --out lenses.json".split(" ")).code === 6) return;  // without OpenCV
  json("lenses.json", "lenses.json");
  palmarDoes("photos mesh photos/photos --lenses lenses.json --out photo.ply");
  json("photo mesh.json", "photo.json");
}

/** All of them, with the tools of files_test.mjs. */
export async function makeLongFiles(tools) {
  for (const one of [longResults, longStudies, redesigns, scans, images, photographs]) one(tools);
  await progressOfStudy(tools);
}
