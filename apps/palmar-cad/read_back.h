// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>

#include "palmar/cad/model/cad_check.h"
#include "palmar/cad/model/cad_file.h"
#include "palmar/core/error.h"

namespace palmar::cad_worker {

/// What was written must be a closed, valid solid of the same volume [mm^3] when it is read again.
/// Throws NumericalError naming `what`.
inline void require_same(const std::filesystem::path& path, const std::string& what,
                         double volume) {
  constexpr double kSameVolume = 1e-3;  // of the volume
  const cad::CadCheck again = cad::check_cad(cad::read_step(path).model);
  if (again.is_good() && std::abs(again.volume - volume) <= kSameVolume * volume) return;
  throw NumericalError(fmt::format(
      "the STEP of {} doesn't read back as it is: {}, {:.6g} mm3 instead of {:.6g} mm3", what,
      again.findings.empty() ? "valid" : again.findings.front(), again.volume, volume));
}

}  // namespace palmar::cad_worker
