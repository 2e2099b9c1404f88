// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli.h"
#include "hands/person_workflow/steps/photo_mesh.h"

namespace palmar::cli {

/// Options of making a mesh from photographs, the same for every verb that does so.
class PhotoMeshArguments {
 public:
  PhotoMeshArguments();
  void add_to(CLI::App& verb);
  person_workflow::PhotoMeshOptions options() const;  ///< throws UsageError naming the option

 private:
  person_workflow::PhotoMeshOptions options_;
  std::string box_;
  bool no_motion_ = false;
};

}  // namespace palmar::cli
