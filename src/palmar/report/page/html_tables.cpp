// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/page/html_tables.h"

#include <algorithm>
#include <initializer_list>
#include <numbers>

#include "palmar/report/page/error_band.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/page/pressure_limits.h"
#include "palmar/report/picture/colormap.h"

namespace palmar {

namespace {

constexpr const char* kNothing = "–";
constexpr double kDegrees = 180.0 / std::numbers::pi;

std::string cell(const std::string& text) { return "<td>" + html_escaped(text) + "</td>"; }

std::string head_cell(const std::string& text) {
  return "<th scope=\"row\">" + html_escaped(text) + "</th>";
}

std::string number_cell(double value, int significant = 3) {
  return "<td class=\"n\" data-value=\"" + exact_number(value) + "\">" +
         short_number(value, significant) + "</td>";
}

struct Column {
  const char* words;
  bool is_number = false;
};

std::string table(const std::string& caption, std::initializer_list<Column> columns,
                  const std::string& rows) {
  std::string html =
      "<div class=\"wide\"><table><caption>" + html_escaped(caption) + "</caption><thead><tr>";
  for (const Column& column : columns) {
    html += std::string("<th scope=\"col\"") + (column.is_number ? " class=\"n\">" : ">") +
            html_escaped(column.words) + "</th>";
  }
  return html + "</tr></thead><tbody>" + rows + "</tbody></table></div>\n";
}

std::string pain_words(const std::optional<NearestToPain>& nearest) {
  if (!nearest) return kNothing;
  const std::string share = short_number(100.0 * nearest->share, 2) + " % of pain onset";
  if (nearest->share >= 1.0) return "Above pain onset: " + share;
  return (nearest->share >= 0.5 ? "Near: " : "Below: ") + share;
}

// Placement vectors: three cells in one.
std::string vector_cell(const Vec3& v, int significant) {
  std::string text;
  std::string exact;
  for (int k = 0; k < 3; ++k) {
    text += (k > 0 ? ", " : "") + short_number(v[k], significant);
    exact += (k > 0 ? " " : "") + exact_number(v[k]);
  }
  return "<td class=\"n\" data-value=\"" + exact + "\">" + text + "</td>";
}

/// A result with its range for soft and stiff tissue below it.
std::string range_cell(double value, const std::optional<ContactBand>& band, double low,
                       double high) {
  if (!band) return number_cell(value);
  return "<td class=\"n\" data-value=\"" + exact_number(value) + "\">" + short_number(value) +
         "<div class=\"range\">" + range_words(low, high, has_low(*band), has_high(*band)) +
         "</div></td>";
}

std::string coating_words(const Coating& coating) {
  std::string words = short_number(coating.thickness) + " mm thick, shear modulus " +
                      short_number(1000.0 * coating.shear_modulus) + " kPa, Poisson's ratio " +
                      short_number(coating.poisson, 2);
  if (coating.where.isEmpty()) return words + ", on the whole product";
  const auto corner = [](const Vec3& p) {
    return "(" + short_number(p.x()) + ", " + short_number(p.y()) + ", " + short_number(p.z()) +
           ")";
  };
  return words + ", between " + corner(coating.where.min()) + " and " +
         corner(coating.where.max()) + " mm";
}

std::string coating_settings(const std::vector<Coating>& coatings) {
  std::string rows;
  for (const Coating& coating : coatings) {
    rows += "<tr>" + head_cell("Sleeve on the product") + cell(coating_words(coating)) + "</tr>";
  }
  return rows;
}

std::string setting(const std::string& name, const std::string& value) {
  return "<tr>" + head_cell(name) + cell(value) + "</tr>";
}

std::string result_cells(const ContactResult& contact) {
  const auto hottest = std::max_element(contact.regions.begin(), contact.regions.end(),
                                        [](const RegionContact& a, const RegionContact& b) {
                                          return a.peak_pressure_cells < b.peak_pressure_cells;
                                        });
  const RegionContact& all = contact.total;
  const ContactBandRow band = contact.band ? contact.band->total : ContactBandRow{};
  return range_cell(all.force, contact.band, band.force_low, band.force_high) +
         range_cell(all.area, contact.band, band.area_low, band.area_high) +
         range_cell(all.peak_pressure, contact.band, band.peak_pressure_low,
                    band.peak_pressure_high) +
         range_cell(all.peak_pressure_cells, contact.band, band.peak_pressure_cells_low,
                    band.peak_pressure_cells_high) +
         cell(plain_words(hottest->region)) + cell(pain_words(nearest_to_pain(contact))) +
         cell(std::to_string(regions_without_blood_flow(contact)) + " of " +
              std::to_string(contact.regions.size()) + " regions above 0.05 MPa");
}

// A posture that holds nothing has forces, too, but they say nothing about holding.
std::string cells_without_result() {
  std::string cells;
  for (int i = 0; i < 4; ++i) cells += "<td class=\"n\">" + std::string(kNothing) + "</td>";
  return cells + cell(kNothing) + "<td colspan=\"2\">not in the hand: nothing to judge</td>";
}

}  // namespace

std::string status_class(const Assessment& assessment) {
  switch (assessment.grasp.status) {
    case GraspStatus::kHeld:
      return is_in_hand(assessment) ? "good" : "fair";  // held, and yet no contact: doubtful
    case GraspStatus::kPartlyHeld:
      return "fair";
    default:
      return "bad";
  }
}

std::string summary_table(const AssessmentSet& set) {
  std::string rows;
  for (std::size_t i = 0; i < set.assessments.size(); ++i) {
    const AssessedProduct& one = set.assessments[i];
    const Grasp& grasp = one.assessment.grasp;
    const ContactResult& contact = one.assessment.contact;
    rows += "<tr><th scope=\"row\"><a href=\"#product-" + std::to_string(i) + "\">" +
            html_escaped(one.product.name) + "</a></th><td><span class=\"badge " +
            status_class(one.assessment) + "\">" + html_escaped(plain_words(grasp.status)) +
            "</span></td>" +
            (is_in_hand(one.assessment) ? result_cells(contact) : cells_without_result()) + "</tr>";
  }
  return table("Results at a glance",
               {{"Product"},
                {"Does it fit?"},
                {"Force, N", true},
                {"Contact area, mm²", true},
                {"Peak pressure, MPa", true},
                {"Peak on sensor cells, MPa", true},
                {"Hottest region (sensor cells)"},
                {"Firm grip for a moment: pain (film peak)"},
                {"Grip held long: blood flow (sensor cells)"}},
               rows);
}

std::string region_contact_table(const ContactResult& contact) {
  std::string rows;
  const auto numbers = [](const RegionContact& one) {
    return number_cell(one.force) + number_cell(one.area) + number_cell(one.peak_pressure) +
           number_cell(one.peak_pressure_cells) + number_cell(one.mean_pressure) +
           number_cell(one.max_penetration);
  };
  for (const RegionContact& one : contact.regions) {
    rows += "<tr data-region=\"" + std::string(name_of(one.region)) +
            "\"><th scope=\"row\"><span class=\"swatch\" style=\"background:" +
            hex_colour(region_colour(one.region)) + "\"></span>" +
            html_escaped(plain_words(one.region)) + "</th>" + numbers(one) +
            number_cell(pain_onset_film(one.region)) + "</tr>";
  }
  rows += "<tr class=\"total\" data-region=\"total\">" + head_cell("Whole hand") +
          numbers(contact.total) + "<td></td></tr>";
  return table("Contact by region of the hand",
               {{"Region"},
                {"Force, N", true},
                {"Area, mm²", true},
                {"Peak, MPa", true},
                {"Peak on cells, MPa", true},
                {"Mean, MPa", true},
                {"Depth before the skin gives way, mm", true},
                {"Pain onset (film peak), MPa", true}},
               rows);
}

std::string stop_table(const Grasp& grasp) {
  std::string rows;
  for (const SegmentStop& stop : grasp.stops) {
    rows += "<tr data-segment=\"" + std::string(name_of(stop.segment)) + "\">" +
            head_cell(plain_words(stop.segment)) + cell(plain_words(stop.reason)) +
            number_cell(stop.penetration) + "</tr>";
  }
  return table("What stopped each segment",
               {{"Segment"}, {"Stopped because"}, {"Depth in the product, mm (minus: gap)", true}},
               rows);
}

std::string posture_table(const Hand& hand, const Grasp& grasp) {
  std::string rows;
  for (int d = 0; d < kDofCount; ++d) {
    const auto dof = static_cast<Dof>(d);
    rows += "<tr data-dof=\"" + std::string(name_of(dof)) + "\">" + head_cell(plain_words(dof)) +
            number_cell(grasp.posture[dof] * kDegrees);
    std::string range = "–";
    for (const Joint& joint : hand.skeleton.joints) {
      for (const JointDof& one : joint.dofs) {
        if (one.dof != dof) continue;
        range =
            short_number(one.lower * kDegrees, 2) + " to " + short_number(one.upper * kDegrees, 2);
      }
    }
    rows += "<td class=\"n\">" + range + "</td></tr>";
  }
  return table("Posture of the joints",
               {{"Joint"}, {"Angle, °", true}, {"Range of motion, °", true}}, rows);
}

std::string placement_table(const Grasp& grasp) {
  const Quat& q = grasp.product_from_hand.rotation;
  const Eigen::AngleAxisd turn(q);
  const auto row = [](const std::string& name, const std::string& value) {
    return "<tr>" + head_cell(name) + value + "</tr>";
  };
  return table(
      "Placement (product frame)", {{"Quantity"}, {"Value", true}},
      row("Grip point, mm", vector_cell(grasp.grip_point, 4)) +
          row("Grip axis, towards the thumb", vector_cell(grasp.grip_axis, 3)) +
          row("Girth of the product at the grip, mm", number_cell(grasp.grip_girth, 4)) +
          row("Hand origin (wrist), mm", vector_cell(grasp.product_from_hand.translation, 4)) +
          row("Turn of the hand, °", number_cell(turn.angle() * kDegrees)) +
          row("About the axis", vector_cell(turn.axis(), 3)));
}

std::string settings_table(const Assessment& assessment) {
  const AssessOptions& options = assessment.options;
  const ContactModel& model = assessment.contact.model;
  const PlacementRequest& placement = options.grasp.power.placement;
  const bool is_given = placement.at || placement.axis || placement.turn;
  return table(
      "Settings", {{"Setting"}, {"Value"}},
      setting("Limit depth of the palm",
              short_number(options.grasp.power.palm_limit_depth) + " mm") +
          setting("Limit depth of the fingers",
                  short_number(options.grasp.power.finger_limit_depth) + " mm") +
          setting("Placement", is_given ? "as asked" : "found from the product's shape") +
          setting("Grip", std::string(name_of(assessment.grasp.grip))) +
          setting("Grip force", options.balance.grip_force
                                    ? short_number(*options.balance.grip_force) + " N asked for"
                                    : "as firm as closing to the limit depths") +
          setting("Comes to rest", options.balance.is_on ? "yes" : "no") +
          setting("Equations of the contact", name_of(model)) +
          setting("Kernel", model.kernel == Kernel::kPatch
                                ? "patch (uniform pressure on each vertex's area)"
                                : "point (Xie 2014, r held at 0.5 mm)") +
          setting("Under the skin", model.tissue == TissueModel::kHalfSpace
                                        ? "half-space"
                                        : "layer bonded to the bone") +
          setting("Regions", model.coupling == RegionCoupling::kCoupled ? "solved together"
                                                                        : "solved one by one") +
          setting("Swelling of the skin", options.contact.swelling ? "on" : "off") +
          setting("Sensor cell", short_number(options.contact.cell_area) + " mm²") +
          setting("Shear modulus", options.contact.shear_modulus
                                       ? short_number(*options.contact.shear_modulus) + " MPa"
                                       : "grows with depth, per region") +
          coating_settings(options.contact.coatings) +
          setting("Ranges for soft and stiff tissue",
                  options.contact.error_band ? "on" : "left out") +
          setting("Seed", std::to_string(options.seed)));
}

std::string plain_verdict(const Assessment& assessment) {
  if (assessment.contact.regions.empty()) {
    return "Nothing is touched, so there is no pressure to judge.";
  }
  if (!is_in_hand(assessment)) {
    return "It is not held, so there are no pressures of a grip to judge.";
  }
  const ContactResult& contact = assessment.contact;
  const double share = nearest_to_pain(contact)->share;
  const int without = regions_without_blood_flow(contact);
  const std::string moment = share >= 1.0 ? "A firm grip for a moment would hurt, first at the " +
                                                plain_words(nearest_to_pain(contact)->region)
                             : share >= 0.5
                                 ? "A firm grip for a moment comes near to pain at the " +
                                       plain_words(nearest_to_pain(contact)->region)
                                 : std::string("A firm grip for a moment stays far below pain");
  if (without == 0) return moment + "; held for minutes, blood would still flow in the skin.";
  return moment + "; held just as firmly for minutes, the skin would go short of blood in " +
         std::to_string(without) + " of the " + std::to_string(contact.regions.size()) +
         " regions it touches, and the hand would have to loosen or shift.";
}

std::string plain_summary(const AssessmentSet& set) {
  std::string html = "<ul class=\"plain\">";
  for (const AssessedProduct& one : set.assessments) {
    html += "<li><strong>" + html_escaped(one.product.name) + ".</strong> " +
            html_escaped(plain_verdict(one.assessment)) + "</li>";
  }
  return html + "</ul>\n";
}

std::string pressure_verdict(const Assessment& assessment) {
  const ContactResult& contact = assessment.contact;
  const std::string plain = "<p>" + html_escaped(plain_verdict(assessment)) + "</p>";
  if (!is_in_hand(assessment)) return plain;
  const auto nearest = nearest_to_pain(contact);
  const std::string pain =
      "<p><strong>Short, firm grip.</strong> Nearest to pain: " +
      html_escaped(plain_words(nearest->region)) + ". Its peak of " +
      short_number(nearest->peak_pressure) + " MPa is " + short_number(100.0 * nearest->share, 2) +
      " % of the " + short_number(nearest->limit, 2) +
      " MPa at which pain begins there (peak pressure on a film; ISO/TS 15066:2016).</p>";
  const int without = regions_without_blood_flow(contact);
  const std::string flow =
      "<p><strong>Grip held long.</strong> " +
      (without == 0 ? std::string("No region exceeds")
                    : std::to_string(without) + " of " + std::to_string(contact.regions.size()) +
                          " regions exceed") +
      " 0.05 MPa (50 kPa) averaged on a sensor cell, above which the skin's blood flow stops"
      " (Chalmers thesis 2004). A limit of its own family, for sustained grips: it is lower than "
      "the "
      "film values above because it asks another question.</p>";
  return plain + pain + flow;
}

}  // namespace palmar
