// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/formats/figure/drawing_file.h"
#include "palmar/product/product.h"
#include "palmar/records/region_json.h"
#include "palmar/workflow/redesign/region_findings.h"

namespace palmar::workflow {

/// Outlines of all regions and the fitted target surfaces, as the CAD program is given them.
std::vector<records::NamedCurve> curves_of(const RegionFindings& findings);
std::vector<records::NamedSurface> surfaces_of(const RegionFindings& findings);

/// One JSON object.
std::string region_json(const RegionFindings& findings, const product::Product& product);
/// Faces with their share of area in each region; "" if the product has no faces.
std::string region_csv(const RegionFindings& findings, const product::Product& product);
formats::Drawing region_drawing(const redesign::UnrolledOutline& sheet,
                                const std::vector<redesign::ContactRegion>& regions,
                                const std::string& product);

}  // namespace palmar::workflow
