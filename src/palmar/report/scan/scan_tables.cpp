// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scan/scan_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <numbers>
#include <optional>
#include <vector>

#include "palmar/report/chart/svg_chart.h"
#include "palmar/report/page/html_page.h"
#include "palmar/report/page/html_text.h"
#include "palmar/report/page/plain_words.h"

namespace palmar {
namespace {

constexpr Rgb kIcpColour{150, 158, 166}, kAxisColour{213, 94, 0}, kCmcColour{0, 114, 178};

std::string with_spaces(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

const ErrorRow* row_at(const std::vector<ErrorRow>& rows, ScanPosture posture,
                       std::string_view bones) {
  for (const ErrorRow& row : rows) {
    if (row.posture == posture && row.bones == bones) return &row;
  }
  return nullptr;
}

/// Postures that have a row, in their order.
std::vector<ScanPosture> postures_of(const std::vector<ErrorRow>& rows) {
  std::vector<ScanPosture> postures;
  for (const ErrorRow& row : rows) {
    if (std::find(postures.begin(), postures.end(), row.posture) == postures.end()) {
      postures.push_back(row.posture);
    }
  }
  return postures;
}

constexpr std::array<const char*, 3> kFingerRows = {
    "proximal phalanges II-V", "middle phalanges II-V", "distal phalanges II-V"};
constexpr std::array<const char*, 3> kThumbRows = {"thumb_metacarpal", "thumb_proximal_phalanx",
                                                   "thumb_distal_phalanx"};

std::string finger_table(const std::vector<ErrorRow>& rows) {
  std::string body;
  for (const ScanPosture posture : postures_of(rows)) {
    body += "<tr>" + row_head(words_of(posture));
    for (const char* bones : kFingerRows) {
      const ErrorRow* row = row_at(rows, posture, bones);
      body += number_cell(row ? std::optional(row->icp) : std::nullopt);
      body += number_cell(row ? std::optional(row->single_axis) : std::nullopt);
    }
    body += "</tr>";
  }
  return html_table("Fingers II to V: mean distance in mm, moved freely and by the joints",
                    {"Posture", "First phalanges, freely", "by joints", "Middle phalanges, freely",
                     "by joints", "Last phalanges, freely", "by joints"},
                    body);
}

std::string thumb_table(const std::vector<ErrorRow>& rows) {
  std::string body;
  for (const ScanPosture posture : postures_of(rows)) {
    body += "<tr>" + row_head(words_of(posture));
    for (const char* bones : kThumbRows) {
      const ErrorRow* row = row_at(rows, posture, bones);
      body += number_cell(row ? std::optional(row->icp) : std::nullopt);
      body += number_cell(row ? std::optional(row->single_axis) : std::nullopt);
      body += number_cell(row ? row->interpolated_cmc : std::nullopt);
    }
    body += "</tr>";
  }
  return html_table(
      "Thumb: mean distance in mm, moved freely, by fixed axes, by the interpolated saddle joint",
      {"Posture", "Metacarpal, freely", "fixed axes", "interpolated", "First phalanx, freely",
       "fixed axes", "interpolated", "Last phalanx, freely", "fixed axes", "interpolated"},
      body);
}

/// What the joints leave of one bone, posture by posture.
BarChart chart_of(const std::string& title, const char* bones, const std::vector<ErrorRow>& rows) {
  BarChart chart{title, {}};
  for (const ScanPosture posture : postures_of(rows)) {
    const ErrorRow* row = row_at(rows, posture, bones);
    if (row == nullptr) continue;
    const std::string words = words_of(posture);
    chart.bars.push_back({words + ": freely", row->icp, kIcpColour, {}});
    chart.bars.push_back({words + ": fixed axes", row->single_axis, kAxisColour, {}});
    if (row->interpolated_cmc) {
      chart.bars.push_back({words + ": interpolated", *row->interpolated_cmc, kCmcColour, {}});
    }
  }
  return chart;
}

std::string contact_html(const ScanRecord& record) {
  const bool has_grasp =
      std::any_of(record.scans.begin(), record.scans.end(),
                  [](const RecordedScan& scan) { return scan.posture == ScanPosture::kGrasp; });
  std::string html = "<h3>Contact with what the grasp holds</h3>\n";
  if (!record.contact) {
    return html + "<p>Not compared: " +
           (has_grasp ? "no product was given (<code>--product FILE</code>, its surface where it "
                        "was in the scanner)."
                      : "no grasp was scanned.") +
           "</p>\n";
  }
  const ContactOverlap& c = record.contact->overlap;
  return html +
         fmt::format(
             "<p>Skin within {:g} mm of {} counts as touching, of the scanned grasp and of the new "
             "hand in the same posture. Of the product's surface that the scanned hand touches, "
             "the new hand touches {:.0f} %; of what the new hand touches, the scanned one touches "
             "{:.0f} %.</p>\n",
             record.contact->range, html_escaped(record.contact->product), 100.0 * c.share_of_scan,
             100.0 * c.share_of_hand) +
         html_table("Contact area, mm²",
                    {"", "Skin of the scan", "Skin of the new hand", "Product touched by both",
                     "Shared part of all that is touched"},
                    "<tr>" + row_head("grasp") + number_cell(c.scanned_area, 0) +
                        number_cell(c.hand_area, 0) + number_cell(c.shared_area, 0) +
                        fmt::format("<td class=\"n\">{:.0f} %</td></tr>",
                                    100.0 * c.intersection_over_union));
}

}  // namespace

std::string words_of(ScanPosture posture) { return with_spaces(std::string(name_of(posture))); }

std::string scans_section(const ScanRecord& record) {
  std::string rows, missing;
  for (int k = 0; k < kScanPostureCount; ++k) {
    const auto posture = static_cast<ScanPosture>(k);
    const auto scan = std::find_if(record.scans.begin(), record.scans.end(),
                                   [&](const auto& one) { return one.posture == posture; });
    if (scan == record.scans.end()) {
      missing += (missing.empty() ? "" : ", ") + words_of(posture);
      continue;
    }
    const ScanSurfaces& surfaces = scan->surfaces;
    const auto named = std::count_if(surfaces.bones.begin(), surfaces.bones.end(),
                                     [](const ScannedBone& bone) { return !bone.name.empty(); });
    rows += "<tr>" + row_head(words_of(posture)) + "<td>" + html_escaped(scan->title) +
            fmt::format("</td><td class=\"n\">{} of {}</td><td class=\"n\">{}</td>", named,
                        record.made.hand.bones.size(), surfaces.markers.size()) +
            number_cell(surfaces.bone_error_estimate) + number_cell(surfaces.air_threshold, 0) +
            number_cell(surfaces.bone_threshold, 0) + number_cell(surfaces.noise, 1) + "</tr>";
  }
  return "<h2>What was scanned</h2>\n" +
         html_table("Scans, and what was found in them",
                    {"Posture", "Series", "Bones found", "Markers found",
                     "Expected error of a bone's surface, mm", "Air below (intensity)",
                     "Cortical bone below (intensity)", "Noise (intensity)"},
                    rows, 2) +
         (missing.empty() ? "" : "<p>Not scanned: " + missing + ".</p>\n");
}

std::string bone_error_section(const ScanRecord& record) {
  const std::vector<ErrorRow> rows = error_rows(record.joints.errors);
  const std::string head = "<h2>How well the joints reproduce the scans</h2>\n";
  if (rows.empty()) {
    return head +
           "<p>No posture but the reference was scanned: the joints are those of the model, fitted "
           "to the bones, and can't be tried.</p>\n";
  }
  return head +
         "<p>A bone of the reference scan is moved to another posture, and the mean distance of "
         "its surface from the one scanned there is measured: moved freely (the lower limit), by "
         "joints with fixed axes, and, for the thumb, by a saddle joint (CMC) interpolated between "
         "its scanned limits. Xie (2014) found in two persons, in the limit postures and a grasp: "
         "fingers 0.44 to 1.06 mm by joints; thumb 0.80 to 1.22 mm with fixed axes and 0.35 to "
         "0.96 mm interpolated; grasp within 1.5 mm (tables 2-2 to 2-4).</p>\n" +
         finger_table(rows) + thumb_table(rows) + "<div class=\"charts\">" +
         svg_chart(chart_of("Thumb metacarpal: mean distance, mm", "thumb_metacarpal", rows)) +
         svg_chart(
             chart_of("Last phalanges II to V: mean distance, mm", "distal phalanges II-V", rows)) +
         "</div>\n<p>The grasp was not used to make the joints.</p>\n";
}

std::string joint_range_section(const ScanRecord& record) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  std::string rows;
  for (const Joint& joint : record.made.hand.skeleton.joints) {
    for (const JointDof& dof : joint.dofs) {
      const bool is_measured = record.joints.is_measured[static_cast<std::size_t>(dof.dof)];
      rows += "<tr>" + row_head(plain_words(dof.dof)) + number_cell(dof.lower * kDegrees, 0) +
              number_cell(dof.upper * kDegrees, 0) + number_cell(dof.reference * kDegrees, 0) +
              "<td>" + (is_measured ? "measured" : "the model's") + "</td></tr>";
    }
  }
  return "<h2>Joints</h2>\n<p>0 is the straight finger as the model hand has it. An axis is "
         "measured if a scan bends the joint far enough; a range ends where a scanned limit "
         "posture does, else where the model's does.</p>\n<details><summary>Ranges of motion of "
         "all joints</summary>" +
         html_table("Range, degrees", {"Motion", "From", "To", "In the reference scan", "Axis"},
                    rows) +
         "</details>\n";
}

std::string skin_section(const ScanRecord& record) {
  std::string rows;
  for (const SkinError& error : record.made.skin_errors) {
    rows += "<tr>" + row_head(words_of(error.posture)) + number_cell(error.skinning_only) +
            number_cell(error.by_markers) + number_cell(error.corrected) + "</tr>";
  }
  std::string html = fmt::format(
      "<h2>Skin</h2>\n<p>In the reference posture the hand's skin lies {:.2f} mm from the scanned "
      "one in the mean, 95 % of it within {:.2f} mm.",
      record.made.registration_mean, record.made.registration_p95);
  if (!rows.empty()) {
    html +=
        " When the thumb moves, its ball swells. Skin that follows the joints alone misses that; "
        "Xie (2014, table 2-5) found 3.7 mm there, and 0.6 mm once corrected by markers.</p>\n" +
        html_table("Thumb ball: mean distance of the posed skin from the scanned one, mm",
                   {"Posture", "Skin follows the joints alone", "Corrected by the markers alone",
                    "Corrected by markers and scanned skin"},
                   rows);
  } else {
    html +=
        "</p>\n<p>No limit posture of the thumb was scanned: the swelling of its ball isn't "
        "known.</p>\n";
  }
  return html + contact_html(record);
}

std::string dimensions_section(const Hand& hand) {
  const HandDimensions& d = hand.dimensions;
  std::string rows;
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentDimensions& size = d.segment[static_cast<std::size_t>(s)];
    rows += "<tr>" + row_head(plain_words(static_cast<Segment>(s))) + number_cell(size.length, 1) +
            number_cell(size.width, 1) + number_cell(size.thickness, 1) + "</tr>";
  }
  return "<h2>Dimensions</h2>\n" + html_table("Segments between the creases, mm",
                                              {"Segment", "Length", "Width", "Thickness"}, rows);
}

std::string dimensions_section(const Hand& hand, const HandTape& tape) {
  const HandDimensions& d = hand.dimensions;
  const auto row = [](const std::string& head, std::initializer_list<std::optional<double>> cells) {
    std::string html = "<tr>" + row_head(head);
    for (const auto& cell : cells) html += number_cell(cell, 1);
    return html + "</tr>";
  };
  const SegmentTape& palm = tape.segment[static_cast<std::size_t>(Segment::kPalm)];
  std::string rows = row(
      "hand", {d.hand_length, tape.palmar_hand_length(), tape.dorsal_hand_length(), d.hand_width,
               palm.palmar_width, palm.dorsal_width, d.hand_thickness, d.hand_circumference});
  for (int k = 0; k < kSegmentCount; ++k) {
    const SegmentDimensions& s = d.segment[static_cast<std::size_t>(k)];
    const SegmentTape& t = tape.segment[static_cast<std::size_t>(k)];
    rows += row(plain_words(static_cast<Segment>(k)),
                {s.length, t.palmar_length, t.dorsal_length, s.width, t.palmar_width,
                 t.dorsal_width, s.thickness, t.girth});
  }
  return "<h2>Dimensions</h2>\n<p>Straight, as calipers measure, and along the skin, as a tape "
         "does that is held taut: lengths from crease to crease or to the fingertip, widths from "
         "the middle of one side to that of the other, girths all round. Widths, thicknesses and "
         "girths are taken half way along each segment, those of hand and palm over the knuckles; "
         "the hand reaches from the wrist's crease to the tip of the middle finger, the palm to "
         "that finger's base crease.</p>\n" +
         html_table(
             "Hand and segments between the creases, mm",
             {"", "Length, straight", "along the palm's side", "along the back", "Width, straight",
              "along the palm's side", "along the back", "Thickness", "Girth"},
             rows);
}

}  // namespace palmar
