// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/tissue_on_bone.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/hand/mirror.h"
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

std::filesystem::path template_path() {
  return std::filesystem::path(share_folder()) / "template.compliance";
}

/// What to do about the template's file.
std::string template_advice() {
  return fmt::format(
      "{} is missing, cut or of another hand; `palmar hand template --out template.hand.glb "
      "--compliance {}` makes it anew",
      template_path().string(), template_path().string());
}

}  // namespace

std::shared_ptr<const SkinCompliance> tissue_on_bone(const Hand& hand, const ContactModel& model,
                                                     const NoteSink& note) {
  if (model.tissue != TissueModel::kBone) return nullptr;
  if (hand.side == Side::kLeft) {
    return std::make_shared<const SkinCompliance>(
        mirrored(*tissue_on_bone(mirrored(hand), model, note)));
  }
  const auto folder = cache_folder();
  const std::string key = compliance_key(hand);
  if (auto known = read_compliance(template_path(), key, hand)) {
    return std::make_shared<const SkinCompliance>(std::move(*known));
  }
  std::filesystem::path path;
  if (folder) {
    path = *folder / ("skin-" + key.substr(0, 24) + ".compliance");
    if (auto known = read_compliance(path, key, hand)) {
      return std::make_shared<const SkinCompliance>(std::move(*known));
    }
  }
  note_to(note,
          fmt::format("finding how the skin of hand \"{}\" gives way on its bones, some 13 s{}",
                      hand.name, hand.name == "template" ? ": " + template_advice() : ""));
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

std::shared_ptr<const SkinCompliance> tissue_on_bone(const Hand& base, const StudyPlan& plan,
                                                     const NoteSink& note) {
  for (const StudySetting& setting : plan.settings) {
    if (auto compliance = tissue_on_bone(base, setting.model, note)) return compliance;
  }
  return nullptr;
}

std::string template_compliance_file() {
  const auto hand = load_hand("template");
  if (!read_compliance(template_path(), compliance_key(*hand), *hand)) {
    throw InputError(template_advice());
  }
  return template_path().string();
}

PreparedHand prepared_hand(const HandChoice& choice, const std::shared_ptr<const Hand>& hand,
                           const ContactModel& model, const NoteSink& note) {
  if (model.tissue != TissueModel::kBone) return PreparedHand(hand, model);
  if (!choice.person) return PreparedHand(hand, model, tissue_on_bone(*hand, model, note));
  HandChoice unscaled = choice;
  unscaled.person.reset();
  const auto base = load_hand(unscaled);
  return PreparedHand(hand, model, tissue_on_bone(*base, model, note), base);
}

}  // namespace palmar
