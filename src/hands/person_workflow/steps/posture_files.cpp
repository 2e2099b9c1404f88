// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/posture_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/core/text.h"

namespace palmar::person_workflow {

std::optional<hand::ScanPosture> posture_in_name(const std::string& path) {
  std::string name = std::filesystem::path(path).stem().string();
  if (const auto known = hand::scan_posture_in(name)) return known;
  name = lower_case(name);
  std::optional<hand::ScanPosture> found;
  const auto look = [&](std::string_view word, hand::ScanPosture posture) {
    if (name.find(word) != std::string::npos && !found) found = posture;
  };
  if (name.find("thumb") != std::string::npos) {
    look("flex", hand::ScanPosture::kThumbFlexion);
    look("ext", hand::ScanPosture::kThumbExtension);
    look("abd", hand::ScanPosture::kThumbAbduction);
    look("add", hand::ScanPosture::kThumbAdduction);
    return found;
  }
  look("natural", hand::ScanPosture::kReference);
  look("open", hand::ScanPosture::kReference);
  look("flex", hand::ScanPosture::kFingerFlexion);
  look("fist", hand::ScanPosture::kFingerFlexion);
  look("bent", hand::ScanPosture::kFingerFlexion);
  look("abduct", hand::ScanPosture::kFingerAbduction);
  look("spread", hand::ScanPosture::kFingerAbduction);
  return found;
}

std::map<hand::ScanPosture, std::string> files_by_posture(
    const std::vector<std::string>& paths, const std::map<std::string, hand::ScanPosture>& stated,
    const std::string& what) {
  std::map<hand::ScanPosture, std::string> files;
  const auto put = [&](hand::ScanPosture posture, const std::string& path) {
    const auto [place, is_new] = files.try_emplace(posture, path);
    if (!is_new) {
      throw UsageError(
          fmt::format("{} and {} both show the posture {}; setting \"posture\" FILE=POSTURE says "
                      "what a file shows",
                      place->second, path, name_of(posture)));
    }
  };
  for (const auto& [file, posture] : stated) {
    if (std::find(paths.begin(), paths.end(), file) == paths.end()) {
      throw UsageError("setting \"posture\": \"" + file + "\" isn't among the " + what + "s");
    }
  }
  for (const std::string& path : paths) {
    if (const auto at = stated.find(path); at != stated.end()) {
      put(at->second, path);
    } else if (const auto named = posture_in_name(path)) {
      put(*named, path);
    } else if (paths.size() == 1) {
      put(hand::ScanPosture::kReference, path);
    } else {
      throw UsageError(path +
                       ": its name doesn't give the posture (reference, finger_flexion, "
                       "finger_abduction); setting \"posture\" FILE=POSTURE does");
    }
  }
  if (!files.contains(hand::ScanPosture::kReference)) {
    throw UsageError(
        "no " + what +
        " shows the reference posture (fingers stretched, a little apart); it is needed");
  }
  return files;
}

}  // namespace palmar::person_workflow
