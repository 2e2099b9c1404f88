// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/grasp/holds/hold.h"

namespace palmar::grasp {

/// What a grip force that was stated says of a grip: how many people can grip so firmly in it
/// without using more of their strength than is advised,
///
///     ln share_who_reach(F / a, grip, 45 years),   a = 0.5, at least -6
///
/// with F [N] the force. Power grips reach a person's whole grip strength, pinches 0.14 to 0.22 of
/// it (strength_share()). Half of a person's capacity is what EN 1005-3:2002+A1:2008, 4.2.3, takes
/// for tolerable; quoted from memory, as its text wasn't at hand.
HoldTerm force_term(double force, Grip grip);

/// Which of ranked holds is taken if it is to be gripped with a stated force.
struct FirmHold {
  int number = 1;  ///< from 1
  /// Why not the first: "60 N is 69 % of what people reach in a tripod of the pen"; else empty.
  std::string why;
};

/// The best by score and force_term() together; within 0.2 of it the first of the list. `holds`
/// isn't empty.
FirmHold firm_hold(const std::vector<RankedHold>& holds, double force);

}  // namespace palmar::grasp
