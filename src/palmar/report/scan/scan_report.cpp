// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scan/scan_report.h"

#include <fmt/format.h>

#include <filesystem>

#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/records/capture/scan_record_json.h"
#include "palmar/report/page/html_page.h"
#include "palmar/report/scan/scan_tables.h"

namespace palmar {
namespace {

std::string summary(const ScanRecord& record) {
  const HandDimensions& d = record.made.hand.dimensions;
  return fmt::format(
      "<p>{} hand, length {:.1f} mm, circumference {:.1f} mm, width {:.1f} mm, thickness {:.1f} "
      "mm; from {}.</p>",
      record.made.hand.side == Side::kLeft ? "Left" : "Right", d.hand_length, d.hand_circumference,
      d.hand_width, d.hand_thickness,
      record.scans.size() == 1 ? "1 scan" : fmt::format("{} scans", record.scans.size()));
}

std::string page_of(const ScanRecord& record, const std::vector<Picture>& pictures) {
  const std::string title = "Hand from MRI: " + record.made.hand.name;
  const std::string errors = pictures_html(pictures, {"error_"});
  return html_page(
      title, summary(record),
      pictures_html(pictures, {"hand_"}) +
          notes_section("What to know about this hand", record.notes) + scans_section(record) +
          bone_error_section(record) + skin_section(record) +
          (errors.empty()
               ? ""
               : "<h3>Where the posed hand misses the scan</h3>\n<p>Grey: nothing to compare with "
                 "(markers, skin that touches skin, the cut through the forearm).</p>\n" +
                     errors) +
          joint_range_section(record) + dimensions_section(record.made.hand) +
          titled("Every scan", pictures_html(pictures, {"scan_"})));
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
