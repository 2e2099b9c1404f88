// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "cli.h"

namespace palmar::cli {

/// `palmar hand export --format inp`: an indenter pressed into one region of a hand, as a
/// finite-element deck for CalculiX.
struct PressDeckArguments {
  std::string region, indenter = "plane", depths = "0.5,1,1.5,2";
  double tilt_deg = 0.0;
  double shear_modulus_kpa = 10.0;
  double poisson = 0.495;
  double largest_tet = 2.0;  ///< mm^3
  std::optional<double> cut;
  bool is_large_strain = false;
};

void add_press_deck_options(CLI::App& verb, PressDeckArguments& arguments);

/// Writes press.inp and the mesher's files to the folder `out`. Returns the exit code.
int run_press_deck(const PressDeckArguments& arguments, const std::string& hand,
                   const std::string& out, const CommonOptions& common);

}  // namespace palmar::cli
