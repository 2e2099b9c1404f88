// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "palmar/records/product/product_file.h"

namespace palmar::cli {

/// Bodies, faces with area and colour, tolerance of a CAD file, for `palmar product info`.
std::string cad_text(const records::ImportedCad& cad, const std::string& stated_unit = "");
nlohmann::ordered_json cad_json(const records::ImportedCad& cad);

/// What the CAD kernel finds, for `palmar product check`.
std::string verdict_text(const records::CadVerdict& verdict);
nlohmann::ordered_json verdict_json(const records::CadVerdict& verdict);

}  // namespace palmar::cli
