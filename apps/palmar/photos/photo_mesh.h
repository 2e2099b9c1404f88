// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "cli.h"
#include "palmar/capture/photo/photo_model.h"
#include "palmar/records/capture/photo_set.h"

namespace palmar::cli {

/// Options of making a mesh from photographs.
struct PhotoMeshArguments {
  std::string lenses, box = "220,220,260";
  bool no_motion = false;
  PhotoModelOptions model;

  void add_to(CLI::App& verb);
  /// Reads the box; throws UsageError naming the option.
  void check();
};

/// A set of photographs, and whether its mesh is there already.
struct PhotoMeshPlan {
  std::string folder;
  std::filesystem::path mesh;  ///< .ply
  PhotoSet set;
  std::string key;  ///< digest of all that the mesh depends on
  std::optional<nlohmann::ordered_json>
      kept;              ///< report of an earlier run that made this very mesh
  double seconds = 0.0;  ///< that making it takes, about
};

PhotoMeshPlan plan_photo_mesh(const std::string& folder, const std::filesystem::path& mesh,
                              const std::optional<PhotoLenses>& lenses,
                              const PhotoMeshArguments& arguments);

/// Photographs to a coloured mesh in the board's frame, mm, with the report beside it, which is
/// given back; nothing is done if both are there. Throws InputError naming folder or photograph,
/// Cancelled.
nlohmann::ordered_json make_photo_mesh(const PhotoMeshPlan& plan,
                                       const std::optional<PhotoLenses>& lenses,
                                       const PhotoMeshArguments& arguments,
                                       const Progress& progress);

/// "hand.ply" -> "hand.json".
std::filesystem::path report_beside(const std::filesystem::path& mesh);
/// A report for people: photographs, motion, surface; a line each.
std::string photo_mesh_text(const nlohmann::ordered_json& report);

}  // namespace palmar::cli
