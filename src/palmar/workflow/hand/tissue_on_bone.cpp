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

namespace palmar::workflow {
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

std::shared_ptr<const contact::SkinCompliance> tissue_on_bone(const hand::Hand& hand,
                                                              const contact::ContactModel& model,
                                                              const NoteSink& note) {
  if (model.tissue != contact::TissueModel::kBone) return nullptr;
  if (hand.side == hand::Side::kLeft) {
    return std::make_shared<const contact::SkinCompliance>(
        mirrored(*tissue_on_bone(mirrored(hand), model, note)));
  }
  const auto folder = cache_folder();
  const std::string key = records::compliance_key(hand);
  if (auto known = records::read_compliance(template_path(), key, hand)) {
    return std::make_shared<const contact::SkinCompliance>(std::move(*known));
  }
  std::filesystem::path path;
  if (folder) {
    path = *folder / ("skin-" + key.substr(0, 24) + ".compliance");
    if (auto known = records::read_compliance(path, key, hand)) {
      return std::make_shared<const contact::SkinCompliance>(std::move(*known));
    }
  }
  note_to(note,
          fmt::format("finding how the skin of hand \"{}\" gives way on its bones, some 13 s{}",
                      hand.name, hand.name == "template" ? ": " + template_advice() : ""));
  auto made = std::make_shared<const contact::SkinCompliance>(
      contact::skin_compliance(hand, contact::skin_geometry(hand.skin)));
  if (folder) {
    try {
      formats::create_folder(*folder);
      records::write_compliance(path, key, *made);
    } catch (const Error&) {
      // The next run makes it again.
    }
  }
  return made;
}

std::shared_ptr<const contact::SkinCompliance> tissue_on_bone(const hand::Hand& base,
                                                              const study::StudyPlan& plan,
                                                              const NoteSink& note) {
  for (const study::StudySetting& setting : plan.settings) {
    if (auto compliance = tissue_on_bone(base, setting.model, note)) return compliance;
  }
  return nullptr;
}

std::string template_compliance_file() {
  const auto hand = load_hand("template");
  if (!records::read_compliance(template_path(), records::compliance_key(*hand), *hand)) {
    throw InputError(template_advice());
  }
  return template_path().string();
}

contact::PreparedHand prepared_hand(const HandChoice& choice,
                                    const std::shared_ptr<const hand::Hand>& hand,
                                    const contact::ContactModel& model, const NoteSink& note) {
  if (model.tissue != contact::TissueModel::kBone) return contact::PreparedHand(hand, model);
  if (!choice.person) return contact::PreparedHand(hand, model, tissue_on_bone(*hand, model, note));
  HandChoice unscaled = choice;
  unscaled.person.reset();
  const auto base = load_hand(unscaled);
  return contact::PreparedHand(hand, model, tissue_on_bone(*base, model, note), base);
}

}  // namespace palmar::workflow
