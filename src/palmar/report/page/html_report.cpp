// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/html_report.h"

#include <algorithm>

#include "palmar/core/error.h"
#include "palmar/core/version.h"
#include "palmar/formats/mesh/vtk.h"
#include "palmar/report/chart/svg_chart.h"
#include "palmar/report/page/balance_section.h"
#include "palmar/report/page/error_band.h"
#include "palmar/report/page/face_tables.h"
#include "palmar/report/page/friction_section.h"
#include "palmar/report/page/html_comparison.h"
#include "palmar/report/page/html_style.h"
#include "palmar/report/page/html_tables.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/index_section.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/page/pressure_limits.h"
#include "palmar/report/page/viewer_bundle.h"
#include "palmar/report/picture/scene_data.h"

namespace palmar {

namespace {

// Colour bar beside the 3-D view.
std::string svg_colour_bar(const ColourScale& scale) {
  constexpr int kTop = 30;
  constexpr int kHeight = 400;
  constexpr int kBands = 64;
  std::string svg =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 104 490\" width=\"104\" "
      "height=\"490\" role=\"img\" font-size=\"13\" fill=\"#1d2329\" aria-label=\"Colour scale: " +
      html_escaped(scale.quantity) + " from 0 to " + short_number(scale.upper) + " " +
      html_escaped(scale.unit) + "\"><text x=\"0\" y=\"14\">" + html_escaped(scale.quantity) +
      ", " + html_escaped(scale.unit) + "</text>";
  for (int i = 0; i < kBands; ++i) {
    const double band = static_cast<double>(kHeight) / kBands;
    svg += "<rect x=\"0\" y=\"" + short_number(kTop + kHeight - (i + 1) * band, 6) +
           "\" width=\"22\" height=\"" + short_number(band + 0.5, 4) + "\" fill=\"" +
           hex_colour(map_colour(scale.map, (i + 0.5) / kBands)) + "\"/>";
  }
  const Ticks ticks = ticks_of(scale);
  for (std::size_t i = 0; i < ticks.value.size(); ++i) {
    const double y = kTop + kHeight * (1.0 - ticks.value[i] / scale.upper);
    svg += "<path d=\"M22 " + short_number(y, 5) + "h5\" stroke=\"#47515b\"/><text x=\"31\" y=\"" +
           short_number(y + 4.5, 5) + "\">" + ticks.text[i] + "</text>";
  }
  return svg + "<rect x=\"0\" y=\"452\" width=\"22\" height=\"14\" fill=\"" +
         hex_colour(scale.neutral) +
         "\" stroke=\"#47515b\"/><text x=\"31\" y=\"464\">none</text></svg>";
}

std::string toggle(const std::string& key, const std::string& words, bool is_on) {
  return "<label><input type=\"checkbox\" data-toggle=\"" + key + "\"" + (is_on ? " checked" : "") +
         "> " + words + "</label>";
}

std::string look(const std::string& key, const std::string& words) {
  return "<button type=\"button\" data-look=\"" + key + "\">" + words + "</button>";
}

std::string scene_view(const Hand& hand, const AssessedProduct& one, const ColourScale& scale,
                       const std::string& id) {
  return "<h3>Turn it</h3><section class=\"view\" data-palmar-scene=\"" + id +
         "\" aria-label=\"3-D view\"><div class=\"view-body\"><div class=\"view-canvas\" "
         "data-label=\"3-D view of the hand and " +
         html_escaped(one.product.name) +
         "\"><p class=\"view-fallback\">The turnable 3-D view needs scripts and WebGL. The "
         "pictures "
         "below show the same result from four sides.</p></div><div class=\"view-bar\">" +
         svg_colour_bar(scale) + "</div></div><div class=\"controls\">" +
         toggle("skin", "Hand", true) + toggle("pressure", "Pressure on the skin", true) +
         toggle("undeformed", "Skin before contact", false) + toggle("product", "Product", true) +
         toggle("footprint", "Pressure on the product", false) +
         toggle("see-through", "See through the product", true) +
         "</div><div class=\"controls\"><span>Look from:</span>" + look("palm", "Palm") +
         look("back", "Back") + look("thumb", "Thumb side") + look("little", "Little finger") +
         "<span>Drag to turn, wheel or pinch to zoom, right drag to move; arrow keys, + and "
         "&#8722; "
         "after a click.</span></div><script type=\"application/json\" id=\"" +
         id + "\">" + script_escaped(scene_data_json(hand, one, scale)) + "</script></section>\n";
}

std::string charts(const ContactResult& contact) {
  const bool has_range = contact.band && has_low(*contact.band) && has_high(*contact.band) &&
                         contact.band->regions.size() == contact.regions.size();
  const std::string lines = has_range ? " (lines: soft to stiff tissue)" : "";
  BarChart force{"Force, N" + lines, {}};
  BarChart pressure{"Peak pressure, MPa" + lines, {}};
  for (std::size_t i = 0; i < contact.regions.size(); ++i) {
    const RegionContact& one = contact.regions[i];
    const std::string name = plain_words(one.region);
    force.bars.push_back({name, one.force, region_colour(one.region)});
    pressure.bars.push_back({name, one.peak_pressure, region_colour(one.region)});
    if (!has_range) continue;
    const ContactBandRow& band = contact.band->regions[i];
    force.bars.back().range = BarRange{band.force_low, band.force_high};
    pressure.bars.back().range = BarRange{band.peak_pressure_low, band.peak_pressure_high};
  }
  return "<div class=\"charts\">" + svg_chart(force) + svg_chart(pressure) + "</div>\n";
}

std::string gallery(const std::vector<EncodedPicture>& pictures) {
  if (pictures.empty()) return {};
  std::string html = "<h3>Pictures</h3><div class=\"pictures\">";
  for (const EncodedPicture& picture : pictures) {
    html += "<figure><img src=\"data:image/png;base64," + base64(picture.png) + "\" alt=\"" +
            html_escaped(picture.alt) + "\"><figcaption>" + html_escaped(picture.title) +
            "</figcaption></figure>";
  }
  return html + "</div>\n";
}

std::string notes_of(const AssessedProduct& one) {
  const ContactResult& contact = one.assessment.contact;
  const GraspStatus status = one.assessment.grasp.status;
  const std::string message = capitalised(one.assessment.grasp.message);
  std::string html = "<p class=\"note " + status_class(one.assessment) + "\"><strong>" +
                     html_escaped(plain_words(status)) + ".</strong> " + html_escaped(message) +
                     "</p>\n";
  if (!contact.message.empty()) {
    html += "<p class=\"note fair\"><strong>Contact.</strong> " + html_escaped(contact.message) +
            "</p>\n";
  }
  if (one.product.notes.empty()) return html;
  html += "<p class=\"note\"><strong>About the mesh.</strong> ";
  for (std::size_t i = 0; i < one.product.notes.size(); ++i) {
    html += (i > 0 ? "<br>" : "") + html_escaped(one.product.notes[i]);
  }
  return html + "</p>\n";
}

std::string product_section(const Hand& hand, const AssessedProduct& one,
                            const std::vector<EncodedPicture>& pictures, const ColourScale& scale,
                            std::size_t index) {
  const Assessment& assessment = one.assessment;
  const ContactResult& contact = assessment.contact;
  std::string html = "<h2 id=\"product-" + std::to_string(index) + "\">" +
                     html_escaped(one.product.name) + "</h2>\n" + notes_of(one) +
                     pressure_verdict(assessment);
  const bool is_judged = is_in_hand(assessment);
  if (is_judged) html += balance_section(assessment);
  html += scene_view(hand, one, scale, "scene-" + std::to_string(index));
  if (is_judged) {
    html += charts(contact) + region_contact_table(contact) + face_contact_table(one) +
            error_band_section(assessment);
  } else if (!contact.regions.empty()) {
    html += "<details><summary>What the hand touches all the same</summary>" +
            region_contact_table(contact) + "</details>\n";
  }
  html += friction_section(hand, one);
  html += index_section(one.assessment.indices);
  html += gallery(pictures);
  html += "<details><summary>What stopped each segment</summary>" + stop_table(assessment.grasp) +
          "</details>\n<details><summary>Posture and placement</summary>" +
          posture_table(hand, assessment.grasp) + placement_table(assessment.grasp) +
          "</details>\n<details><summary>Settings and product</summary>" +
          settings_table(assessment) + "<p>Product from " + html_escaped(one.product.source) +
          "; unit " + name_of(one.product.unit) + " (" + name_of(one.product.unit_source) + "); " +
          std::to_string(one.product.mesh.triangle_count()) + " triangles.</p>";
  return html + "</details>\n";
}

/// What the equations that ran leave out.
std::string method_limits(const AssessmentSet& set) {
  const bool is_known = !set.assessments.empty();
  const ContactModel model =
      is_known ? set.assessments.front().assessment.contact.model : ContactModel{};
  const bool has_sleeve =
      is_known && !set.assessments.front().assessment.options.contact.coatings.empty();
  std::string html = "<h2 id=\"limits\">What this does not model</h2>\n<ul>\n<li>";
  html += model.tissue == TissueModel::kHalfSpace
              ? "The skin is endlessly deep tissue whose stiffness grows with depth, region by "
                "region; the bone under it is not modelled, so peaks over bone are too low where "
                "the skin is thin."
              : "The skin is one elastic layer over bone, as deep as the bones of this hand stand "
                "under it; fat, nail and tendons are not told apart.";
  const bool has_friction = is_known && set.assessments.front().assessment.options.friction.is_on();
  const bool has_balance = is_known && set.assessments.front().assessment.options.balance.is_on;
  html +=
      has_balance
          ? "</li>\n<li>Product and fingers come to rest once; people also change their hold, "
            "spread the fingers and press harder when they feel it slip.</li>\n"
          : "</li>\n<li>The hand is as it was closed to given depths: forces don't balance.</li>\n";
  html += has_friction
              ? "<li>The margin against slip is that of friction alone at these pressures, "
                "whose own sum is not in it.</li>\n"
              : "<li>No weight of the product and no tool forces were given.</li>\n";
  html +=
      "<li>The sum of the forces is not the reading of a dynamometer, nor the grip force across a "
      "plane: the three differ by a factor of 2 to 3.</li>\n<li>";
  html += has_sleeve ? "Under its sleeve the product is rigid, and the sleeve is elastic at any "
                       "squeeze, without bottoming out;"
                     : "The product is rigid;";
  html +=
      " edges sharper than the skin's mesh (about 2.5 mm) are seen blunter than they are.</li>\n"
      "<li>One hand. Other people's hands are larger, smaller, stiffer or softer. Its bones are "
      "synthetic.</li>\n";
  if (model.coupling == RegionCoupling::kIndependent) {
    html +=
        "<li>Regions are solved one by one; neighbours don't push each other's skin down, which "
        "makes forces too high where they meet.</li>\n";
  }
  html +=
      "<li>Limits of pressure come in families ten times apart. Film peak values at pain onset "
      "(ISO/TS 15066:2016: finger 3.0, palm 2.6, ball of the thumb 2.0 MPa) stand against the peak "
      "pressure; the 0.05 MPa at which blood flow stops stand against the peak averaged on 24 mm² "
      "sensor cells and concern grips held long. Neither is a verdict on comfort.</li>\n</ul>\n"
      "<p>Equations that ran: " +
      html_escaped(name_of(model)) +
      ". Methods: Y. Xie, Plausible 3D Human Hand Modeling for Virtual Ergonomic Assessments of "
      "Handheld Product, Hokkaido University, 2014";
  if (model != xie2014_model()) {
    html += ", with the changes that Palmar's documentation lists with their effects";
  }
  return html + ".</p>\n";
}

std::string provenance(const AssessmentSet& set) {
  const HandDimensions& d = set.hand->dimensions;
  std::string html =
      "<h2 id=\"provenance\">Provenance</h2>\n<p>Hand: " + html_escaped(set.hand->name) + ", " +
      std::string(name_of(set.hand->side)) + "; length " + short_number(d.hand_length, 4) +
      " mm, circumference " + short_number(d.hand_circumference, 4) + " mm, width " +
      short_number(d.hand_width, 3) + " mm. " + html_escaped(set.hand->provenance) +
      "</p>\n<p>Palmar " + html_escaped(build_description()) + ".</p>\n";
  if (!set.command_line.empty()) {
    html += "<p>Made by: <code>" + html_escaped(set.command_line) + "</code></p>\n";
  }
  return html + "<details><summary>Licence of the 3-D view (three.js, MIT)</summary><pre>" +
         html_escaped(viewer_licence()) + "</pre></details>\n";
}

}  // namespace

std::string html_report(const AssessmentSet& set,
                        const std::vector<std::vector<EncodedPicture>>& pictures,
                        const ColourScale& scale, const std::string& json, bool is_cut_short) {
  if (!set.hand) throw UsageError("report: the set has no hand");
  if (pictures.size() != set.assessments.size()) {
    throw UsageError("report: pictures of " + std::to_string(pictures.size()) + " products for " +
                     std::to_string(set.assessments.size()) + " assessments");
  }
  const std::size_t count = set.assessments.size();
  const std::string title = "Palmar report: " + (count == 1 ? set.assessments.front().product.name
                                                            : std::to_string(count) + " products");
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src "
      "'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:\">\n"
      "<meta name=\"generator\" content=\"Palmar " +
      html_escaped(version()) + "\">\n<title>" + html_escaped(title) + "</title>\n<style>" +
      std::string(kReportStyle) + "</style>\n</head>\n<body>\n<header><h1>" + html_escaped(title) +
      "</h1><p>How a " + std::string(name_of(set.hand->side)) + " hand of " +
      short_number(set.hand->dimensions.hand_length) +
      " mm length holds it in a power grip: where it presses and how hard.</p></header>\n<main>\n";
  html += "<h2 class=\"first\" id=\"summary\">Summary</h2>\n";
  html +=
      "<p class=\"note\"><strong>How to read it.</strong> The fingers close to a set depth, as in "
      "a "
      "firm grip; nobody measured a force. Compare designs with each other; don't take the figures "
      "as absolute.</p>\n";
  if (is_cut_short) {
    html +=
        "<p class=\"note fair\"><strong>Cut short.</strong> This run was cancelled: pictures, and "
        "perhaps whole products, are missing. The numbers shown are complete.</p>\n";
  }
  html += summary_table(set) + plain_summary(set) + comparison(set, pictures);
  html +=
      "<p>Peak pressure is the largest at one vertex of the skin; the peak on sensor cells is "
      "averaged over the area of a pressure mat's cell and is the figure to compare with "
      "measurements. Small figures under a result are its range from soft to stiff tissue. All "
      "pictures share one colour scale, 0 to " +
      short_number(scale.upper) + " " + html_escaped(scale.unit) +
      (scale.is_open_ended ? "; single vertices above that have the colour of its end" : "") +
      " (1 MPa = 1 N/mm² = 1000 kPa). Numbers are shortened for reading; assessment.json holds "
      "them in full.</p>\n";
  for (std::size_t i = 0; i < count; ++i) {
    html += product_section(*set.hand, set.assessments[i], pictures[i], scale, i);
  }
  html += method_limits(set);
  html += provenance(set);
  html += "</main>\n<footer><p>Made by Palmar " + html_escaped(version()) +
          ". This file works without a network.</p></footer>\n"
          "<script type=\"application/json\" id=\"palmar-assessment\">" +
          script_escaped(json) + "</script>\n<script>" + script_escaped(viewer_bundle()) +
          "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace palmar
