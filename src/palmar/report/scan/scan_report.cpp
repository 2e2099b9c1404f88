// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/report/scan/scan_report.h"

#include <algorithm>
#include <filesystem>

#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/records/capture/scan_record_json.h"
#include "palmar/report/chart/bar_chart.h"
#include "palmar/report/page/page_json.h"
#include "palmar/report/page/plain_words.h"
#include "palmar/report/words/phrases.h"

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
  BarChart chart{phrases(title), {}};
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

std::string page_of(const ScanRecord& record, const std::vector<Picture>& pictures,
                    const std::string& json, Language language) {
  Attachments attachments;
  PageJson postures = PageJson::array();
  for (int k = 0; k < kScanPostureCount; ++k) {
    postures.push_back(name_of(static_cast<ScanPosture>(k)));
  }
  const PageJson view = {{"maker", maker_json()},
                         {"language", name_of(language)},
                         {"vocabulary", vocabulary_json(record.made.hand)},
                         {"postures", std::move(postures)},
                         {"charts", charts_json(record, Phrases(language), attachments)},
                         {"pictures", pictures_json(pictures, attachments)}};
  return render_page("hand_from_mri", json, view, std::move(attachments));
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
  write_file(base / "report.html", page_of(record, pictures, json, language));
}

}  // namespace palmar
