// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scan_report.h"

#include <fmt/format.h>

#include <filesystem>
#include <string_view>

#include "palmar/core/progress_part.h"
#include "palmar/core/version.h"
#include "palmar/io/file.h"
#include "palmar/io/scan_record_json.h"
#include "palmar/io/vtk.h"
#include "palmar/report/html_style.h"
#include "palmar/report/html_text.h"
#include "palmar/report/scan_tables.h"

namespace palmar {
namespace {

/// Figures of pictures whose name begins with one of `kinds`.
std::string pictures_html(const std::vector<Picture>& pictures,
                          std::initializer_list<std::string_view> kinds) {
  std::string html;
  for (const Picture& one : pictures) {
    for (const std::string_view kind : kinds) {
      if (!one.name.starts_with(kind)) continue;
      html += "<figure><img src=\"data:image/png;base64," + base64(encode_png(one.image)) +
              "\" alt=\"" + html_escaped(one.alt) + "\"><figcaption>" + html_escaped(one.title) +
              "</figcaption></figure>";
    }
  }
  return html.empty() ? html : "<div class=\"pictures\">" + html + "</div>\n";
}

std::string titled(const std::string& title, const std::string& html) {
  return html.empty() ? html : "<h2>" + title + "</h2>\n" + html;
}

std::string summary(const ScanRecord& record) {
  const HandDimensions& d = record.made.hand.dimensions;
  return fmt::format(
      "<p>{} hand, length {:.1f} mm, circumference {:.1f} mm, width {:.1f} mm, thickness {:.1f} "
      "mm; from {}.</p>",
      record.made.hand.side == Side::kLeft ? "Left" : "Right", d.hand_length, d.hand_circumference,
      d.hand_width, d.hand_thickness,
      record.scans.size() == 1 ? "1 scan" : fmt::format("{} scans", record.scans.size()));
}

std::string notes_section(const std::vector<std::string>& notes) {
  if (notes.empty()) return {};
  std::string html = "<h2>What to know about this hand</h2>\n<ul class=\"plain\">";
  for (const std::string& note : notes) html += "<li>" + html_escaped(note) + "</li>";
  return html + "</ul>\n";
}

std::string page_of(const ScanRecord& record, const std::vector<Picture>& pictures) {
  const std::string title = "Hand from MRI: " + record.made.hand.name;
  const std::string errors = pictures_html(pictures, {"error_"});
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src "
         "'unsafe-inline'; img-src data:\">\n<title>" +
         html_escaped(title) + "</title>\n<style>" + std::string(kReportStyle) +
         "</style>\n</head>\n<body>\n<header><h1>" + html_escaped(title) + "</h1>" +
         summary(record) + "</header>\n<main>\n" + pictures_html(pictures, {"hand_"}) +
         notes_section(record.notes) + scans_section(record) + bone_error_section(record) +
         skin_section(record) +
         (errors.empty()
              ? ""
              : "<h3>Where the posed hand misses the scan</h3>\n<p>Grey: nothing to compare with "
                "(markers, skin that touches skin, the cut through the forearm).</p>\n" +
                    errors) +
         joint_range_section(record) + dimensions_section(record.made.hand) +
         titled("Every scan", pictures_html(pictures, {"scan_"})) +
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
  const std::filesystem::path contact = base / "grasp_contact.csv";
  if (record.contact) {
    write_file(contact, format_csv(grasp_contact_table(*record.contact)));
  } else {
    std::error_code ignored;  // of an earlier run with a product
    std::filesystem::remove(contact, ignored);
  }
  const std::vector<Picture> pictures =
      scan_pictures(record, {.width = 700, .height = 560}, part_of(progress, 0.0, 0.95));
  progress.throw_if_cancelled();
  write_file(base / "report.html", page_of(record, pictures));
}

}  // namespace palmar
