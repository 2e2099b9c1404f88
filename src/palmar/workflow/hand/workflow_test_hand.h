// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

// What the tests of this module share: the template hand, coarse and so fast, and folders.

#include <unistd.h>

#include <filesystem>
#include <memory>
#include <string>

#include "palmar/hand/template/template_hand.h"
#include "palmar/product/primitives.h"
#include "palmar/records/hand/hand_asset.h"

namespace palmar::workflow::workflow_test {

/// Made of the asset, with edges of 4 mm.
inline std::shared_ptr<const hand::Hand> coarse_hand() {
  static const auto hand = std::make_shared<const hand::Hand>(hand::build_template(
      records::read_hand_asset(
          PALMAR_SOURCE_DIR "/node_modules/@webxr-input-profiles/assets/dist/profiles/generic-hand/"
                            "right.glb"),
      {.edge_length = 4.0}));
  return hand;
}

/// A handle about the origin, along z.
inline product::Product handle(double diameter) {
  product::CylinderProductOptions options;
  options.diameter = diameter;
  options.length = 140.0;
  options.fineness.chordal_error = 0.1;
  return product::make_cylinder_product(options);
}

/// A folder of its own, gone at the end of the test.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "palmar_workflow_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace palmar::workflow::workflow_test
