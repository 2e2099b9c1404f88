// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// What the colours mean: kPa from 0 to the upper end, and the colour of no contact.
import { decimal, say } from "./say";
import { Triple } from "../viewer/stage";
import { Colours } from "./scene";
import { tickStep } from "./ticks";

/// What a bar is of.
export interface BarWords {
  title: string;
  unit: string;
  none: string;
  noneColour: Triple;
}

/// SVG of 104 x 330, as the viewer's pictures take it; without words for pressure, kPa.
export function colourBar(colours: Colours, upper: number, words?: BarWords): string {
  const { title, unit, none, noneColour } = words ?? { title: say("bench.pressure"), unit: "kPa", none: say("bench.no_pressure"), noneColour: colours.neutral };
  const top = 46, height = 232, x = 8, width = 20;
  const parts: string[] = [];
  const n = 58;
  for (let i = 0; i < n; ++i) {
    const [r, g, b] = colours.table[Math.round((255 * (i + 0.5)) / n)];
    parts.push(`<rect x="${x}" y="${top + (height * (n - 1 - i)) / n}" width="${width}" height="${height / n + 0.6}" fill="rgb(${r},${g},${b})"/>`);
  }
  const step = tickStep(upper);
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9) + (step / 10 ** Math.floor(Math.log10(step) + 1e-9) === 2.5 ? 1 : 0));
  for (let value = 0; value <= upper * 1.0001; value += step) {
    const y = top + height * (1 - value / upper);
    const isTop = value + step > upper * 1.0001 && Math.abs(value - upper) < 1e-6 * upper;
    parts.push(`<path d="M${x + width} ${y.toFixed(1)}h5" stroke="#1d2329"/><text x="${x + width + 9}" y="${(y + 4).toFixed(1)}">${isTop ? "≥ " : ""}${decimal(value, decimals)}</text>`);
  }
  const [r, g, b] = noneColour;
  return `<svg viewBox="0 0 104 330" width="104" height="330" role="img" aria-label="${title}, ${unit}" font-size="13" fill="#1d2329">` +
    `<text x="4" y="16">${title}</text><text x="4" y="33">${unit}</text>${parts.join("")}` +
    `<rect x="${x}" y="${top + height + 16}" width="${width}" height="16" fill="rgb(${r},${g},${b})" stroke="#6b747d"/>` +
    `<text x="${x + width + 9}" y="${top + height + 29}">${none}</text></svg>`;
}
