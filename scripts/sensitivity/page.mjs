// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The page docs/method/sensitivity.md: written by scripts/sensitivity.mjs, read by
// tests/sensitivity/sensitivity_test.mjs.
import { plain_words } from "./plain_words.mjs";

const kFactor = 1.05;  // as in sensitivity.cpp
const kFigures = ["force", "area", "peak"];
const kKeys = [...kFigures, "joint"];
/** A change counts from that many times the quantile of those by chance on. */
const kOverChance = 2.0, kQuantile = 0.9;
/** Fewer constants that steer say nothing about chance. */
const kFewest = 5;
/** What a page shows at least, even where chance is less: per cent, degrees. */
const kShown = { force: 0.05, area: 0.05, peak: 0.05, joint: 0.05 };
/** Per cent: where changes of that size can't be told from chance, a rest is too flat to say. */
const kFlat = 1.0;
/** Constants with a line of their own, at most, from so many per cent or degrees on; change of a hold's lead. */
const kMostRows = 50, kTold = 0.5, kToldJoint = 0.5, kToldLead = 0.1;
const kMostRankings = 25;
const kFirst = 10;
/** Shares of what a task says, 1.0 of it: no choices of ours, but measures for those that are. */
const kGripForce = ["grasp/equilibrium/least_effort.cpp:kOnSkin.level", "grasp/equilibrium/least_effort.cpp:kWithFingertips[1].level"];
const kMuscles = ["grasp/rest/balance.h:BalanceOptions.strength"];
/** Longest line of text; value and words in a table. */
const kLine = 150, kLongest = 40, kLongestWords = 70;

const cell = (text) => text.replace(/\|/g, "\\|");
const short = (text, most) => (text.length > most ? `${text.slice(0, most).replace(/\s\S*$/, "").trim()} …` : text);

/** What stands in the page for a constant's value. */
export const shown_value = (value) => cell(short(value.replace(/\b\w+::/g, ""), kLongest));

const mean = (list) => list.reduce((sum, x) => sum + x, 0) / list.length;
const unique = (list) => [...new Set(list)];

/** The value that a share of a list doesn't exceed. */
export function quantile(list, share) {
  const sorted = [...list].sort((x, y) => x - y);
  return sorted.length > 0 ? sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)] : 0;
}

// ---- Changes ------------------------------------------------------------------------------------

/**
 * What 5 % more of a constant does to one product: per figure its change in per cent, of the joints the largest in degrees, half of
 * the difference of both factors, by the starts' mean; `agree`: all starts have the same sign; `open`: half of what they differ by.
 * `tries`: answers by factor.
 */
export function changes_on(tries, usual) {
  const [more, less] = [kFactor, 1 / kFactor].map((factor) => tries.find((one) => Math.abs(one.factor - factor) < 1e-6)?.starts ?? usual);
  // A factor that ends at the same status from all starts, but not as usual.
  const falls = [more, less].map((starts) => unique(starts.map(({ status }) => status))).filter((names) => names.length === 1 && names[0] !== usual[0].status).flat();
  const is_unsteady = [...more, ...less].some(({ status }, k) => status !== usual[k % more.length].status);
  const of = (per_start) => ({ change: mean(per_start), agree: per_start.every((x) => Math.sign(x) === Math.sign(per_start[0])),
    open: (Math.max(...per_start) - Math.min(...per_start)) / 2 });
  const found = { falls, is_unsteady };
  for (const key of kFigures) {
    found[key] = of(more.map((one, k) => (one[key] > 0 && less[k][key] > 0 ? 100 * (Math.sqrt(one[key] / less[k][key]) - 1) : 0)));
  }
  const joints = more.every(({ angles }, k) => angles?.length > 0 && less[k].angles?.length > 0)
    ? more[0].angles.map((_, j) => of(more.map((one, k) => (one.angles[j] - less[k].angles[j]) / 2))) : [];
  const largest = (some) => Math.max(0, ...some.map(({ change }) => Math.abs(change)));
  found.joint = { change: largest(joints.filter(({ agree }) => agree)), by_chance: largest(joints), agree: true,
                  open: Math.max(0, ...joints.map(({ open }) => open)) };
  return found;
}

/** Changes per product: [{one, answer, on: product -> changes_on()}]. */
function all_changes(constants, held, results, part = "results", usual = "at_rest") {
  return constants.filter(({ id, anew }) => results[id] && !results[id].error && !["ranked", "never"].includes(anew)).map((one) => {
    const answer = results[one.id];
    const on = new Map();
    for (const product of held) {
      const tries = (answer[part] ?? []).filter((each) => each.product === product.product);
      if (tries.length === 0) continue;
      const starts = product[usual].slice(0, tries[0].starts.length);
      on.set(product.product, changes_on(tries, starts));
    }
    return { one, answer, on };
  });
}

/**
 * Chance on a product: per figure the quantile of what constants change that steer, or, if that is more, of what both starts leave
 * open about all others. `is_steady`: nothing that steers changes its status.
 */
export function chance_of(steering, others, product) {
  const here = (some) => some.map((each) => each.on.get(product)).filter((each) => each);
  const on = here(steering);
  const chance = { count: on.length, is_steady: !on.some(({ is_unsteady }) => is_unsteady) };
  for (const key of kKeys) {
    chance[key] = Math.max(quantile(on.map((each) => Math.abs(each[key].by_chance ?? each[key].change)), kQuantile),
                           quantile(here(others).map((each) => each[key].open), kQuantile));
  }
  return chance;
}

/** From where on a change counts. */
export const noise_of = (chance, key) => (chance.count < kFewest ? Infinity : Math.max(kOverChance * chance[key], kShown[key]));

/** A constant's changes that count: per figure the largest, and on which product. */
function summary({ one, answer, on }, chances) {
  const row = { ...one, largest: {}, peaks: [], products: new Set(), falls: [], score: 0 };
  row.moves = answer.results.length > 0;
  for (const [product, here] of on) {
    const chance = chances.get(product);
    if (chance.is_steady && here.falls.length > 0) row.falls.push(`${product}: ${unique(here.falls).join(", ")}`);
    let most = 0;
    for (const key of kKeys) {
      const { change, agree } = here[key];
      if (!agree || Math.abs(change) < noise_of(chance, key)) continue;
      if (key === "peak") row.peaks.push(change);
      if (kFigures.includes(key)) {
        row.products.add(product);
        most = Math.max(most, Math.abs(change));
      }
      if (Math.abs(change) > Math.abs(row.largest[key]?.change ?? 0)) row.largest[key] = { change, product };
    }
    row.score += most / chances.size;
  }
  return row;
}

/** A constant's effect on which hold is taken. */
function ranking_of(one, answer, held) {
  const row = { ...one, first: [], lead: 0, moves: answer.results.length > 0 };
  for (const result of answer.results) {
    const usual = held.find(({ product }) => product === result.product);
    if (result.first !== usual.first) row.first.push(result.product);
    row.lead = Math.max(row.lead, Math.abs(result.lead - usual.lead));
  }
  row.first = unique(row.first);
  return row;
}

// ---- Words --------------------------------------------------------------------------------------

const figure = (x, digits) => x.toFixed(digits);
const signed = (x) => `${x < 0 ? "−" : "+"}${Math.abs(x) < 9.95 ? Math.abs(x).toFixed(1) : Math.abs(x).toFixed(0)}`;
const told_change = (row, key) => {
  const most = row.largest[key];
  if (!most) return row.moves ? "below noise" : "-";
  return `${key === "joint" ? figure(most.change, 1) : signed(most.change)} (${most.product})`;
};
const words_of = (row) => cell(short(row.words, kLongestWords)) || "-";
const plain_words_of = (row) => (plain_words[row.id] ? cell(plain_words[row.id]) : words_of(row));
const listed = (names) => (names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} and ${names.at(-1)}`);
const largest_of = (row) => kFigures.map((key) => ({ key, ...row.largest[key] })).filter(({ change }) => change !== undefined)
  .sort((a, b) => Math.abs(b.change) - Math.abs(a.change))[0];

const row_of = (row) => `| ${row.name} | ${row.file} | ${shown_value(row.value)} | ${words_of(row)} | ${kKeys.map((key) => told_change(row, key)).join(" | ")} | ` +
  `${row.products.size} |`;
const ranked_row_of = (row) => `| ${row.name} | ${row.file} | ${shown_value(row.value)} | ${words_of(row)} | ${row.first.join(", ")} | ${row.lead.toFixed(2)} |`;

/** A table of names by file; `columns`: title -> rows. */
function by_file(columns) {
  const files = new Map();
  columns.forEach(([, rows], k) => rows.forEach((row) => {
    if (!files.has(row.file)) files.set(row.file, columns.map(() => []));
    files.get(row.file)[k].push(row.name);
  }));
  const head = `| file of src/palmar | ${columns.map(([title]) => title).join(" | ")} |\n|${" --- |".repeat(columns.length + 1)}\n`;
  return head + [...files].sort(([a], [b]) => (a < b ? -1 : 1))
    .map(([file, names]) => `| ${file} | ${names.map((some) => some.join(", ")).join(" | ")} |`).join("\n");
}

/** The page's text. `held`: the products; `results`: answers by a constant's id; `minutes`: that it took. */
export function page_of({ date, constants, held, results, minutes }) {
  const measured = constants.filter(({ id, anew }) => id in results && anew !== "never");
  const is_steering = ({ one }) => one.anew === "steering";
  const found = all_changes(measured, held, results);
  const chances = new Map(held.map(({ product }) => [product, chance_of(found.filter(is_steering), found.filter((each) => !is_steering(each)), product)]));
  const in_use = all_changes(measured.filter(({ anew }) => anew === "steering"), held, results, "searched", "from_closed");
  const chances_in_use = new Map(held.map(({ product }) => [product, chance_of(in_use, [], product)]));
  const rows = found.filter((each) => !is_steering(each) && each.one.anew !== "searched").map((each) => summary(each, chances))
    .sort((a, b) => b.score - a.score || (b.largest.joint?.change ?? 0) - (a.largest.joint?.change ?? 0) || (a.id < b.id ? -1 : 1));
  const rankings = measured.filter(({ id, anew }) => anew === "ranked" && !results[id].error).map((one) => ranking_of(one, results[one.id], held))
    .sort((a, b) => b.first.length - a.first.length || b.lead - a.lead || (a.id < b.id ? -1 : 1));
  const says = found.filter(({ one }) => one.anew === "searched");

  const counts = (row) => largest_of(row) !== undefined || row.largest.joint !== undefined || row.falls.length > 0;
  const told = rows.filter((row) => Math.abs(largest_of(row)?.change ?? 0) >= kTold || (row.largest.joint?.change ?? 0) >= kToldJoint || row.falls.length > 0).slice(0, kMostRows);
  const told_rankings = rankings.filter((row) => row.first.length > 0 || row.lead >= kToldLead).slice(0, kMostRankings);
  const less = [...rows.filter((row) => counts(row) && !told.includes(row)), ...rankings.filter((row) => row.moves && !told_rankings.includes(row))];
  const noisy = rows.filter((row) => row.moves && !counts(row));
  const still = [...rows, ...rankings].filter((row) => !row.moves);
  const steer = found.filter(is_steering).map(({ one }) => one);
  const failed = measured.filter(({ id }) => results[id].error);
  const fixed = constants.filter(({ is_fixed, value, anew }) => is_fixed || value.startsWith("std::numbers") || anew === "never");
  const late = constants.filter((one) => !(one.id in results) && !fixed.includes(one));
  const of_task = (ids) => rows.filter(({ id }) => ids.includes(id)).flatMap(({ peaks }) => peaks);
  const first = rows.filter(({ id, score }) => score > 0 && ![...kGripForce, ...kMuscles].includes(id)).slice(0, kFirst);
  const first_row = (row) => `| ${plain_words_of(row)} | ${row.name} | ${row.file} | ${shown_value(row.value)} | ` +
    `${kFigures.map((key) => told_change(row, key)).join(" | ")} | ${row.products.size} |`;
  const noises = (chance) => kKeys.map((key) => (noise_of(chance, key) === Infinity ? "-" : noise_of(chance, key).toFixed(key === "joint" ? 1 : 2))).join(" | ");
  const product_row = (one) => `| ${one.product} | ${one.hold} | ${one.force_n} N | ${one.at_rest[0].force.toFixed(1)} N | ${one.at_rest[0].area.toFixed(0)} mm² | ` +
    `${(1000 * one.at_rest[0].peak).toFixed(1)} kPa | ${noises(chances.get(one.product))} | ${noise_of(chances_in_use.get(one.product), "peak").toFixed(1)} |`;

  return `# How much each constant moves a hold

${lead_words({ first, force: of_task(kGripForce), muscles: of_task(kMuscles), held, chances, chances_in_use })}

| what it is | constant | file of src/palmar | value | sum of normal forces, % | area, % | peak, % | products |
| --- | --- | --- | --- | --- | --- | --- | --- |
${first.map(first_row).join("\n")}

Each figure is the largest change that counts, in per cent for 5 % more of the constant, with the product that has it. "Below noise" is a change that can't be told
from chance, "-" none at all. The last column says on how many of the ${held.length} products force, area or peak change by more than chance; the order is that of the mean over all
products of the largest of the three.${late_words(late, constants.length - fixed.length)}

\`node scripts/sensitivity.mjs --page\` wrote this page on ${date}; don't edit it. The test \`sensitivity_page\` fails if a constant here is gone or has another value.

## Products, and what is chance

${steer.length} constants only steer the search for rest: how it is damped, when it ends, how exact its derivatives are. What they change is chance. All searches
begin at two starts, 0.05 mm and 0.06 degrees beside the rest; what these leave open is chance, too. The noise below is twice the ${100 * kQuantile} % quantile of the changes that the
first make, or of half of what both starts differ by over all other constants, if that is more, and at least ${kShown.force} % and ${kShown.joint} degrees. A change counts if it is above
the noise of its product and figure, and if both starts agree on its sign.

| product | hold | grip force | normal forces | area | peak on cells | noise: force, % | area, % | peak, % | joints, deg | peak in use, % |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |
${held.map(product_row).join("\n")}

In use, a search begins at the closed hand and ends when a step promises less than 5 thousandths of the merit. The last column has the noise of such searches, by what steers;
no change on this page was measured by them. Here they go on from the product at rest until a step promises 5 millionths. So the page says how a hold changes, and not
whether the search would have found another one.

## What was changed

${measured.length} constants: those below \`grasp\`, \`contact\` and \`hand/tendons\` that a hold, its equilibrium or its contact rests on, and the figures that option structs there have as
defaults. Each was multiplied by 1.05 and by 1/1.05, one at a time; half of the difference is told. Whole numbers (rounds, counts) aren't varied, nor is what belongs to the hand,
such as the stiffness of its tissue. A list of figures counts as one constant. Measuring took ${Math.max(1, Math.round(minutes))} minutes.

| constants of | what is done anew |
| --- | --- |
| \`grasp/equilibrium\`, \`hand/tendons\` | the search goes on from the product at rest |
| \`contact\` | the hand is prepared, of \`contact/bone\` its tissue computed, and the search goes on |
| \`grasp/power\`, \`grasp/precision\`, placing a hold | the hand closes in the same hold; the search goes on from there, moved as it had moved to rest |
| \`grasp/holds\`, \`grasp/find\` | holds are ranked; the hand doesn't come to rest |

## What moves a figure

These are ${told.length === kMostRows ? `the first ${kMostRows} constants of a longer list` : `the ${told.length} constants`} that change a figure by ${kTold} % or a joint by ${kToldJoint} degrees or more. What has no source beside it, or "our choice", is ours.${falls_words(rows)}

| constant | file of src/palmar | value | unit and source | force, % | area, % | peak, % | joints, deg | products |
| --- | --- | --- | --- | --- | --- | --- | --- | --- |
${told.map(row_of).join("\n")}
${rankings.length === 0 ? "" : `
## What moves the choice of a hold

${told_rankings.length} of ${rankings.length} constants: another hold comes first, or the score of the first gains or loses ${kToldLead} or more on the next.

| constant | file of src/palmar | value | unit and source | another hold first | change of the lead |
| --- | --- | --- | --- | --- | --- |
${told_rankings.map(ranked_row_of).join("\n")}
`}
## All others

What moves nothing changes no digit. Most of that are ends of ranges, and rules for shapes, grips and tissue that these holds don't have. Not varied is what the compiler
has to know, and what nobody could choose otherwise, as units.${failed.length === 0 ? "" : ` With ${listed(failed.map(({ name }) => `\`${name}\``))} the program ended or took too long.`}

${by_file([["moves figures less", less], ["below noise", noisy], ["moves nothing", still], ["steers or judges", [...steer, ...says.map(({ one }) => one)]],
    ["not varied", [...fixed, ...failed]], ["not measured yet", late]].filter(([, some]) => some.length > 0))}
`;
}

/** In lines of at most kLine characters. */
const wrapped = (text) => text.split("\n").map((line) => line.split(" ").reduce((lines, word) => {
  if (`${lines.at(-1)} ${word}`.length > kLine) return [...lines, word];
  return [...lines.slice(0, -1), lines.at(-1) === "" ? word : `${lines.at(-1)} ${word}`];
}, [""]).join("\n")).join("\n");

const range = (list) => {
  const most = [...list].sort((x, y) => x - y);
  return `${signed(most[0])} to ${signed(most.at(-1))} %`;
};

function lead_words({ first, force, muscles, held, chances, chances_in_use }) {
  const names = { force: "sum of normal forces", area: "contact area", peak: "peak pressure" };
  const sizes = first.map((row) => Math.abs(largest_of(row).change));
  const begins = "How far do a report's figures depend on numbers that somebody had to choose? The built-in hand held eight made products, and each number was changed by 5 %.";
  const tasks = force.length === 0 ? "" : ` For comparison: 5 % more grip force changes the peak pressure by ${range(force)}` +
    `${muscles.length === 0 ? "" : `, muscles that are 5 % stronger by ${range(muscles)}`}, depending on the product.`;
  const ten = first.length === 0 ? " No constant moves a figure by more than chance." :
    ` The ${first.length === kFirst ? "ten" : first.length} constants of this table matter most: 5 % more of one of them changes a figure of some product by ${Math.min(...sizes).toFixed(1)} to ` +
    `${signed(Math.max(...sizes)).slice(1)} %. The first ${first.length > 3 ? "three are" : "are"} ${listed(first.slice(0, 3).map((row) => {
      const most = largest_of(row);
      return `${plain_words_of(row)} (${names[most.key]} of the ${most.product}: ${signed(most.change)} %)`;
    }))}.`;
  const flat = held.map(({ product }) => ({ product, figures: kFigures.map((key) => ({ key, noise: noise_of(chances.get(product), key) })).filter(({ noise }) => noise > kFlat) }))
    .filter(({ figures }) => figures.length > 0)
    .map(({ product, figures }) => `the ${product} (${listed(figures.map(({ key, noise }) => `${names[key]}: ${noise === Infinity ? "unknown" : `${noise.toFixed(1)} %`}`))})`);
  const flat_words = flat.length === 0 ? ` On all products changes of ${kFlat} % can be told from chance.` :
    ` The state of rest is too flat to say for ${listed(flat)}: there, hands that rest a little otherwise are as good, and changes below these figures can't be told from chance.`;
  const unsteady = held.filter(({ product }) => !chances.get(product).is_steady).map(({ product }) => `the ${product}`);
  const status = unsteady.length === 0 ? "" : ` Whether ${listed(unsteady)} ${unsteady.length > 1 ? "stay" : "stays"} in the hand is decided by chance, too.`;
  const in_use = held.map(({ product }) => ({ product, noise: noise_of(chances_in_use.get(product), "peak") })).filter(({ noise }) => noise > kFlat && noise < Infinity)
    .sort((a, b) => b.noise - a.noise);
  const use = in_use.length === 0 ? "" : ` In use, where searches end earlier, peak pressures can differ by chance by ${listed(in_use.map(({ product, noise }) => `${noise.toFixed(0)} % (${product})`))}.`;
  return wrapped(`${begins}${ten}${tasks}\n\n${flat_words.trim()}${status}${use}`);
}

function late_words(late, all) {
  if (late.length === 0) return "";
  const kinds = { rest: "equilibrium", prepared: "contact", closed: "closing the hand in power grips", fingertips: "grips with fingertips", ranked: "the choice of a hold",
    compliance: "the tissue between skin and bone", searched: "the verdict whether a product is at rest", steering: "the search" };
  const counts = Object.entries(kinds).map(([kind, words]) => [words, late.filter(({ anew }) => anew === kind).length]).filter(([, count]) => count > 0);
  return wrapped(`\n\n**Not measured yet** are ${late.length} of ${all} constants, because the run was stopped: ${listed(counts.map(([words, count]) => `${count} of ${words}`))}. ` +
    "They may matter as much. `node scripts/sensitivity.mjs --built --page` goes on with them.");
}

function falls_words(rows) {
  const falling = rows.filter((row) => row.falls.length > 0);
  return falling.length === 0 ? " None of them makes a product slip out of the hand." :
    ` ${falling.length > 1 ? "Some change" : "One changes"} whether a product stays in the hand: ${falling.map((row) => `\`${row.name}\` (${row.falls.join("; ")})`).join(", ")}.`;
}

// ---- Names --------------------------------------------------------------------------------------

/** What the page names: {file, name, value}; value is unset where the page has none. */
export function named_on(page) {
  return page.split("\n").flatMap((line) => {
    const cells = line.split(/(?<!\\)\|/).slice(1, -1).map((each) => each.trim());
    const at = cells.findIndex((text) => /^[\w/]+\.(h|cpp)$/.test(text));
    if (at === 0) return cells.slice(1).join(",").split(",").filter((name) => name.trim()).map((name) => ({ file: cells[0], name: name.trim() }));
    return at > 0 ? [{ name: cells[at - 1], file: cells[at], value: cells[at + 1] }] : [];
  });
}

/** What is wrong with a page, a line each: constants that are gone or have another value. */
export function stale_names(page, constants) {
  const known = new Map(constants.map((one) => [one.id, one]));
  const names = new Set(constants.map(({ name }) => name));
  const in_tables = named_on(page).flatMap(({ file, name, value }) => {
    const one = known.get(`${file}:${name}`);
    if (!one) return [`${name} of src/palmar/${file} is gone`];
    const now = shown_value(one.value);
    return value === undefined || value === now ? [] : [`${name} of src/palmar/${file} is ${now} now; the page says ${value}`];
  });
  const in_words = unique([...page.matchAll(/`(k[A-Z]\w*(?:\[\d+\])?(?:\.\w+)?|[A-Z]\w*(?:Model|Options)\.\w+)`/g)].map(([, name]) => name));
  return [...in_tables, ...in_words.filter((name) => !names.has(name)).map((name) => `${name} is gone`)];
}
