// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/press.h"

#include <filesystem>
#include <memory>
#include <optional>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/records/csv.h"
#include "palmar/records/tissue_file.h"
#include "palmar/report/chart/press_chart.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::workflow {
namespace {

bool is_on_hand(const PressRequest& request) {
  return request.test.specimen.kind == contact::PressSpecimen::Kind::kHandRegion;
}

/// The result in the format that the file's name asks for.
std::string press_file(const std::string& path, const PressOutcome& outcome) {
  const auto& [test, setting, steps] = outcome;
  const std::string format = std::filesystem::path(path).extension().string();
  if (format == ".csv") return records::format_csv(records::press_table(steps));
  if (format == ".svg") {
    const std::string hand = setting.hand.empty() ? "" : setting.hand + ":";
    return report::press_chart(steps, hand + name_of(test.specimen) + " pressed by " +
                                          name_of(test.indenter) + " (" + name_of(setting.model) +
                                          ")") +
           "\n";
  }
  return records::press_json(test, setting, steps) + "\n";
}

}  // namespace

void PressRequest::check() const {
  contact::PressOptions asked = test;
  asked.kernel = model.kernel;
  asked.check();
  const std::string format = std::filesystem::path(out).extension().string();
  if (out.empty() || format == ".json" || format == ".csv" || format == ".svg") return;
  throw UsageError("setting \"out\": \"" + out + "\" ends with none of .json, .csv, .svg");
}

PressOutcome run_press(const PressRequest& request) {
  request.check();
  PressOutcome outcome{.test = request.test, .setting = {"", request.model}, .steps = {}};
  contact::PressOptions& test = outcome.test;
  test.kernel = request.model.kernel;
  std::optional<contact::PreparedHand> hand;
  if (is_on_hand(request)) {
    auto loaded = load_hand(request.hand);
    outcome.setting.hand = loaded->name;
    if (test.tissue_level != hand::TissueLevel::kNominal) {
      loaded =
          std::make_shared<hand::Hand>(contact::hand_at_tissue_level(*loaded, test.tissue_level));
    }
    hand.emplace(prepared_hand(request.hand, loaded, request.model, request.note));
  } else if (!request.hand.tissue.empty()) {
    test.tissue = records::read_tissue(request.hand.tissue, hand::default_tissue())
                      .region[static_cast<std::size_t>(hand::Region::kMiddleDistal)];
  }
  outcome.steps = contact::press(test, hand ? &*hand : nullptr);
  if (!request.out.empty()) formats::write_file(request.out, press_file(request.out, outcome));
  return outcome;
}

}  // namespace palmar::workflow
