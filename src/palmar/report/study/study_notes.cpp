// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "palmar/core/version.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/page/viewer_bundle.h"
#include "palmar/report/study/study_sections.h"
#include "palmar/report/study/study_words.h"

namespace palmar {
namespace {

std::string svg_bar(const ColourScale& scale, const std::string& key, bool is_shown) {
  constexpr int kTop = 40, kHeight = 380, kBands = 64;
  std::string svg = std::string("<svg data-bar=\"") + key + "\"" + (is_shown ? "" : " hidden") +
                    " xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 112 480\" width=\"112\" "
                    "height=\"480\" role=\"img\" font-size=\"13\" fill=\"#1d2329\" "
                    "aria-label=\"Colour scale\"><text x=\"0\" y=\"14\">" +
                    html_escaped(scale.quantity) + ",</text><text x=\"0\" y=\"30\">" +
                    html_escaped(scale.unit) + "</text>";
  const double band = static_cast<double>(kHeight) / kBands;
  for (int i = 0; i < kBands; ++i) {
    svg += "<rect x=\"0\" y=\"" + short_number(kTop + kHeight - (i + 1) * band, 6) +
           "\" width=\"22\" height=\"" + short_number(band + 0.5, 4) + "\" fill=\"" +
           hex_colour(map_colour(scale.map, (i + 0.5) / kBands)) + "\"/>";
  }
  const Ticks ticks = ticks_of(scale);
  for (std::size_t i = 0; i < ticks.value.size(); ++i) {
    const double y = kTop + kHeight * (1.0 - ticks.value[i] / scale.upper);
    svg += "<path d=\"M22 " + short_number(y, 5) + "h5\" stroke=\"#47515b\"/><text x=\"31\" y=\"" +
           short_number(y + 4.5, 5) + "\">" + html_escaped(ticks.text[i]) + "</text>";
  }
  return svg + "<rect x=\"0\" y=\"442\" width=\"22\" height=\"14\" fill=\"" +
         hex_colour(scale.neutral) +
         "\" stroke=\"#47515b\"/><text x=\"31\" y=\"454\">none</text></svg>";
}

std::string toggle(const std::string& key, const std::string& words, bool is_on) {
  return "<label><input type=\"checkbox\" data-toggle=\"" + key + "\"" + (is_on ? " checked" : "") +
         "> " + words + "</label>";
}

std::string look(const std::string& key, const std::string& words) {
  return "<button type=\"button\" data-look=\"" + key + "\">" + words + "</button>";
}

std::string words_of(const StudySetting& one) {
  std::string words = one.name + ": pressed in up to " + short_number(one.palm_limit_depth) +
                      " mm (palm) and " + short_number(one.finger_limit_depth) + " mm (fingers)";
  if (one.grip_force) words += ", grip force " + short_number(*one.grip_force) + " N";
  if (one.strength_share) {
    words += ", " + short_number(100.0 * *one.strength_share) + " % of the person’s grip strength";
  }
  words += one.is_balanced ? ", brought to rest with friction " + short_number(one.friction)
                           : ", left as the hand was closed";
  words += one.is_place_per_hand ? "; place searched for every hand"
                                 : "; place found on the mean hand and kept";
  return words + "; equations: " + name_of(one.model);
}

std::string words_of(const StudyPopulation& one, const StudyPlan& plan, int index) {
  const auto hands = std::count_if(plan.hands.begin(), plan.hands.end(),
                                   [&](const StudyHand& hand) { return hand.population == index; });
  std::string words = (one.population.title.empty() ? one.population.name : one.population.title) +
                      " (" + one.population.name + "): " + std::to_string(hands) + " hands";
  switch (one.sampling.design) {
    case SamplingDesign::kRandom:
      words += ", drawn at random";
      break;
    case SamplingDesign::kLatinHypercube:
      words += ", Latin hypercube";
      break;
    case SamplingDesign::kBoundary:
      words += ", boundary of the " + short_number(100.0 * one.sampling.boundary) + " % ellipse";
      break;
    case SamplingDesign::kPercentiles:
      words += ", percentiles";
      break;
  }
  words += ", seed " + std::to_string(one.sampling.seed);
  if (!one.population.source.empty()) words += ". Source: " + one.population.source;
  return words;
}

std::string item(const std::string& text) { return "<li>" + html_escaped(text) + "</li>"; }

std::string hash_words(const std::string& hash) {
  return hash.empty() ? "" : ", SHA-256 " + hash.substr(0, 16) + "…";
}

}  // namespace

std::string scene_section(const StudyPage& page) {
  if (page.scene.empty()) return {};
  const StudyPlan& plan = page.results.plan;
  const ConditionAnalysis& first = page.analysis.conditions.front();
  const std::vector<int> hands = hands_of(plan, first.condition);
  std::string products;
  for (std::size_t p = 0; p < plan.products.size(); ++p) {
    products += "<option value=\"" + std::to_string(p) + "\">" +
                html_escaped(plan.products[p].name) + "</option>";
  }
  std::string who =
      "<optgroup label=\"Over all hands\"><option value=\"mean\">Mean pressure</option>"
      "<option value=\"sd\">Standard deviation</option><option value=\"above\">Share of hands "
      "above " +
      short_number(1000.0 * page.threshold) +
      " kPa</option></optgroup><optgroup label=\"One hand\">";
  const std::vector<int>& shown = page.shown_hands;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    who += "<option value=\"" + std::to_string(i) + "\">" +
           html_escaped(hand_words(plan, first.condition, shown[i])) + "</option>";
  }
  who += "</optgroup>";
  std::string html = "<h2 id=\"turn\">Turn it</h2>\n<p>";
  const std::string which = condition_words(plan, first.condition);
  if (!which.empty()) {
    html += "<strong>" + html_escaped(capitalised(which)) + "</strong>, the first of " +
            std::to_string(page.analysis.conditions.size()) + " conditions. ";
  }
  html += shown.size() == hands.size()
              ? "Every hand with every product"
              : std::to_string(shown.size()) + " of " + std::to_string(hands.size()) +
                    " hands, evenly chosen by hand length,";
  html +=
      " and the maps over all hands. Skin that would be inside the product is laid on its surface; "
      "the bulge beside the contact isn’t shown.</p>\n"
      "<section class=\"view\" data-palmar-scene=\"study-scene\" data-palmar-kind=\"study\" "
      "aria-label=\"3-D view\"><div class=\"controls\"><label>Product <select "
      "data-toggle=\"which-product\">" +
      products + "</select></label><label>Show <select data-toggle=\"which-hand\">" + who +
      "</select></label></div><div class=\"view-body\"><div class=\"view-canvas\" data-label=\"3-D "
      "view of hands and products\"><p class=\"view-fallback\">The turnable 3-D view needs scripts "
      "and WebGL. The pictures below show the maps over all hands.</p></div><div "
      "class=\"view-bar\">" +
      svg_bar(page.scales.grasp, "grasp", false) + svg_bar(page.scales.mean, "mean", true) +
      svg_bar(page.scales.sd, "sd", false) + svg_bar(page.scales.above, "above", false) +
      "</div></div><p class=\"view-says\" aria-live=\"polite\"></p>" +
      (page.faces.empty() ? ""
                          : "<p class=\"view-says view-face\">Point at the product: its face is "
                            "named here.</p>") +
      "<div class=\"controls\">" + toggle("skin", "Hand", true) +
      toggle("pressure", "Pressure on the skin", true) + toggle("product", "Product", true) +
      toggle("footprint", "Pressure on the product", false) +
      toggle("see-through", "See through the product", true) +
      (page.faces.empty() ? "" : toggle("faces", "Borders of faces", true)) +
      toggle("open", "Maps on the open hand", false) +
      "</div><div class=\"controls\"><span>Look from:</span>" + look("palm", "Palm") +
      look("back", "Back") + look("thumb", "Thumb side") + look("little", "Little finger") +
      "<span>Drag to turn, wheel or pinch to zoom, right drag to move; arrow keys, + and &#8722; "
      "after a click.</span></div>";
  return html + "<script type=\"application/json\" id=\"study-scene\">" +
         script_escaped(page.scene) + "</script></section>\n";
}

std::string method_section(const StudyPage& page) {
  const bool has_profiles = page.results.plan.profiles.size() > 1;
  std::string html =
      "<h2 id=\"method\">How this was computed</h2>\n<p>Every hand is the template scaled segment "
      "by segment to a sampled person’s dimensions. It closes round the product (Xie 2014, 5.5.1), "
      "comes to rest on it unless a setting says otherwise, and the skin’s contact is solved; "
      "equations and tissue stand under Provenance. All hands have one tissue: people differ in "
      "stiffness, too. The sum of normal forces is not the reading of a dynamometer; the grip "
      "force "
      "is nearer to it.</p>\n<p>Products are compared over the same hands. The t-test is Student’s "
      "for pairs, as in the thesis; Wilcoxon’s signed-rank test needs no normal differences. p "
      "values are corrected after Holm over all pairs of a quantity. Cohen’s dz is the mean "
      "difference over the standard deviation of the differences. <strong>These are simulated "
      "hands: enough of them make any difference significant.</strong> Judge by the size of the "
      "difference and its interval; p says only that it isn’t the chance of which hands were "
      "drawn. "
      "It doesn’t cover the errors of the model, which are larger: compare products, don’t take "
      "single figures for people’s.</p>\n<p>Shares have intervals after Wilson. A hand that "
      "doesn’t "
      "hold a product counts as outside the limits and is left out of means and tests; tables say "
      "how many and why. Sizes: every subset of a family’s sizes was tried.</p>\n";
  if (has_profiles) {
    html +=
        "<p>Profiles take range, strength, gloves, nails and size as factors on any population. "
        "They are not measured people.</p>\n";
  }
  return html +
         "<p>Methods: Y. Xie, Plausible 3D Human Hand Modeling for Virtual Ergonomic Assessments "
         "of "
         "Handheld Product, Hokkaido University, 2014, chapter 5, with the changes that Palmar’s "
         "documentation lists.</p>\n";
}

std::string provenance_section(const StudyPage& page) {
  const StudyPlan& plan = page.results.plan;
  const HandDimensions& d = page.base.dimensions;
  std::string html = "<h2 id=\"provenance\">Provenance</h2>\n<p>Study <code>" +
                     html_escaped(plan.name) + "</code>, seed " + std::to_string(plan.seed) + ".";
  if (!page.digest.empty())
    html += " Results: SHA-256 <code>" + html_escaped(page.digest) + "</code>.";
  if (page.digest.empty()) html += " The study isn’t finished, so its results have no digest.";
  if (!page.program.empty()) html += " Run by Palmar " + html_escaped(page.program) + ".";
  html += " This page by " + html_escaped(build_description()) +
          ".</p>\n<h3>Populations</h3><ul class=\"plain\">";
  for (std::size_t p = 0; p < plan.populations.size(); ++p) {
    html += item(words_of(plan.populations[p], plan, static_cast<int>(p)));
    for (const std::string& caution : plan.populations[p].population.cautions) {
      html += item("Caution: " + caution);
    }
  }
  html += "</ul>\n<h3>Products</h3><ul class=\"plain\">";
  for (const StudyProduct& one : plan.products) {
    std::string words = one.name + ": " + one.file;
    if (one.size != 1.0) words += ", size " + short_number(one.size);
    words += one.mass > 0.0 ? ", " + short_number(one.mass) + " kg" : ", no load";
    if (!one.posture_of.empty()) words += ", in the posture of " + one.posture_of;
    html += item(words + hash_words(one.content_hash));
  }
  html += "</ul>\n<h3>Grips, settings, profiles</h3><ul class=\"plain\">";
  for (const std::optional<Grip>& grip : plan.grips) {
    html += item("Grip: " + (grip ? std::string(name_of(*grip))
                                  : std::string("the power grip that suits the shape")));
  }
  for (const StudySetting& one : plan.settings) html += item("Setting " + words_of(one));
  for (const HandProfile& one : plan.profiles) {
    if (one.name == "none") continue;
    html += item("Profile " + one.name + ": range × " + short_number(one.range_share) +
                 ", strength × " + short_number(one.strength_share) + ", gloves " +
                 short_number(one.glove_thickness) + " mm, nails " + short_number(one.nail_length) +
                 " mm, size × " + short_number(one.size_factor) +
                 (one.source.empty() ? "" : ". Source: " + one.source));
  }
  html += "</ul>\n<h3>Hand and tissue</h3><p>" + html_escaped(page.base.name) + ", " +
          std::string(name_of(page.base.side)) + "; length " + short_number(d.hand_length, 4) +
          " mm, circumference " + short_number(d.hand_circumference, 4) + " mm" +
          hash_words(plan.hand_hash) + ". " + html_escaped(page.base.provenance) + "</p>\n";
  html += "<p>Stiffness of the skin (shear modulus at first touch and at the limit depth): ";
  bool is_first = true;
  for (const Region region : {Region::kIndexDistal, Region::kThenar}) {
    const TissueStiffness& tissue =
        page.base.tissue.region[at(static_cast<int>(region))].half_space;
    html += std::string(is_first ? "" : "; ") + html_escaped(plain_words(region)) + " " +
            short_number(1000.0 * tissue.nominal.g0) + " and " +
            short_number(1000.0 * tissue.nominal.g_limit) + " kPa at " +
            short_number(tissue.nominal.limit_depth) + " mm";
    is_first = false;
  }
  html +=
      ".</p>\n<p>Valid for: adult hands of about 150 to 215 mm, rigid products, handles of 25 to "
      "70 mm, indentation up to 4 mm (fingers) and 7 mm (palm), a hold of some seconds.</p>\n";
  if (!page.scene.empty()) {
    html += "<details><summary>Licence of the 3-D view (three.js, MIT)</summary><pre>" +
            html_escaped(viewer_licence()) + "</pre></details>\n";
  }
  return html;
}

}  // namespace palmar
