// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "palmar/contact/bone/skin_compliance.h"

namespace palmar::records {

/// What the compliance of a hand's skin depends on, as 64 hex digits: skin, bones, segments,
/// regions, options, and the version of the method. Tissue (moduli) and name are not part of it.
std::string compliance_key(const hand::Hand& hand,
                           const contact::SkinComplianceOptions& options = {});

/// Binary file of a compliance; a cache, not for exchange. Responses in single precision. Written
/// under another name and then renamed, so that nobody reads half a file. Throws OutputError.
void write_compliance(const std::filesystem::path& path, const std::string& key,
                      const contact::SkinCompliance& compliance);

/// Nothing if there is no such file, or one with another key, of another length or cut short: then
/// it is to be made anew. `hand`: whose key it is.
std::optional<contact::SkinCompliance> read_compliance(const std::filesystem::path& path,
                                                       const std::string& key,
                                                       const hand::Hand& hand);

}  // namespace palmar::records
