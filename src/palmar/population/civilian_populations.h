// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "palmar/population/population.h"

namespace palmar::population {

/// Built-in populations of civilians, children and older people of whom published surveys have hand
/// length and breadth: delhi_men; nigerian; mexican; indian_women; dutch (20 to 60 years);
/// dutch_over_60, dutch_over_80 and beijing_over_65; dutch_children_2 to dutch_children_12. Those
/// of both sexes also as NAME_men and NAME_women; NAME has half of each. What was measured, what
/// was borrowed and how sure it is: docs/method/populations.md.
std::vector<Population> civilian_populations();

}  // namespace palmar::population
