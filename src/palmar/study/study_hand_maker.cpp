// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/study_hand_maker.h"

#include "palmar/hand/instance/hand_instance.h"

namespace palmar {

StudyHandMaker study_hand_maker(const StudyPlan& plan, std::shared_ptr<const Hand> base) {
  const auto maker = std::make_shared<const HandInstanceMaker>(*base);
  return [&plan, base, maker](const StudyTask& task) {
    const HandSample sample = with_profile(plan.hands[static_cast<std::size_t>(task.hand)].sample,
                                           plan.profiles[static_cast<std::size_t>(task.profile)]);
    return maker->make(sample.dimensions).hand;
  };
}

}  // namespace palmar
