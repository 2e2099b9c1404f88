// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <vector>

#include "palmar/grasp/holds/hold_terms.h"

namespace palmar::grasp {

/// A hold that is looked at, with what its shape says of it.
struct HoldCandidate {
  Hold hold;
  HoldSite at;
  std::vector<HoldTerm> terms;
  double score = 0.0;
  std::size_t index = 0;  ///< of its place and turn, in the order in which they are tried
};

/// Power holds of every part, a few hundred: at its middle, its ends, its centre of gravity and its
/// waists, the thumb's side to either end, the palm on eight sides (of a loop: outside). Best
/// first; equally good ones in the order of the part's coordinates. Those that `options` exclude
/// are left out.
std::vector<HoldCandidate> power_candidates(const HoldScene& scene, const HoldOptions& options);

/// Whether a part is meant by the options: by number, by name, or because none is asked for.
/// Whether the whole product is round about a part's axis: then it is all one on which side of it
/// the palm is.
bool is_round_about(const product::ProductPart& axis_of, const product::ProductParts& parts);

bool is_part_asked(const product::ProductPart& part, const HoldOptions& options);

}  // namespace palmar::grasp
