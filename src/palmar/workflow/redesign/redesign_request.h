// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/language.h"
#include "palmar/geometry/length_unit.h"
#include "palmar/geometry/types.h"
#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/grasp/grip.h"

namespace palmar::workflow {

/// How redesigns are held.
enum class RedesignPosture {
  kNew,  ///< grasped anew in the hold of the original, at the same grip force
  kKept  ///< in the posture in which the same hand holds the original (Xie 2014, 5.5.3)
};
std::string name_of(RedesignPosture posture);               ///< "kept", "new"
RedesignPosture redesign_posture(const std::string& name);  ///< throws UsageError

/// What every redesign starts from: a product, the hands that hold it, where to write.
struct RedesignRequest {
  std::string product;                       ///< file, or "made: prism width_mm=35 fillet_mm=3"
  std::optional<geometry::LengthUnit> unit;  ///< of a file that carries none
  std::string hand = "template";             ///< that is scaled: template, or a *.hand.glb file
  bool is_left = false;                      ///< left hands: those are mirrored
  /// Whose hands: names of built-in populations, population files (.toml), tables of given hands
  /// (.csv).
  std::vector<std::string> populations = {"xie2014"};
  int hands = 30;                                 ///< drawn from each population, 1 to 100 000
  std::vector<std::optional<grasp::Grip>> grips;  ///< nothing inside: the one that suits the shape
  std::optional<Vec3> at;                         ///< where it is held, product frame, mm
  std::optional<Vec3> axis;                       ///< of the handle there, product frame
  grasp::HoldRequest holding;  ///< by which part and how, in place of `at` and `axis`
  RedesignPosture posture = RedesignPosture::kNew;
  /// N, 0 to 500 (about the strongest grip measured), with which all are held; 0: the usual one. A
  /// kept posture decides the force itself and the original is held as it was closed, so it goes
  /// with kNew only.
  double grip_force = 0.0;
  /// Of a quantity that is compared beside the usual ones: what a search made better. May be empty.
  std::string goal_key;
  std::uint64_t seed = 0;                  ///< 0: a study's own
  std::filesystem::path out;               ///< folder: new or empty, or of an earlier redesign
  Language language = Language::kEnglish;  ///< of the report and the verdict
  std::string command;  ///< that files give as where they come from; may be empty
  /// Called with every note as it arises (a proposed unit, say); they are in the outcome, too.
  std::function<void(const std::string& note)> on_note;

  bool keeps_posture() const { return posture == RedesignPosture::kKept; }
  /// Throws UsageError: setting, value, what is allowed.
  void check() const;
};

/// Throws UsageError 'setting "FIELD" is VALUE; ALLOWED is allowed' unless it holds.
void require_setting(bool holds, const char* field, double value, const char* allowed);

}  // namespace palmar::workflow
