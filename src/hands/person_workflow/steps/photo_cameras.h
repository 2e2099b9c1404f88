// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "hands/capture/photo/surface/hand_motion.h"
#include "hands/capture/photo/surface/photo_model.h"
#include "hands/person_records/photo_set.h"
#include "hands/person_records/photo_worker.h"
#include "palmar/core/progress.h"
#include "palmar/core/setting_names.h"

namespace palmar::person_workflow {

/// How a mesh is made of photographs.
struct PhotoMeshOptions {
  std::string lenses;  ///< file of calibrate_photo_lenses(), or folder of photographs of the tilted
                       ///< board; empty: from the photographs of the hand, which show less
  capture::PhotoModelOptions model;
  bool looks_for_motion = true;  ///< people move between photographs; false: the hand surely didn't
  SettingNames setting_names;    ///< for warnings, which the report keeps
  void check() const;            ///< throws UsageError: setting, value, what is allowed
};

/// What became of a set of photographs before any surface was made.
struct PosedPhotographs {
  person_records::PhotoSet set;
  std::vector<person_records::BoardSighting> seen;      ///< per file of the set
  std::vector<std::optional<capture::BoardPose>> pose;  ///< per file
  person_records::PhotoLenses lenses;
  std::vector<std::size_t> used;                 ///< files with a pose
  std::vector<capture::Photograph> photographs;  ///< of those; motion of the hand corrected
  capture::HandMotion motion;
  std::vector<std::string> warnings;
  bool lenses_were_given = false;
};

/// Board, lenses, cameras and motion of the hand. `lenses`: of another set, or none: from these
/// photographs. Throws InputError naming folder or photograph: no board, blurred, sizes that don't
/// belong together. `model`: options.model for this very board.
PosedPhotographs pose_photographs(const std::string& folder, const person_records::PhotoSet& set,
                                  const std::optional<person_records::PhotoLenses>& lenses,
                                  const capture::PhotoModelOptions& model,
                                  const PhotoMeshOptions& options, const Progress& progress);

}  // namespace palmar::person_workflow
