// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_report/scan_report.h"

#include <algorithm>
#include <filesystem>

#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "hands/person_records/scan_record_json.h"
#include "palmar/report/chart/bar_chart.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/words/phrases.h"
#include "palmar/report/words/plain_words.h"

namespace palmar {
std::string plain_words(ScanPosture posture) {
  std::string words(name_of(posture));
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

namespace {

constexpr Rgb kIcpColour{150, 158, 166}, kAxisColour{213, 94, 0}, kCmcColour{0, 114, 178};

/// Errors of one bone, or group of bones, in every posture.
BarChart error_chart(const std::string& title, std::string_view bones,
                     const std::vector<ErrorRow>& rows, const Phrases& phrases) {
  BarChart chart{phrases(title), {}, phrases("No scanned posture shows these bones.")};
  for (const ErrorRow& row : rows) {
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

PageJson charts_json(const ScanRecord& record, const Phrases& phrases, Attachments& attachments) {
  const std::vector<ErrorRow> rows = error_rows(record.joints.errors);
  PageJson list = PageJson::array();
  if (rows.empty()) return list;
  for (const auto& [title, bones] :
       {std::pair{"Thumb metacarpal: mean distance, mm", "thumb_metacarpal"},
        std::pair{"Last phalanges II to V: mean distance, mm", "distal phalanges II-V"}}) {
    list.push_back(attached(attachments, "chart-" + std::to_string(list.size()),
                            to_svg(bar_figure(error_chart(title, bones, rows, phrases)))));
  }
  return list;
}

/// All that can be scanned.
PageJson postures_json() {
  PageJson postures = PageJson::array();
  for (int k = 0; k < kScanPostureCount; ++k) {
    postures.push_back(name_of(static_cast<ScanPosture>(k)));
  }
  return postures;
}

std::string page_of(const ScanRecord& record, const std::vector<Picture>& pictures,
                    const std::string& json, Language language) {
  Attachments attachments;
  const PageJson view = {{"maker", maker_json()},
                         {"language", name_of(language)},
                         {"vocabulary", vocabulary_json(record.made.hand)},
                         {"postures", postures_json()},
                         {"charts", charts_json(record, Phrases(language), attachments)},
                         {"pictures", pictures_json(pictures, attachments)}};
  return render_page("hand_from_mri", json, view, std::move(attachments));
}

constexpr const char* kFoundFile = "found.json";  // of scans that no hand came of

/// What an earlier run left and this one doesn't make.
void remove_files(const std::filesystem::path& folder, const std::vector<const char*>& names) {
  std::error_code ignored;  // mostly there is none
  for (const char* name : names) std::filesystem::remove(folder / name, ignored);
}

}  // namespace

void write_scan_report(const std::string& folder, const ScanRecord& record, Language language,
                       const Progress& progress) {
  const std::filesystem::path base(folder);
  create_folder(base);
  const std::string json = scan_record_json(record);
  write_file(base / "scan.json", json + "\n");
  write_file(base / "bone_errors.csv", format_csv(bone_error_table(record)));
  write_file(base / "skin_errors.csv", format_csv(skin_error_table(record)));
  if (record.contact) {
    write_file(base / "grasp_contact.csv", format_csv(grasp_contact_table(*record.contact)));
  } else {
    remove_files(base, {"grasp_contact.csv"});
  }
  remove_files(base, {kFoundFile});
  const std::vector<Picture> pictures =
      scan_pictures(record, {.width = 700, .height = 560}, part_of(progress, 0.0, 0.95));
  progress.throw_if_cancelled();
  write_file(base / "report.html", page_of(record, pictures, json, language));
}

void write_refused_scan_report(const std::string& folder, const ScanRecord& record,
                               const ScanRefusal& refusal, std::size_t bones, Language language,
                               const Progress& progress) {
  const std::filesystem::path base(folder);
  create_folder(base);
  remove_files(base, {"scan.json", "bone_errors.csv", "skin_errors.csv", "grasp_contact.csv"});
  const std::string json = refused_scans_json(record, refusal);
  write_file(base / kFoundFile, json + "\n");
  Attachments attachments;
  const std::vector<Picture> pictures =
      found_pictures(record, {.width = 700, .height = 560}, part_of(progress, 0.0, 0.95));
  progress.throw_if_cancelled();
  const PageJson view = {{"maker", maker_json()},
                         {"language", name_of(language)},
                         {"postures", postures_json()},
                         {"bones", bones},
                         {"pictures", pictures_json(pictures, attachments)}};
  write_file(base / "report.html",
             render_page("refused_scans", json, view, std::move(attachments)));
}

}  // namespace palmar
