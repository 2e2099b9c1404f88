// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "palmar/contact/contact.h"
#include "palmar/core/progress.h"
#include "palmar/grasp/find/grasp_place.h"
#include "palmar/grasp/rest/friction_settings.h"
#include "palmar/grasp/rest/rest_settings.h"
#include "palmar/study/assessment/assessment.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/live/moving_contact.h"

namespace palmar::workflow {

/// Who holds products, ready for contact. Made once; shareable between sessions and threads.
struct LiveHand {
  std::shared_ptr<const hand::Hand> hand;
  std::shared_ptr<const hand::Hand> reference;  ///< reference_for() it
  std::shared_ptr<const contact::PreparedHand> prepared;
};
/// Some 0.5 s. Throws InputError, UsageError.
LiveHand prepare_live_hand(const HandChoice& choice,
                           const contact::ContactModel& model = contact::palmar_model());

/// What is asked of the hand while it holds the product.
struct LiveTask {
  grasp::RestSettings rest;
  grasp::FrictionSettings friction;
};

/// A hand in a posture and where it holds the product.
struct LivePose {
  hand::Posture posture;  ///< held to the range of motion before use
  geometry::Rigid3 product_from_hand;
};

/// One product in one hand, worked on step by step: what `palmar assess` and `palmar grasp
/// evaluate` do at once, with what depends on hand and product alone kept between the steps. Their
/// figures for the same hold and task, or the same posture and placement, are the same to the last
/// digit. One thread at a time.
class LiveSession {
 public:
  /// The product with the findings of its check (add_findings()).
  LiveSession(LiveHand hand, std::shared_ptr<const product::Product> product);

  const hand::Hand& hand() const { return *hand_.hand; }
  const hand::Hand& reference() const { return *hand_.reference; }
  const product::Product& product() const { return *product_; }

  /// Ways to hold the product, best first; ranked once (some 1 s). Throws Cancelled.
  const grasp::RankedHolds& holds(const Progress& progress = {});

  /// Takes the hold of that number, from 1, and lets it come to rest: `palmar assess --hold N`. A
  /// hold that was taken before isn't searched again. Throws UsageError (also if there are fewer
  /// holds), Cancelled.
  study::AssessmentSet take_hold(int number, const LiveTask& task, const Progress& progress = {});

  /// Fingers close round the product where it is, and the grasp comes to rest. `grip`: a power
  /// grip; unset: the one that suits the shape there. Throws UsageError, Cancelled.
  study::AssessmentSet close_here(const LivePose& pose, std::optional<grasp::Grip> grip,
                                  const LiveTask& task, const Progress& progress = {});

  /// The grasp comes to rest from that posture and placement. Throws UsageError, Cancelled.
  study::AssessmentSet rest_here(const LivePose& pose, grasp::Grip grip, const LiveTask& task,
                                 const Progress& progress = {});

  /// Posture and placement as they are: `palmar grasp evaluate`. Throws InputError if a number
  /// isn't finite, Cancelled.
  study::AssessmentSet evaluate_here(const LivePose& pose, grasp::Grip grip, const LiveTask& task,
                                     const Progress& progress = {});

  /// What move() needs beforehand, done once: some 0.2 s.
  void prepare_to_move();

  /// The contact alone, along a motion: from the last call's solution, as exact as is watched
  /// (moving_contact.h), without the error band; 5 to 15 ms. The result is
  /// overwritten by the next call. Throws UsageError for numbers that aren't finite.
  const contact::ContactResult& move(const LivePose& pose);

 private:
  study::AssessOptions options_for_task(const LiveTask& task) const;
  study::AssessmentSet set_of(study::Assessment assessment) const;
  grasp::Grasp given(const LivePose& pose, grasp::Grip grip) const;
  /// `reference`: how hand_.reference takes hold of it, where that is another hand.
  study::AssessmentSet rest_of(study::AssessOptions options, const LiveTask& task,
                               const grasp::Grasp& grasp, const Progress& progress,
                               const std::optional<grasp::Grasp>& reference = {});

  LiveHand hand_;
  std::shared_ptr<const product::Product> product_;
  std::shared_ptr<const contact::PreparedHand> reference_;  ///< hand_.reference, once it is needed
  std::map<int, grasp::GraspPlace> places_;                 ///< by the number of the hold
  std::map<int, grasp::Grasp> grasps_;                      ///< of `hand_` there
  std::optional<MovingContact> solver_;
  std::shared_ptr<const geometry::DistanceField> moving_distance_;
  contact::ContactResult moving_;
};

}  // namespace palmar::workflow
