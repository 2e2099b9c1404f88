// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/study_hand_maker.h"

#include "palmar/hand/instance/hand_instance.h"

namespace palmar::study {

StudyHandMaker study_hand_maker(const StudyPlan& plan, std::shared_ptr<const hand::Hand> base) {
  const auto maker = std::make_shared<const hand::HandInstanceMaker>(*base);
  return [&plan, base, maker](const StudyTask& task) {
    const population::HandSample sample =
        population::with_profile(plan.hands[task.hand].sample, plan.profiles[task.profile]);
    return maker->make(sample.dimensions).hand;
  };
}

}  // namespace palmar::study
