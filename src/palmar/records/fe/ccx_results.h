// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/geometry/types.h"

namespace palmar::records {

/// One step of a deck of inp_deck() as CalculiX solved it.
struct CcxStep {
  Vec3 force = Vec3::Zero();     ///< of the indenter on the skin, deck frame, N
  double area = 0.0;             ///< of skin under pressure, mm^2
  std::vector<int> node;         ///< nodes with contact pressure, from 0
  std::vector<double> pressure;  ///< at them, MPa
};

/// Steps of `text`, CalculiX' .dat file (totals of the reaction on the indenter and of the
/// contact), with pressures from `frd`, its .frd file. Throws InputError naming `name` if a step
/// lacks its totals or a number can't be read.
std::vector<CcxStep> parse_ccx(const std::string& text, const std::string& frd,
                               const std::string& name);

/// Reads STEM.dat and STEM.frd. Throws InputError.
std::vector<CcxStep> read_ccx(const std::string& stem);

}  // namespace palmar::records
