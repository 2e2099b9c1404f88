// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What a person says of the marks that were found on scans: which name each has, where it belongs, which
// is none. Rows become [[mark]] and [[bone]] of the file of the person (`--known`).
export type Triple = [number, number, number];

export interface Mark {
  id: string;
  posture: string;
  kind: "crease" | "dot";
  name: string; // "" isn't used
  place: Triple; // mm, where it was found
  isAdded: boolean;
}

export interface CorrectionRow {
  posture: string;
  mark: "crease" | "dot" | "added_crease" | "added_dot" | ""; // "": a bone
  name: string;
  place_mm: Triple;
}

interface Changed extends Mark {
  newName: string;
  newPlace: Triple;
  points: Triple[]; // of an added crease
}

/// Rows of marks.csv: posture,mark,name,x_mm,y_mm,z_mm.
export function parseMarks(csv: string): Mark[] {
  const lines = csv.trim().split(/\r?\n/);
  if (lines[0] !== "posture,mark,name,x_mm,y_mm,z_mm") throw new Error(`marks.csv begins with "${lines[0].slice(0, 60)}"`);
  return lines.slice(1).map((line, k) => {
    const [posture, mark, name, ...place] = line.split(",");
    const numbers = place.map(Number);
    if (numbers.length !== 3 || !numbers.every(Number.isFinite) || (mark !== "crease" && mark !== "dot")) throw new Error(`marks.csv:${k + 2}: ${line.slice(0, 60)}`);
    return { id: `m${k}`, posture, kind: mark, name, place: numbers as Triple, isAdded: false };
  });
}

const kRounded = 0.6; // mm; places in marks.csv have a tenth
const kReach = 3; // mm; so far from a row's place the program looks for its mark

const same = (a: Triple, b: Triple) => a.every((one, k) => one === b[k]);

const distance = (a: Triple, b: Triple) => Math.hypot(...a.map((one, k) => one - b[k]));

/// Marks with what was changed of them.
export class Corrections {
  private readonly all: Changed[];
  private count = 0;

  /// `marks` as they were found, with what an earlier run was told already (`before`): rows that name
  /// or take away what isn't found any more are kept as they are.
  constructor(marks: Mark[], private readonly before: CorrectionRow[] = []) {
    this.all = marks.map((one) => ({ ...one, newName: one.name, newPlace: one.place, points: [] }));
  }

  get marks(): readonly Changed[] { return this.all; }
  find(id: string): Changed | undefined { return this.all.find((one) => one.id === id); }

  rename(id: string, name: string): void {
    const mark = this.find(id);
    if (mark) mark.newName = name;
  }
  /// Only dots go elsewhere: a line has a shape, and is drawn anew.
  move(id: string, place: Triple): void {
    const mark = this.find(id);
    if (mark && (mark.kind === "dot" || mark.isAdded)) mark.newPlace = place;
  }
  add(posture: string, kind: "crease" | "dot", name: string, place: Triple): string {
    const id = `a${this.count++}`;
    this.all.push({ id, posture, kind, name, place, isAdded: true, newName: name, newPlace: place, points: [place] });
    return id;
  }
  /// One more point of a crease that is drawn.
  extend(id: string, place: Triple): void { this.find(id)?.points.push(place); }
  remove(id: string): void {
    const at = this.all.findIndex((one) => one.id === id);
    if (at < 0) return;
    if (this.all[at].isAdded) this.all.splice(at, 1);
    else this.all[at].newName = "none";
  }

  isChanged(id: string): boolean {
    const mark = this.find(id);
    return mark !== undefined && (mark.isAdded || mark.newName !== mark.name || !same(mark.newPlace, mark.place));
  }
  get changes(): number { return this.all.filter((one) => this.isChanged(one.id)).length; }

  /// Whether a row is about this mark: no other is nearer to its place. A crease is longer than that; each has its name.
  private isAbout(row: CorrectionRow, mark: Changed): boolean {
    if (row.posture !== mark.posture || row.mark !== mark.kind) return false;
    if (mark.kind === "crease" && row.name === mark.name) return true;
    const far = distance(row.place_mm, mark.place);
    return far <= kReach && !this.all.some((one) => one.posture === mark.posture && one.kind === mark.kind && !one.isAdded && distance(row.place_mm, one.place) < far);
  }

  rows(): CorrectionRow[] {
    const rows = [...this.before];
    const put = (row: CorrectionRow, mark: Changed) => {
      // What is said now of the same mark counts.
      const at = rows.findIndex((one) => this.before.includes(one) && this.isAbout(one, mark));
      if (at >= 0) rows[at] = row;
      else rows.push(row);
    };
    for (const one of this.all) {
      if (!this.isChanged(one.id)) continue;
      if (one.isAdded) {
        const points = one.kind === "crease" ? one.points : [one.newPlace];
        for (const place of points) rows.push({ posture: one.posture, mark: `added_${one.kind}`, name: one.newName, place_mm: place });
        continue;
      }
      const isMoved = !same(one.newPlace, one.place);
      // It was added before: that row is what is changed.
      const added = rows.findIndex((row) => row.posture === one.posture && row.mark === `added_${one.kind}` && distance(row.place_mm, one.place) < kRounded);
      if (added >= 0 && one.kind === "dot") {
        if (one.newName === "none") rows.splice(added, 1);
        else rows[added] = { ...rows[added], name: one.newName, place_mm: one.newPlace };
        continue;
      }
      put({ posture: one.posture, mark: one.kind, name: isMoved ? "none" : one.newName || "none", place_mm: one.place }, one);
      if (isMoved && one.newName && one.newName !== "none") {
        rows.push({ posture: one.posture, mark: `added_${one.kind}`, name: one.newName, place_mm: one.newPlace });
      }
    }
    return rows;
  }
}

/// Bones that were found, by the names of their files, and what is said of them. Files keep their names when a bone
/// gets another one; that of a bone without a name ends in a number. "" is no name.
export class BoneNames {
  private readonly said = new Map<string, { name: string; place: Triple }>(); // by the bone as it was found
  private readonly others: CorrectionRow[]; // of scans
  private readonly first = new Map<string, string>();

  /// `rows`: what an earlier run was told; `boneAt` is the bone at a place.
  constructor(private readonly found: string[], rows: CorrectionRow[], boneAt: (place: Triple) => string) {
    this.others = rows.filter((row) => row.mark !== "");
    const named = rows.filter((row) => row.mark === "");
    for (const { name, place_mm } of named) this.said.set(boneAt(place_mm), { name, place: place_mm });
    // Whose name went to another bone has none, as the program has it.
    for (const { name, place_mm } of named) if (found.includes(name) && !this.said.has(name)) this.said.set(name, { name: "", place: place_mm });
    for (const one of found) this.first.set(one, this.nameOf(one));
  }

  static foundName(bone: string): string { return /-\d+$/.test(bone) ? "" : bone; }
  nameOf(bone: string): string { return this.said.get(bone)?.name ?? BoneNames.foundName(bone); }
  isRenamed(bone: string): boolean { return this.nameOf(bone) !== BoneNames.foundName(bone); }
  get changes(): number { return this.found.filter((one) => this.nameOf(one) !== this.first.get(one)).length; }

  /// The bone that had the name so far gets the other's, so that no name is given twice; `pointOn` is a point on it.
  rename(bone: string, name: string, place: Triple, pointOn: (bone: string) => Triple): void {
    const had = this.nameOf(bone);
    for (const other of this.found) if (name && other !== bone && this.nameOf(other) === name) this.said.set(other, { name: had, place: pointOn(other) });
    this.said.set(bone, { name, place });
  }

  rows(): CorrectionRow[] {
    const named = [...this.said.values()].filter(({ name }) => name !== "");
    return [...this.others, ...named.map(({ name, place }) => ({ posture: "", mark: "" as const, name, place_mm: place }))];
  }
}
