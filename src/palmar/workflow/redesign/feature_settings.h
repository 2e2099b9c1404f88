// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/records/product/cad_features.h"
#include "palmar/redesign/feature_search.h"
#include "palmar/workflow/redesign/redesign_request.h"

namespace palmar::workflow {

/// One feature in words: "fillet:long=1:15", "offset:face=3=-2:2", "taper:sides=0:4",
/// "groove:at=40=0:2", "groove:line.csv=1.5", "diameter_mm=25:45".
struct FeatureSetting {
  std::string name;                    ///< "fillet:long", "diameter_mm"
  std::string unit;                    ///< "mm", "deg", ""
  records::CadFeature feature;         ///< its value is set per candidate
  std::string parameter;               ///< of the kind instead of a feature: "diameter_mm"
  double lowest = 0.0, highest = 0.0;  ///< equal: a single value was given
  bool varies() const { return lowest < highest; }
};

/// What all grooves share.
struct GrooveSettings {
  double radius = 10.0;  ///< mm
  double rim = 2.0;      ///< mm
};

/// Throws UsageError naming `vary` and the words; InputError on a groove's file.
FeatureSetting feature_setting(const std::string& words, const GrooveSettings& grooves = {});

/// The product of a redesign as a CAD program opens it; nothing if it is a mesh. Throws InputError
/// if its file can't be read.
std::optional<records::CadSource> cad_source_of(const RedesignRequest& request);

/// What is to be made of values, one per setting.
records::CadFeatureRequest request_for(const records::CadSource& source,
                                       const std::vector<FeatureSetting>& settings,
                                       const std::vector<double>& values);
/// "fillet:long 10.2 mm, diameter_mm 32".
std::string words_of(const std::vector<FeatureSetting>& settings,
                     const std::vector<double>& values);

}  // namespace palmar::workflow
