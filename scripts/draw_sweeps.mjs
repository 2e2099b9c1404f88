// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// node scripts/draw_sweeps.mjs PANELS.json > sweeps.svg
//
// Draws how figures of holds change along a sweep, for docs/method/equilibrium.md. PANELS.json is a list of panels:
// {"title": "peak on cells, kPa", "x": "diameter", "along": "mm", "lines": [{"name": "107 N", "csv": "d107.csv",
// "y": "peak_cells_kpa"}]}. The CSV files are those of benchmarks/hold_sweep, or tables with such columns. Lines begin
// at the zero of the axis, so that a step is as high as it is.
import { readFileSync } from "node:fs";

const width = 380, height = 220, columns = 2, left = 48, bottom = 34, top = 26, right = 12;
const colours = ["#1f5fa8", "#c2571a", "#2f8f4e", "#7a4a9e"];

function table(file) {
  const [head, ...rows] = readFileSync(file, "utf8").trim().split("\n").map((line) => line.split(","));
  return rows.map((row) => Object.fromEntries(head.map((name, k) => [name, row[k]])));
}

/** A round step that divides a range into some four. */
function step_of(range) {
  const rough = range / 4, power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].map((m) => m * power).find((step) => step >= rough);
}

function panel(one, k) {
  const lines = one.lines.map((line) => ({
    name: line.name,
    points: table(line.csv).map((row) => [Number(row[one.x]), Number(row[line.y])]),
  }));
  const xs = lines.flatMap((line) => line.points.map(([x]) => x));
  const x0 = Math.min(...xs), x1 = Math.max(...xs);
  const most = Math.max(...lines.flatMap((line) => line.points.map(([, y]) => y)));
  const y_step = step_of(most), y1 = Math.ceil(most / y_step) * y_step;
  const at = (x, y) => [left + ((x - x0) / (x1 - x0)) * (width - left - right),
    height - bottom - (y / y1) * (height - bottom - top)].map((v) => v.toFixed(1));
  const parts = [`<text x="${left}" y="16" font-weight="bold">${one.title}</text>`];
  for (let y = 0; y <= y1 + 1e-9; y += y_step) {
    const [, v] = at(x0, y);
    parts.push(`<line x1="${left}" x2="${width - right}" y1="${v}" y2="${v}" stroke="#ddd"/>`,
      `<text x="${left - 5}" y="${Number(v) + 4}" text-anchor="end">${Number(y.toPrecision(6))}</text>`);
  }
  const x_step = step_of(x1 - x0);
  for (let x = Math.ceil(x0 / x_step) * x_step; x <= x1 + 1e-9; x += x_step) {
    parts.push(`<text x="${at(x, 0)[0]}" y="${height - bottom + 15}" text-anchor="middle">${x}</text>`);
  }
  parts.push(`<text x="${width - right}" y="${height - 5}" text-anchor="end">${one.x.replace(/_.*/, "")}, ${one.along}</text>`);
  lines.forEach((line, n) => {
    parts.push(`<polyline fill="none" stroke="${colours[n]}" stroke-width="1.4" points="${line.points.map(([x, y]) => at(x, y).join(",")).join(" ")}"/>`,
      `<text x="${left + 4 + Math.min(84, (width - left - 100) / lines.length) * n}" y="${height - 5}" fill="${colours[n]}">${line.name}</text>`);
  });
  return `<g transform="translate(${(k % columns) * width} ${Math.floor(k / columns) * height})">${parts.join("\n")}</g>`;
}

if (process.argv.length !== 3) {
  console.error("usage: node scripts/draw_sweeps.mjs PANELS.json > sweeps.svg");
  process.exit(2);
}
const panels = JSON.parse(readFileSync(process.argv[2], "utf8"));
const rows = Math.ceil(panels.length / columns);
console.log(`<svg xmlns="http://www.w3.org/2000/svg" width="${columns * width}" height="${rows * height}" font-family="sans-serif" font-size="11">
<rect width="100%" height="100%" fill="white"/>
${panels.map(panel).join("\n")}
</svg>`);
