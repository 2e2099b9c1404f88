// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "palmar/population/population.h"

namespace palmar::records {

/// Version of the population files that this program writes; a newer one is refused.
inline constexpr int kPopulationFileVersion = 1;

/// Population as a TOML file that people edit (docs/using/populations.md). Lengths in mm.
///
///     name = "our_women"
///     title = "Women of our plant"
///     source = "who measured whom, when"
///     cautions = ["reported with every result"]
///
///     [[stratum]]                  # people that one normal distribution describes
///     name = "women"
///     sex = "female"               # "male"; left out: mixed or unknown
///     share = 1.0                  # of the population; all together 1
///     age_years = 35.0             # for grip strength
///
///     [[stratum.driving]]
///     dimension = "hand_length"    # names of hand/dimensions/hand_dimension.h
///     mean_mm = 175.0
///     sd_mm = 9.0                  # left out: only the mean is known
///     evidence = "measured"        # or "scaled": borrowed from other people
///     source = ""
///
///     [[stratum.correlation]]      # of every pair of driving dimensions, once
///     between = ["hand_length", "hand_circumference"]
///     r = 0.55
///
///     [[stratum.regression]]
///     dimension = "index_middle_length"
///     intercept_mm = 1.2
///     slope = { hand_length = 0.12 }   # mm per mm; driving or earlier regressed dimensions
///     residual_sd_mm = 0.8
///     evidence = "regressed"       # measured, regressed, scaled
///     source = ""
///
/// Throws InputError naming file, line, key, value and what is allowed: unreadable or no TOML, an
/// unknown key, dimension or word (with the nearest known one), a value of the wrong kind or out of
/// range, and what Population::check() refuses.
population::Population read_population(const std::string& path);
/// The same from the text of such a file.
population::Population parse_population(const std::string& text, const std::string& path);

/// The built-in population of that name, or the file if the name ends in ".toml". Throws
/// InputError, UsageError naming the nearest built-in one.
population::Population load_population(const std::string& name_or_path);

/// Reads back to the same value. Throws OutputError.
void write_population(const std::string& path, const population::Population& population);
std::string population_toml(const population::Population& population);

}  // namespace palmar::records
