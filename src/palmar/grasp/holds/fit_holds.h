// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/grasp/holds/hold_weights.h"

namespace palmar::grasp {

/// How a person was seen to hold an object that had lain so.
struct ObservedHold {
  HandPoints points;
  Standing lay;
};

/// An object, and how people were seen to hold it.
struct ObservedObject {
  std::string name;
  std::vector<OpposedHold> candidates;  ///< opposed_holds()
  std::vector<ObservedHold> seen;       ///< one per person and trial
};

/// An object whose holds weren't used for the weights that it is judged by.
struct LeftOut {
  std::string name;
  int seen = 0;             ///< people's holds
  double nearest = 0.0;     ///< median distance of people's holds to the nearest candidate, mm
  double likelihood = 0.0;  ///< mean logarithm per hold, as the object had lain
  double unseen = 0.0;      ///< the same by the weights of those who don't know how it had lain
  double even = 0.0;        ///< the same if all candidates were as likely
  double first =
      0.0;  ///< of the first mode (without knowing that) to the nearest person's hold, mm
  double best_of_eight = 0.0;  ///< the same of the best of the first eight modes
};

struct HoldFit {
  HoldWeights weights;      ///< by all objects
  double likelihood = 0.0;  ///< mean logarithm per hold, of the same holds
  std::vector<LeftOut> left_out;
};

/// Maximum likelihood of people's holds, each seen with the error of a camera and of a hand of
/// another size,
///
///     sum_i ln sum_c p_c exp(-d_ic^2 / 2 s^2) - r |weight|^2 / 2,   s = 20 mm, r = 5,
///
/// p_c as the object had lain there, by expectation and maximisation, the latter a Newton step of
/// the logit; features of shape have mean 0 and spread 1 over all candidates. Then again without
/// each object in turn, and all that without the features of the table. Deterministic. Throws
/// UsageError if there is no object, or one without candidates or holds.
HoldFit fit_holds(const std::vector<ObservedObject>& objects);

}  // namespace palmar::grasp
