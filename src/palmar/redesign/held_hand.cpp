// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/held_hand.h"

#include <string>
#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/study/study_hand_maker.h"
#include "palmar/study/study_task.h"

namespace palmar::redesign {
namespace {

HeldHand make_held(const study::StudyRecord& record, const study::StudyTask& task,
                   const study::StudyHandMaker& hand_of) {
  HeldHand held;
  held.hand = task.hand;
  held.who = std::make_shared<const hand::Hand>(hand_of(task));
  held.product_from_hand = record.product_from_hand;
  held.skin.vertices = hand::pose_skin(*held.who, record.posture);
  for (Vec3& x : held.skin.vertices) x = record.product_from_hand * x;
  held.skin.triangles = held.who->skin.triangles;
  held.pressure = study::dense(record.skin_pressure, held.skin.vertices.size());
  held.product_pressure = record.product_pressure;
  return held;
}

}  // namespace

void for_each_held_hand(const study::StudyPlan& plan, const study::StudyInputs& inputs,
                        const study::RecordSource& records, const study::StudyCondition& condition,
                        int product, const std::function<void(const HeldHand&)>& visit,
                        const Progress& progress) {
  const study::StudyHandMaker hand_of = study::study_hand_maker(plan, inputs.base);
  const auto batch = static_cast<std::size_t>(thread_count());
  std::vector<study::StudyRecord> waiting;
  int held_hands = 0;
  const auto flush = [&] {
    std::vector<HeldHand> made(waiting.size());
    parallel_for(static_cast<int>(waiting.size()), [&](int i) {
      const study::StudyRecord& record = waiting[i];
      made[i] = make_held(record, study::task_at(plan, record.number), hand_of);
    });
    for (const HeldHand& one : made) {
      progress.update(static_cast<double>(++held_hands) / static_cast<double>(plan.hands.size()),
                      "hands on the product");
      visit(one);
    }
    waiting.clear();
  };
  records([&](const study::StudyRecord& record) {
    const study::StudyTask task = study::task_at(plan, record.number);
    const study::StudyHand& hand = plan.hands[task.hand];
    if (task.product != product || task.profile != condition.profile ||
        task.setting != condition.setting || task.grip != condition.grip ||
        !study::is_in_hand(record) ||
        (condition.population && hand.population != *condition.population)) {
      return;
    }
    waiting.push_back(record);
    if (waiting.size() == batch) flush();
  });
  flush();
  if (held_hands == 0) {
    throw UsageError("redesign: no hand holds \"" + plan.products[product].name +
                     "\"; a redesign starts from at least one that does");
  }
}

}  // namespace palmar::redesign
