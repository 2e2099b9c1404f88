// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/photo/surface/photo_model.h"
#include "hands/person_workflow/steps/photo_cameras.h"

namespace palmar::person_workflow {

/// What became of a set of photographs: the file beside the mesh, and what people are shown of it.
struct PhotoMeshReport {
  std::string json;  ///< all of it, as the file has it: every photograph, lens and motion
  std::size_t photographs = 0, used = 0;
  double board_residual = 0.0;  ///< of the board's corners, mean over the photographs used, pixels
  bool motion_is_corrected = false;
  int motion_points = 0;       ///< of the skin that were followed; 0: motion wasn't looked for
  double largest_shift = 0.0;  ///< of the hand between positions, mm
  double largest_turn = 0.0;   ///< rad
  double residual_before = 0.0, residual_after = 0.0;  ///< median of those points, pixels
  std::size_t points = 0;  ///< of the surface that photographs agreed about
  std::size_t triangles = 0;
  double measured_share = 0.0;  ///< of the area
  std::vector<std::string> warnings;
};

/// `key`: digest of all that the mesh depends on; `mesh_digest`: SHA-256 of the mesh's file;
/// `seconds`: that making it took.
PhotoMeshReport photo_mesh_report(const PosedPhotographs& work, const capture::PhotoModel& model,
                                  double seconds, const std::string& key,
                                  const std::string& mesh_digest);

/// Reads such a file; nothing if it isn't one, or is of another key or another mesh.
std::optional<PhotoMeshReport> read_photo_mesh_report(const std::string& json,
                                                      const std::string& key,
                                                      const std::string& mesh_digest);

}  // namespace palmar::person_workflow
