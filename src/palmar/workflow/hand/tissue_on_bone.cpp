// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/tissue_on_bone.h"

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/hand/template_hand.h"
#include "palmar/records/hand/compliance_file.h"

namespace palmar {
namespace {

std::optional<std::filesystem::path> cache_folder() {
  // NOLINTBEGIN(concurrency-mt-unsafe): nothing here changes the environment.
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache != nullptr && *cache != '\0') {
    return std::filesystem::path(cache) / "palmar";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0') {
    return std::filesystem::path(home) / ".cache" / "palmar";
  }
  // NOLINTEND(concurrency-mt-unsafe)
  return std::nullopt;
}

}  // namespace

std::shared_ptr<const SkinCompliance> tissue_on_bone(const Hand& hand, const ContactModel& model) {
  if (model.tissue != TissueModel::kBone) return nullptr;
  if (hand.side == Side::kLeft) {
    return std::make_shared<const SkinCompliance>(mirrored(*tissue_on_bone(mirrored(hand), model)));
  }
  const auto folder = cache_folder();
  const std::string key = compliance_key(hand);
  std::filesystem::path path = std::filesystem::path(share_folder()) / "template.compliance";
  if (auto known = read_compliance(path, key, hand)) {
    return std::make_shared<const SkinCompliance>(std::move(*known));
  }
  if (folder) {
    path = *folder / ("skin-" + key.substr(0, 24) + ".compliance");
    if (auto known = read_compliance(path, key, hand)) {
      return std::make_shared<const SkinCompliance>(std::move(*known));
    }
  }
  auto made =
      std::make_shared<const SkinCompliance>(skin_compliance(hand, skin_geometry(hand.skin)));
  if (folder) {
    try {
      create_folder(*folder);
      write_compliance(path, key, *made);
    } catch (const Error&) {
      // The next run makes it again.
    }
  }
  return made;
}

std::shared_ptr<const SkinCompliance> tissue_on_bone(const Hand& base, const StudyPlan& plan) {
  for (const StudySetting& setting : plan.settings) {
    if (auto compliance = tissue_on_bone(base, setting.model)) return compliance;
  }
  return nullptr;
}

PreparedHand prepared_hand(const HandChoice& choice, const std::shared_ptr<const Hand>& hand,
                           const ContactModel& model) {
  if (model.tissue != TissueModel::kBone) return PreparedHand(hand, model);
  if (!choice.person) return PreparedHand(hand, model, tissue_on_bone(*hand, model));
  HandChoice unscaled = choice;
  unscaled.person.reset();
  const auto base = load_hand(unscaled);
  return PreparedHand(hand, model, tissue_on_bone(*base, model), base);
}

}  // namespace palmar
