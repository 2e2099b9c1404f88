// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_report/scan_report.h"

#include <algorithm>
#include <filesystem>

#include "hands/person_records/scan_record_json.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/report/chart/bar_chart.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/plain_words.h"

namespace palmar::person_report {
std::string plain_words(hand::ScanPosture posture) {
  std::string words(name_of(posture));
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

namespace {

constexpr report::Rgb kIcpColour{150, 158, 166}, kAxisColour{213, 94, 0}, kCmcColour{0, 114, 178};

/// Errors of one bone, or group of bones, in every posture.
report::BarChart error_chart(const std::string& title, std::string_view bones,
                             const std::vector<capture::ErrorRow>& rows,
                             const report::Phrases& phrases) {
  report::BarChart chart{phrases(title), {}, phrases("No scanned posture shows these bones.")};
  for (const capture::ErrorRow& row : rows) {
    if (row.bones != bones) continue;
    const std::string words = plain_words(row.posture);
    chart.bars.push_back({phrases(words + ": freely"), row.icp, kIcpColour});
    chart.bars.push_back({phrases(words + ": fixed axes"), row.single_axis, kAxisColour});
    if (row.interpolated_cmc) {
      chart.bars.push_back({phrases(words + ": interpolated"), *row.interpolated_cmc, kCmcColour});
    }
  }
  return chart;
}

report::PageJson charts_json(const capture::ScanRecord& record, const report::Phrases& phrases,
                             report::Attachments& attachments) {
  const std::vector<capture::ErrorRow> rows = capture::error_rows(record.joints.errors);
  report::PageJson list = report::PageJson::array();
  if (rows.empty()) return list;
  for (const auto& [title, bones] :
       {std::pair{"Thumb metacarpal: mean distance, mm", "thumb_metacarpal"},
        std::pair{"Last phalanges II to V: mean distance, mm", "distal phalanges II-V"}}) {
    list.push_back(report::attached(
        attachments, "chart-" + std::to_string(list.size()),
        report::to_svg(report::bar_figure(error_chart(title, bones, rows, phrases)))));
  }
  return list;
}

/// All that can be scanned.
report::PageJson postures_json() {
  report::PageJson postures = report::PageJson::array();
  for (int k = 0; k < hand::kScanPostureCount; ++k) {
    postures.push_back(name_of(static_cast<hand::ScanPosture>(k)));
  }
  return postures;
}

std::string page_of(const capture::ScanRecord& record, const std::vector<report::Picture>& pictures,
                    const std::string& json, Language language) {
  report::Attachments attachments;
  const report::PageJson view = {
      {"maker", report::maker_json()},
      {"language", name_of(language)},
      {"vocabulary", report::vocabulary_json(record.made.hand)},
      {"postures", postures_json()},
      {"charts", charts_json(record, report::Phrases(language), attachments)},
      {"pictures", report::pictures_json(pictures, attachments)}};
  return report::render_page("hand_from_mri", json, view, std::move(attachments));
}

constexpr const char* kFoundFile = "found.json";  // of scans that no hand came of

/// What an earlier run left and this one doesn't make.
void remove_files(const std::filesystem::path& folder, const std::vector<const char*>& names) {
  std::error_code ignored;  // mostly there is none
  for (const char* name : names) std::filesystem::remove(folder / name, ignored);
}

}  // namespace

void write_scan_report(const std::string& folder, const capture::ScanRecord& record,
                       Language language, const Progress& progress) {
  const std::filesystem::path base(folder);
  formats::create_folder(base);
  const std::string json = person_records::scan_record_json(record);
  formats::write_file(base / "scan.json", json + "\n");
  formats::write_file(base / "bone_errors.csv",
                      records::format_csv(person_records::bone_error_table(record)));
  formats::write_file(base / "skin_errors.csv",
                      records::format_csv(person_records::skin_error_table(record)));
  if (record.contact) {
    formats::write_file(base / "grasp_contact.csv",
                        records::format_csv(person_records::grasp_contact_table(*record.contact)));
  } else {
    remove_files(base, {"grasp_contact.csv"});
  }
  remove_files(base, {kFoundFile});
  const std::vector<report::Picture> pictures =
      scan_pictures(record, {.width = 700, .height = 560}, part_of(progress, 0.0, 0.95));
  progress.throw_if_cancelled();
  formats::write_file(base / "report.html", page_of(record, pictures, json, language));
}

void write_refused_scan_report(const std::string& folder, const capture::ScanRecord& record,
                               const capture::ScanRefusal& refusal, std::size_t bones,
                               Language language, const Progress& progress) {
  const std::filesystem::path base(folder);
  formats::create_folder(base);
  remove_files(base, {"scan.json", "bone_errors.csv", "skin_errors.csv", "grasp_contact.csv"});
  const std::string json = person_records::refused_scans_json(record, refusal);
  formats::write_file(base / kFoundFile, json + "\n");
  report::Attachments attachments;
  const std::vector<report::Picture> pictures =
      found_pictures(record, {.width = 700, .height = 560}, part_of(progress, 0.0, 0.95));
  progress.throw_if_cancelled();
  const report::PageJson view = {{"maker", report::maker_json()},
                                 {"language", name_of(language)},
                                 {"postures", postures_json()},
                                 {"bones", bones},
                                 {"pictures", report::pictures_json(pictures, attachments)}};
  formats::write_file(base / "report.html",
                      report::render_page("refused_scans", json, view, std::move(attachments)));
}

}  // namespace palmar::person_report
