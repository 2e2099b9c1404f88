// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "hands/capture/photo/surface/photo_model.h"
#include "hands/person_records/photo_set.h"
#include "hands/person_workflow/steps/photo_cameras.h"
#include "hands/person_workflow/steps/photo_mesh_report.h"
#include "palmar/core/progress.h"
#include "palmar/core/setting_names.h"

namespace palmar::person_workflow {

/// A set of photographs, and whether its mesh is there already.
struct PhotoMeshPlan {
  std::string folder;
  std::filesystem::path mesh;  ///< .ply
  person_records::PhotoSet set;
  std::string key;                      ///< digest of all that the mesh depends on
  std::optional<PhotoMeshReport> kept;  ///< of an earlier run that made this very mesh
  double seconds = 0.0;                 ///< that making it takes, about
};

PhotoMeshPlan plan_photo_mesh(const std::string& folder, const std::filesystem::path& mesh,
                              const std::optional<person_records::PhotoLenses>& lenses,
                              const PhotoMeshOptions& options);

/// Photographs to a coloured mesh in the board's frame, mm, with the report beside it; nothing is
/// done if both are there. Throws InputError naming folder or photograph, Cancelled.
PhotoMeshReport make_planned_mesh(const PhotoMeshPlan& plan,
                                  const std::optional<person_records::PhotoLenses>& lenses,
                                  const PhotoMeshOptions& options, const Progress& progress);

/// "hand.ply" -> "hand.json".
std::filesystem::path report_beside(const std::filesystem::path& mesh);

}  // namespace palmar::person_workflow
