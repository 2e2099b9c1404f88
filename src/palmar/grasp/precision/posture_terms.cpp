// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/precision/posture_terms.h"

#include <algorithm>

#include "palmar/grasp/power/skin_advance.h"

namespace palmar::grasp {
namespace {

constexpr double kFlexionSpread = 0.35;   // rad
constexpr double kThumbSpread = 0.3;      // rad
constexpr double kAbductionSpread = 0.2;  // rad
constexpr double kCouplingSpread = 0.2;   // rad
constexpr double kMcpSpread = 0.35;       // rad, between neighbours
constexpr double kPipSpread = 0.5;        // rad, between neighbours
constexpr double kCoupling = 2.0 / 3.0;   // DIP per PIP

double spread_of(hand::Dof dof) {
  if (is_abduction(dof)) return kAbductionSpread;
  return dof <= hand::Dof::kThumbIpFlexion ? kThumbSpread : kFlexionSpread;
}

}  // namespace

bool is_abduction(hand::Dof dof) {
  return std::any_of(kFingers.begin(), kFingers.end(),
                     [&](hand::Finger f) { return dof == abduction_of(f); });
}

std::vector<PostureTerm> posture_terms(const hand::Posture& natural) {
  std::vector<PostureTerm> terms;
  for (int d = static_cast<int>(hand::Dof::kThumbCmcFlexion); d < hand::kDofCount; ++d) {
    const auto dof = static_cast<hand::Dof>(d);
    terms.push_back({{dof, dof}, {1.0, 0.0}, natural[dof], spread_of(dof)});
  }
  for (const hand::Finger finger : kFingers) {
    terms.push_back(
        {{flexion_of(finger, 2), flexion_of(finger, 1)}, {1.0, -kCoupling}, 0.0, kCouplingSpread});
  }
  for (std::size_t f = 0; f + 1 < kFingers.size(); ++f) {
    for (int level = 0; level < 2; ++level) {
      const hand::Dof a = flexion_of(kFingers[f], level), b = flexion_of(kFingers[f + 1], level);
      terms.push_back(
          {{a, b}, {1.0, -1.0}, natural[a] - natural[b], level == 0 ? kMcpSpread : kPipSpread});
    }
  }
  return terms;
}

double value_of(const PostureTerm& term, const hand::Posture& posture) {
  return (term.factor[0] * posture[term.dof[0]] + term.factor[1] * posture[term.dof[1]] -
          term.value) /
         term.spread;
}

double posture_strain(const hand::Posture& natural, const hand::Posture& posture) {
  double sum = 0.0;
  for (const PostureTerm& term : posture_terms(natural)) {
    const double r = value_of(term, posture);
    sum += r * r;
  }
  return sum;
}

}  // namespace palmar::grasp
