// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The page docs/method/sensitivity.md: written by scripts/sensitivity.mjs, read by
// tests/sensitivity/sensitivity_test.mjs.

const kFactor = 1.05;  // as in sensitivity.cpp
/** Elasticity from which on a constant has a line of its own; degrees of a joint and score of a hold per 5 %. */
const kTold = 0.1, kToldJoint = 1.0, kToldLead = 0.1;
/** Longest value and words in a table. */
const kLongest = 48, kLongestWords = 80;
const kFigures = ["force", "area", "peak"];
/** What is certain is so many times the difference of both starts; that of one constant, the median of all. */
const kOwn = 2.0, kUsual = 3.0;

const is_warm = (anew) => anew === "rest" || anew === "prepared";
const cell = (text) => text.replace(/\|/g, "\\|");
const short = (text, most) => (text.length > most ? `${text.slice(0, most).replace(/\s\S*$/, "").trim()} …` : text);

/** What stands in the page for a constant's value. */
export const shown_value = (value) => cell(short(value.replace(/\b\w+::/g, ""), kLongest));

const median = (list) => (list.length ? [...list].sort((x, y) => x - y)[Math.floor(list.length / 2)] : 0);

/**
 * What a constant does to one product: per figure d ln(figure) / d ln(constant), of joints the degrees for 5 %, each with
 * half of the difference that the two starts make. `tries`: by factor. Nothing where a status changes.
 */
function derivatives(tries, usual) {
  const by_factor = [kFactor, 1 / kFactor].map((factor) =>
    tries.find((one) => Math.abs(one.factor - factor) < 1e-6)?.starts ?? usual);
  if (by_factor.flat().some((one, k) => one.status !== usual[k % usual.length].status)) return undefined;
  const [more, less] = by_factor;
  const found = {};
  for (const key of kFigures) {
    const [a, b] = more.map((one, k) => Math.log(one[key] / less[k][key]) / (2 * Math.log(kFactor)));
    found[key] = { value: (a + b) / 2, open: Math.abs(a - b) / 2 };
  }
  const joints = more[0].angles.map((_, j) => {
    const [a, b] = more.map((one, k) => (one.angles[j] - less[k].angles[j]) / 2);
    return { value: Math.abs(a + b) / 2, open: Math.abs(a - b) / 2 };
  });
  const sure = joints.filter(({ value, open }) => value > kOwn * open);
  found.joint = { value: Math.max(0, ...sure.map(({ value }) => value)), open: Math.max(...joints.map(({ open }) => open)) };
  return found;
}

/** Derivatives of all constants, and what each product leaves open as a rule: [{one, answer, on: product -> derivatives}]. */
function all_derivatives(constants, held, results) {
  const found = constants.map((one) => ({ one, answer: results[one.id], on: new Map() }));
  const open = new Map();
  for (const { one, answer, on } of found) {
    if (answer.error || one.anew === "ranked") continue;
    for (const product of held) {
      const tries = answer.results.filter((each) => each.product === product.product);
      if (tries.length === 0) continue;
      const group = `${product.product}:${is_warm(one.anew)}`;
      const here = derivatives(tries, is_warm(one.anew) ? product.at_rest : product.from_closed);
      on.set(product.product, here);
      if (here) open.set(group, [...(open.get(group) ?? []), here]);
    }
  }
  const usual = (product, warm, key) => median((open.get(`${product}:${warm}`) ?? []).map((one) => one[key].open));
  return { found, noise: (product, warm, key) => kUsual * usual(product, warm, key) };
}

/** A constant's largest derivatives that are certain, each of the product where it is largest. */
function summary({ one, answer, on }, held, noise) {
  const row = { ...one, force: 0, area: 0, peak: 0, joint: 0, on: "", falls: [], first: [], lead: 0, moves: false, error: answer.error };
  if (answer.error) return row;
  row.moves = answer.results.length > 0;
  for (const result of answer.results.filter(({ first }) => first !== undefined)) {
    const usual = held.find(({ product }) => product === result.product);
    if (result.first !== usual.first) row.first.push(result.product);
    row.lead = Math.max(row.lead, Math.abs(result.lead - usual.lead));
  }
  for (const [product, here] of on) {
    if (!here) {
      row.falls.push(product);
      continue;
    }
    const is_sure = (key) => Math.abs(here[key].value) > Math.max(kOwn * here[key].open, noise(product, is_warm(one.anew), key), 5e-4);
    for (const key of kFigures) {
      if (!is_sure(key)) continue;
      if (Math.abs(here[key].value) > score_of(row)) row.on = product;
      if (Math.abs(here[key].value) > Math.abs(row[key])) row[key] = here[key].value;
    }
    if (is_sure("joint")) row.joint = Math.max(row.joint, here.joint.value);
  }
  return row;
}

const score_of = (row) => Math.max(...kFigures.map((key) => Math.abs(row[key])));
const unique = (list) => [...new Set(list)];

const signed = (x) => (x === 0 ? "-" : `${x < 0 ? "−" : ""}${Math.abs(x).toFixed(2)}`);
const head_of = (row) => `| ${row.name} | ${row.file} | ${shown_value(row.value)} | ${cell(short(row.words, kLongestWords))} |`;

function row_of(row) {
  return `${head_of(row)} ${kFigures.map((key) => signed(row[key])).join(" | ")} | ${row.joint > 0 ? row.joint.toFixed(1) : "-"} | ` +
    `${row.on} | ${unique(row.falls).join(", ")} |`;
}

const ranked_row_of = (row) => `${head_of(row)} ${unique(row.first).join(", ")} | ${row.lead.toFixed(2)} |`;

function by_file(rows) {
  const files = new Map();
  for (const row of rows) files.set(row.file, [...(files.get(row.file) ?? []), row.name]);
  return [...files].map(([file, names]) => `| ${file} | ${names.join(", ")} |`).join("\n");
}

/** The page's text. `held`: the products; `results`: answers by a constant's id; `minutes`: that it took. */
export function page_of({ date, constants, held, results, minutes }) {
  const measured = constants.filter(({ id }) => id in results);
  const { found, noise } = all_derivatives(measured, held, results);
  const rows = found.map((one) => summary(one, held, noise))
    .sort((a, b) => score_of(b) - score_of(a) || b.joint - a.joint || b.first.length - a.first.length || b.lead - a.lead || (a.id < b.id ? -1 : 1));
  const holds = rows.filter((row) => !row.error && row.anew !== "ranked");
  const rankings = rows.filter((row) => !row.error && row.anew === "ranked");
  const is_told = (row) => score_of(row) >= kTold || row.joint >= kToldJoint || row.falls.length > 0;
  const is_told_of_ranking = (row) => row.first.length > 0 || row.lead >= kToldLead;
  const told = holds.filter(is_told);
  const little = holds.filter((row) => !is_told(row) && (score_of(row) > 0 || row.joint > 0));
  const noisy = holds.filter((row) => row.moves && !is_told(row) && !little.includes(row));
  const told_rankings = rankings.filter(is_told_of_ranking);
  const little_rankings = rankings.filter((row) => row.moves && !is_told_of_ranking(row));
  const still = rows.filter((row) => !row.error && !row.moves);
  const failed = rows.filter((row) => row.error);
  const not_varied = constants.filter(({ id }) => !(id in results));
  const noises = (one, warm) => `${kFigures.map((key) => noise(one.product, warm, key).toFixed(2)).join(", ")}; ${noise(one.product, warm, "joint").toFixed(1)}°`;
  const product_row = (one) => `| ${one.product} | ${one.hold} | ${one.force_n} N | ${one.at_rest[0].force.toFixed(1)} N | ${one.at_rest[0].area.toFixed(0)} mm² | ` +
    `${(1000 * one.at_rest[0].peak).toFixed(1)} kPa | ${noises(one, true)} | ${noises(one, false)} | ${one.first} |`;
  const list = (title, text, some) => (some.length ? `\n## ${title}\n\n${some.length} constants${text}\n\n| file of src/palmar | constants |\n| --- | --- |\n${by_file(some)}\n` : "");
  return `# How much each constant moves a hold

\`node scripts/sensitivity.mjs --page\` wrote this page on ${date}; don't edit it. Measuring took ${Math.max(1, Math.round(minutes))} minutes, after the build of a copy
of the sources in which constants can be changed while the program runs. The test \`sensitivity_page\` fails if the page names a constant
that the sources no longer have, or another value than theirs.

The built-in hand holds eight made products. Each named constant below \`grasp\` (but its indices), \`contact\` (but presses, fits and maps) and
\`hand/tendons\`, and each figure that an option struct of theirs has as a default, ${measured.length} in all, was multiplied by 1.05 and by 1/1.05, one
at a time. Whole numbers (rounds, counts) aren't varied. A list of figures counts as one constant.

| constants of | what is done anew |
| --- | --- |
| \`equilibrium\`, \`hand/tendons\` | the search for rest goes on from the product at rest |
| \`contact\` | the hand is prepared, and the search goes on from the product at rest |
| \`equilibrium\`: the search itself; \`rest\` | the search, from the closed hand, as in use |
| \`power\`, placing a hold | the hand closes in the same hold, and comes to rest |
| \`precision\` | the same for pen and phone |
| \`holds\`, \`find\` | holds of any grip are ranked; the hand doesn't close for contact |

**Elasticity** is the change of a figure in per cent when a constant changes by 1 %: d ln(figure) / d ln(constant), half of the
difference between both factors. Joints: the largest change of an angle for 5 %, degrees. Force is the sum of normal forces at the same
grip force; peak is that on cells. The tables have the largest of the eight products.

**Noise.** A search that begins exactly where it ended stays there, so each begins beside that, 0.05 mm and 0.06 degrees a coordinate, once
on one side and once on another. What both don't agree on within half of it, or what is below three times the median of all differences
(below, per product: force, area, peak; joints), isn't told: "-". Searches that go on from rest end at steps that promise 5 millionths of the merit; as in use they
end at 5 thousandths.

| product | hold | grip force | sum of normal forces | area | peak | noise from rest | noise from the closed hand | ranked first |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
${held.map(product_row).join("\n")}

## What moves a figure

${told.length} constants: an elasticity of ${kTold} or more, ${kToldJoint.toFixed(0)} degree or more of a joint, or a product that is at rest no longer, or only then. What has no
source beside it, or "our choice", is ours.

| constant | file of src/palmar | value | unit, source | force | area | peak | joints, deg | most on | at rest or not |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
${told.map(row_of).join("\n")}

## What moves the ranking of holds

${told_rankings.length} constants: another hold comes first, or the lead of the first over the next changes by ${kToldLead} or more for 5 %.

| constant | file of src/palmar | value | unit, source | another hold first | change of the lead |
| --- | --- | --- | --- | --- | --- |
${told_rankings.map(ranked_row_of).join("\n")}
${list("What moves them less", ".", [...little, ...little_rankings])}${list("What moves figures within the noise", ".", noisy)}${list("What moves nothing", `: not a digit differs. Most are ends of ranges, and rules for shapes, grips and tissue that these holds don't have.
What acts when the built-in hand or its compliance is made (of \`contact/bone\`) isn't made anew.`, still)}${list("Not varied", ": the compiler has to know them.", not_varied)}${failed.length ? `\n## Not measured\n\n${failed.map((row) => `- ${row.name}, ${row.file}: ${row.error}`).join("\n")}\n` : ""}`;
}

/** What the page names: {file, name, value}; value is unset where the page has none. */
export function named_on(page) {
  return page.split("\n").flatMap((line) => {
    const cells = line.split(/(?<!\\)\|/).slice(1, -1).map((each) => each.trim());
    const is_file = (text) => /^[\w/]+\.(h|cpp)$/.test(text ?? "");
    if (is_file(cells[0])) return cells[1].split(",").map((name) => ({ file: cells[0], name: name.trim() }));
    return is_file(cells[1]) ? [{ name: cells[0], file: cells[1], value: cells[2] }] : [];
  });
}

/** What is wrong with a page, a line each: constants that are gone or have another value. */
export function stale_names(page, constants) {
  const known = new Map(constants.map((one) => [one.id, one]));
  return named_on(page).flatMap(({ file, name, value }) => {
    const one = known.get(`${file}:${name}`);
    if (!one) return [`${name} of src/palmar/${file} is gone`];
    const now = shown_value(one.value);
    return value === undefined || value === now ? [] : [`${name} of src/palmar/${file} is ${now} now; the page says ${value}`];
  });
}
