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
