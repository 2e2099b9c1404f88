// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/holds/firm_hold.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "palmar/grasp/holds/hold_limits.h"
#include "palmar/grasp/joint_strength.h"
#include "palmar/grasp/task_force.h"

namespace palmar::grasp {
namespace {

constexpr double kAdvisedShare = 0.5;  // EN 1005-3:2002+A1:2008, 4.2.3
constexpr double kNobody = -6.0;       // the worst; choice

double share_used(double force, Grip grip) {
  return force / (usual_grip_strength() * strength_share(grip));
}

}  // namespace

HoldTerm force_term(double force, Grip grip) {
  const double able = share_who_reach(force / kAdvisedShare, grip, kUsualAge);
  return {"grip force", force, "N", std::max(kNobody, std::log(std::max(able, 1e-9))),
          fmt::format("{:.0f} N is {:.0f} % of what people reach in such a grip", force,
                      100.0 * share_used(force, grip))};
}

FirmHold firm_hold(const std::vector<RankedHold>& holds, double force) {
  std::vector<double> scores;
  for (const RankedHold& one : holds) {
    scores.push_back(one.score + force_term(force, one.hold.grip).score);
  }
  const double best = *std::max_element(scores.begin(), scores.end());
  FirmHold taken;
  while (scores[static_cast<std::size_t>(taken.number) - 1] < best - kNearTie) ++taken.number;
  if (taken.number > 1) {
    const RankedHold& first = holds.front();
    taken.why = fmt::format("{:.0f} N is {:.0f} % of what people reach in a {}", force,
                            100.0 * share_used(force, first.hold.grip), first.words);
  }
  return taken;
}

}  // namespace palmar::grasp
