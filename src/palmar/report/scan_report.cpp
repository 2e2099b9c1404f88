// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scan_report.h"

#include <fmt/format.h>

#include <filesystem>

#include "palmar/core/progress_part.h"
#include "palmar/core/version.h"
#include "palmar/io/csv.h"
#include "palmar/io/file.h"
#include "palmar/io/scan_record_json.h"
#include "palmar/io/vtk.h"
#include "palmar/report/html_style.h"
#include "palmar/report/html_text.h"
#include "palmar/report/plain_words.h"
#include "palmar/report/svg_chart.h"

namespace palmar {
namespace {

constexpr Rgb kIcpColour{150, 158, 166}, kAxisColour{213, 94, 0}, kCmcColour{0, 114, 178};

std::string words_of(ScanPosture posture) {
  std::string words(name_of(posture));
  for (char& c : words) c = c == '_' ? ' ' : c;
  return words;
}

std::string number_cell(const std::optional<double>& value, int decimals = 2) {
  if (!value) return "<td class=\"n\">–</td>";
  return fmt::format("<td class=\"n\" data-value=\"{}\">{:.{}f}</td>", exact_number(*value), *value,
                     decimals);
}

std::string row_head(const std::string& text) {
  return "<th scope=\"row\">" + html_escaped(text) + "</th>";
}

std::string table(const std::string& caption, const std::vector<std::string>& heads,
                  const std::string& rows) {
  std::string html = "<div class=\"wide\"><table><caption>" + caption + "</caption><thead><tr>";
  for (std::size_t k = 0; k < heads.size(); ++k) {
    html += std::string("<th scope=\"col\"") + (k == 0 ? "" : " class=\"n\"") + ">" +
            html_escaped(heads[k]) + "</th>";
  }
  return html + "</tr></thead><tbody>" + rows + "</tbody></table></div>\n";
}

std::string scans_section(const ScanRecord& record) {
  std::string rows;
  for (const RecordedScan& scan : record.scans) {
    int named = 0;
    for (const ScannedBone& bone : scan.surfaces.bones) named += bone.name.empty() ? 0 : 1;
    rows += "<tr>" + row_head(words_of(scan.posture)) + "<td>" + html_escaped(scan.title) +
            fmt::format("</td><td class=\"n\">{} of {}</td><td class=\"n\">{}</td>", named,
                        scan.surfaces.bones.size(), scan.surfaces.markers.size()) +
            number_cell(scan.surfaces.air_threshold, 0) +
            number_cell(scan.surfaces.bone_threshold, 0) +
            number_cell(scan.surfaces.bone_error_estimate) + "</tr>";
  }
  return "<h2>What was scanned</h2>\n" +
         table("Scans, and what was found in them",
               {"Posture", "Series", "Bones named", "Markers", "Threshold of air",
                "Threshold of bone", "Expected error of a bone's surface, mm"},
               rows);
}

/// Bars of one posture: what free registration leaves, then what the joints leave.
BarChart chart_of(ScanPosture posture, const std::vector<ErrorRow>& rows) {
  BarChart chart{"Mean distance, mm: " + words_of(posture), {}};
  for (const ErrorRow& row : rows) {
    if (row.posture != posture) continue;
    std::string bone = row.bones;
    for (char& c : bone) c = c == '_' ? ' ' : c;
    chart.bars.push_back({bone + ", ICP", row.icp, kIcpColour, {}});
    chart.bars.push_back({bone + ", fixed axes", row.single_axis, kAxisColour, {}});
    if (row.interpolated_cmc) {
      chart.bars.push_back({bone + ", CMC interpolated", *row.interpolated_cmc, kCmcColour, {}});
    }
  }
  return chart;
}

std::string joints_section(const ScanRecord& record) {
  const std::vector<ErrorRow> rows = error_rows(record.joints.errors);
  if (rows.empty()) {
    return "<h2>Joints</h2>\n<p>No posture but the reference was scanned: joints are those of the "
           "model, fitted to the bones.</p>\n";
  }
  std::string body, charts;
  std::optional<ScanPosture> last;
  for (const ErrorRow& row : rows) {
    body += "<tr>" + row_head(words_of(row.posture)) + "<td>" + html_escaped(row.bones) + "</td>" +
            number_cell(row.icp) + number_cell(row.single_axis) +
            number_cell(row.interpolated_cmc) + "</tr>";
    if (last != row.posture) charts += svg_chart(chart_of(row.posture, rows));
    last = row.posture;
  }
  return "<h2>How well the joints reproduce the scans</h2>\n"
         "<p>Mean distance between a bone's surface, moved from the reference posture by the "
         "joints, "
         "and the surface that the scan shows. Free registration (ICP) is the lower limit. Xie "
         "2014 "
         "(tables 2-2 to 2-4, figures 2-13 and 2-14; two persons): fingers 0.44 to 1.06 mm, thumb "
         "0.80 to 1.22 mm with fixed axes and 0.35 to 0.96 mm with the interpolated CMC joint, "
         "grasp "
         "within 1.5 mm.</p>\n" +
         table("Mean distance, mm", {"Posture", "Bones", "ICP", "Fixed axes", "CMC interpolated"},
               body) +
         "<div class=\"charts\">" + charts + "</div>\n";
}

std::string skin_section(const ScanRecord& record) {
  std::string rows;
  for (const SkinError& error : record.made.skin_errors) {
    rows += "<tr>" + row_head(words_of(error.posture)) + number_cell(error.skinning_only) +
            number_cell(error.by_markers) + number_cell(error.corrected) + "</tr>";
  }
  std::string html = fmt::format(
      "<h2>Skin</h2>\n<p>The hand's skin lies {:.2f} mm from the reference scan's in the mean, 95 "
      "% "
      "of it within {:.2f} mm.",
      record.made.registration_mean, record.made.registration_p95);
  if (rows.empty()) return html + "</p>\n";
  return html +
         " Around the thumb ball, Xie 2014 (table 2-5) found 3.7 mm with skinning alone and 0.6 mm "
         "after the correction.</p>\n" +
         table("Mean distance of the posed skin round the thumb ball from the scanned one, mm",
               {"Posture", "Skinning alone", "Corrected by the markers alone",
                "Corrected by markers and scanned skin"},
               rows);
}

std::string dimensions_section(const Hand& hand) {
  const HandDimensions& d = hand.dimensions;
  std::string rows;
  for (int s = 0; s < kSegmentCount; ++s) {
    const SegmentDimensions& size = d.segment[static_cast<std::size_t>(s)];
    rows += "<tr>" + row_head(plain_words(static_cast<Segment>(s))) + number_cell(size.length, 1) +
            number_cell(size.width, 1) + number_cell(size.thickness, 1) + "</tr>";
  }
  return fmt::format(
             "<h2>Dimensions</h2>\n<p>Hand length {:.1f} mm, circumference {:.1f} mm, width "
             "{:.1f} mm, thickness {:.1f} mm; {} hand.</p>\n",
             d.hand_length, d.hand_circumference, d.hand_width, d.hand_thickness,
             name_of(hand.side)) +
         table("Segments, mm", {"Segment", "Length", "Width", "Thickness"}, rows);
}

std::string pictures_section(const std::vector<Picture>& pictures) {
  if (pictures.empty()) return {};
  std::string html = "<h2>Pictures</h2>\n<div class=\"pictures\">";
  for (const Picture& one : pictures) {
    html += "<figure><img src=\"data:image/png;base64," + base64(encode_png(one.image)) +
            "\" alt=\"" + html_escaped(one.alt) + "\"><figcaption>" + html_escaped(one.title) +
            "</figcaption></figure>";
  }
  return html + "</div>\n";
}

std::string notes_section(const std::vector<std::string>& notes) {
  if (notes.empty()) return {};
  std::string html = "<h2>What to know about this hand</h2>\n<ul class=\"plain\">";
  for (const std::string& note : notes) html += "<li>" + html_escaped(note) + "</li>";
  return html + "</ul>\n";
}

std::string page_of(const ScanRecord& record, const std::vector<Picture>& pictures) {
  const std::string title = "Hand from MRI: " + record.made.hand.name;
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'; img-src data:\">\n<title>" +
         html_escaped(title) + "</title>\n<style>" + std::string(kReportStyle) +
         "</style>\n</head>\n<body>\n<header><h1>" + html_escaped(title) +
         fmt::format("</h1><p>{} scans, {} hand.</p></header>\n<main>\n", record.scans.size(),
                     name_of(record.made.hand.side)) +
         notes_section(record.notes) + scans_section(record) + joints_section(record) +
         skin_section(record) + dimensions_section(record.made.hand) + pictures_section(pictures) +
         "</main>\n<footer><p>Made by Palmar " + html_escaped(version()) +
         ". This file works without a network.</p></footer>\n</body>\n</html>\n";
}

}  // namespace

void write_scan_report(const std::string& folder, const ScanRecord& record,
                       const Progress& progress) {
  const std::filesystem::path base(folder);
  create_folder(base);
  write_file(base / "scan.json", scan_record_json(record) + "\n");
  write_file(base / "bone_errors.csv", format_csv(bone_error_table(record)));
  write_file(base / "skin_errors.csv", format_csv(skin_error_table(record)));
  progress.update(0.0, "pictures");
  const std::vector<Picture> pictures =
      scan_pictures(record, {.width = 700, .height = 560}, part_of(progress, 0.0, 0.95));
  progress.throw_if_cancelled();
  write_file(base / "report.html", page_of(record, pictures));
}

}  // namespace palmar
