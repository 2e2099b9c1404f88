// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
import assert from "node:assert/strict";
import { test } from "node:test";
import { BoneNames, CorrectionRow, Corrections, parseMarks, Triple } from "../bench/corrections";
import { boneNames, creaseNames, dotNames, postureInName } from "../bench/hand_names";
import { stationAt } from "../bench/part_line";
import { parseProposals } from "../bench/proposal_rows";
import english from "../bench/texts/en.json";

const csv = `posture,mark,name,x_mm,y_mm,z_mm
reference,crease,index_distal,-12.9,151.3,28.2
reference,dot,,40.1,88.0,-7.5
finger_flexion,dot,ring_middle,22.0,131.4,-19.8
`;

test("marks are read as the command line writes them", () => {
  const marks = parseMarks(csv);
  assert.deepEqual(marks.map((one) => [one.posture, one.kind, one.name]), [["reference", "crease", "index_distal"], ["reference", "dot", ""], ["finger_flexion", "dot", "ring_middle"]]);
  assert.deepEqual(marks[0].place, [-12.9, 151.3, 28.2]);
  assert.throws(() => parseMarks("name,x\n"), /marks\.csv begins with "name,x"/);
  assert.throws(() => parseMarks(csv + "reference,dot,palm,1,2\n"), /marks\.csv:5/);
});

test("nothing changed is no correction; a name is a row, a moved dot two", () => {
  const all = new Corrections(parseMarks(csv));
  assert.deepEqual(all.rows(), []);
  all.rename("m0", "index_middle");
  all.rename("m1", "palm");
  all.move("m2", [23, 130, -20]);
  assert.equal(all.changes, 3);
  assert.deepEqual(all.rows(), [
    { posture: "reference", mark: "crease", name: "index_middle", place_mm: [-12.9, 151.3, 28.2] },
    { posture: "reference", mark: "dot", name: "palm", place_mm: [40.1, 88, -7.5] },
    { posture: "finger_flexion", mark: "dot", name: "none", place_mm: [22, 131.4, -19.8] },
    { posture: "finger_flexion", mark: "added_dot", name: "ring_middle", place_mm: [23, 130, -20] },
  ]);
});

test("lines stay where they are, are taken away and drawn anew by points", () => {
  const all = new Corrections(parseMarks(csv));
  all.move("m0", [0, 0, 0]);
  assert.equal(all.isChanged("m0"), false);
  all.remove("m0");
  const id = all.add("reference", "crease", "wrist", [1, 2, 3]);
  all.extend(id, [9, 2, 3]);
  assert.deepEqual(all.rows(), [
    { posture: "reference", mark: "crease", name: "none", place_mm: [-12.9, 151.3, 28.2] },
    { posture: "reference", mark: "added_crease", name: "wrist", place_mm: [1, 2, 3] },
    { posture: "reference", mark: "added_crease", name: "wrist", place_mm: [9, 2, 3] },
  ]);
  all.remove(id);
  assert.equal(all.rows().length, 1);
});

test("what was said before stays, and what is said now of the same mark counts", () => {
  const before = [
    { posture: "reference", mark: "dot" as const, name: "palm", place_mm: [40.1, 88, -7.5] as [number, number, number] },
    { posture: "finger_flexion", mark: "added_dot" as const, name: "ring_middle", place_mm: [22.04, 131.4, -19.8] as [number, number, number] },
  ];
  const all = new Corrections(parseMarks(csv), before);
  assert.deepEqual(all.rows(), before);
  all.rename("m1", "index_distal");
  all.move("m2", [20, 130, -18]);
  assert.deepEqual(all.rows(), [{ ...before[0], name: "index_distal" }, { ...before[1], place_mm: [20, 130, -18] }]);
  all.remove("m2");
  assert.equal(all.rows().length, 1, "an added dot that is taken away was never there");
});

test("a mark is known by its place within reach, a crease by its name, and bones stay", () => {
  const before = [
    { posture: "reference", mark: "crease" as const, name: "index_distal", place_mm: [-20, 150, 28] as [number, number, number] },
    { posture: "reference", mark: "dot" as const, name: "palm", place_mm: [41, 88, -7] as [number, number, number] },
    { posture: "", mark: "" as const, name: "capitate", place_mm: [1, 2, 3] as [number, number, number] },
  ];
  const all = new Corrections(parseMarks(csv), before);
  all.rename("m0", "index_middle");
  all.rename("m1", "none");
  assert.deepEqual(all.rows(), [
    { ...before[0], name: "index_middle", place_mm: [-12.9, 151.3, 28.2] }, { ...before[1], name: "none", place_mm: [40.1, 88, -7.5] }, before[2],
  ]);
  // Another dot is nearer to the row's place: it is about that one.
  const two = new Corrections(parseMarks(csv + "reference,dot,palm,41.0,88.0,-7.0\n"), before);
  two.rename("m1", "ring_middle");
  assert.deepEqual(two.rows().slice(1), [before[1], before[2], { posture: "reference", mark: "dot", name: "ring_middle", place_mm: [40.1, 88, -7.5] }]);
});

test("two creases that were named before change names", () => {
  const at = (name: string, x: number) => ({ posture: "reference", mark: "crease" as const, name, place_mm: [x, 0, 0] as [number, number, number] });
  const all = new Corrections(parseMarks("posture,mark,name,x_mm,y_mm,z_mm\nreference,crease,index_distal,0,0,0\nreference,crease,index_middle,30,0,0\n"), [at("index_distal", 0), at("index_middle", 30)]);
  all.rename("m0", "index_middle");
  all.rename("m1", "index_distal");
  assert.deepEqual(all.rows(), [at("index_middle", 0), at("index_distal", 30)]);
});

test("bones show the names that they were given, which can be taken back", () => {
  const at: Record<string, Triple> = { "bone-1": [1, 0, 0], index_distal_phalanx: [2, 0, 0], ring_distal_phalanx: [3, 0, 0], hamate: [4, 0, 0] };
  const row = (name: string, place_mm: Triple): CorrectionRow => ({ posture: "", mark: "", name, place_mm });
  const mark: CorrectionRow = { posture: "reference", mark: "dot", name: "none", place_mm: [2, 0, 0] };
  const boneAt = (place: Triple) => Object.keys(at).find((name) => Math.abs(at[name][0] - place[0]) < 0.5)!;
  const names = (rows: CorrectionRow[]) => new BoneNames(Object.keys(at), rows, boneAt);
  // The one that had the name is left without one.
  const first = names([mark]);
  first.rename("bone-1", "index_distal_phalanx", [1.1, 0, 0], (bone) => at[bone]);
  assert.deepEqual([first.changes, first.nameOf("index_distal_phalanx")], [2, ""]);
  const said = first.rows();
  assert.deepEqual(said, [mark, row("index_distal_phalanx", [1.1, 0, 0])]);
  // In the next run files are called as before.
  const next = names([...said, row("capitate", at.hamate)]);
  assert.deepEqual([next.changes, next.nameOf("bone-1"), next.nameOf("hamate"), next.isRenamed("hamate")], [0, "index_distal_phalanx", "capitate", true]);
  next.rename("bone-1", "ring_distal_phalanx", at["bone-1"], (bone) => at[bone]);
  next.rename("hamate", "hamate", at.hamate, (bone) => at[bone]);
  assert.equal(next.changes, 3);
  assert.deepEqual(next.rows(), [mark, row("ring_distal_phalanx", at["bone-1"]), row("hamate", at.hamate), row("index_distal_phalanx", at.ring_distal_phalanx)]);
  assert.equal(next.nameOf("index_distal_phalanx"), "", "another bone has its name");
  // And back again.
  next.rename("bone-1", "index_distal_phalanx", at["bone-1"], (bone) => at[bone]);
  next.rename("hamate", "capitate", at.hamate, (bone) => at[bone]);
  assert.equal(next.changes, 0);
});

test("names of creases, dots and bones have words; there are 15, 15 and 19", () => {
  assert.deepEqual([creaseNames.length, dotNames.length, boneNames.length], [15, 15, 19]);
  for (const name of [...creaseNames.slice(1), ...dotNames.slice(1), ...boneNames]) {
    const cut = name.indexOf("_");
    for (const key of [`finger.${name.slice(0, cut)}`, `found.part.${name.slice(cut + 1)}`]) assert.ok(key in english, key);
  }
  assert.equal(postureInName("anna_spread.ply"), "finger_abduction");
  assert.equal(postureInName("scan.glb"), "reference");
  assert.equal(postureInName("thumb_flexion.ply"), "thumb_flexion");
});

test("proposals are read with what is in quotes", () => {
  const all = parseProposals('vary,goal,gain_percent,grip_force_ratio,is_feasible,failure,reason\n"fillet:face=7=6",0.1,12.50,1.01,yes,,"face 7 (fillet r 3), has ""peaks"""\noffset:face=2=-1,,,,no,can\'t be made,x\n');
  assert.deepEqual(all[0], { vary: "fillet:face=7=6", gain: 12.5, isFeasible: true, failure: "", reason: 'face 7 (fillet r 3), has "peaks"' });
  assert.equal(all[1].gain, null);
});

test("a place between two stations of a part's line", () => {
  const line = [0, 0.5, 1].map((along) => ({ along, centre_mm: [0, 0, 100 * along] as [number, number, number], axis: [0, 0, 1] as [number, number, number] }));
  assert.deepEqual(stationAt(line, 0.3).centre, [0, 0, 30]);
  assert.deepEqual(stationAt(line, 0).centre, [0, 0, 0]);
  assert.deepEqual(stationAt(line, 1).centre, [0, 0, 100]);
  assert.deepEqual(stationAt(line.slice(0, 1), 0.7).centre, [0, 0, 0]);
  const bent = [{ along: 0, centre_mm: [0, 0, 0] as [number, number, number], axis: [1, 0, 0] as [number, number, number] }, { along: 1, centre_mm: [1, 1, 0] as [number, number, number], axis: [0, 1, 0] as [number, number, number] }];
  assert.ok(Math.abs(Math.hypot(...stationAt(bent, 0.5).axis) - 1) < 1e-12);
});
