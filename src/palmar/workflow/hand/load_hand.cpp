// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/hand/load_hand.h"

#include <cstdlib>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/tissue_file.h"

namespace palmar {

namespace fs = std::filesystem;

std::string share_folder() {
  if (const char* folder = std::getenv("PALMAR_SHARE")) return folder;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  return (executable.parent_path().parent_path() / "share" / "palmar").string();
}

std::shared_ptr<const Hand> load_hand(const std::string& name) {
  if (name != "template") return std::make_shared<const Hand>(read_hand(name));
  const std::string path = share_folder() + "/template.hand.glb";
  if (!fs::exists(path)) {
    throw InputError("the template hand is missing: " + path +
                     " (run `palmar doctor`; it is made when Palmar is built)");
  }
  return std::make_shared<const Hand>(read_hand(path));
}

std::shared_ptr<const Hand> load_hand(const std::string& name, const std::string& tissue_file) {
  return load_hand(HandChoice{.name = name, .tissue = tissue_file, .value = nullptr});
}

std::shared_ptr<const Hand> load_hand(const HandChoice& choice) {
  const auto hand = choice.value ? choice.value : load_hand(choice.name);
  if (choice.tissue.empty()) return hand;
  auto other = std::make_shared<Hand>(*hand);
  other->tissue = read_tissue(choice.tissue, hand->tissue);
  return other;
}

}  // namespace palmar
