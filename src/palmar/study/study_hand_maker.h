// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>

#include "palmar/hand/hand.h"
#include "palmar/study/study_plan.h"

namespace palmar::study {

/// The hand that took part in a task: scaled, its profile's size applied. May be called from many
/// threads.
using StudyHandMaker = std::function<hand::Hand(const StudyTask&)>;

/// Makes the hands of a study again, for pictures and redesigns. `plan` must outlive it.
StudyHandMaker study_hand_maker(const StudyPlan& plan, std::shared_ptr<const hand::Hand> base);

}  // namespace palmar::study
