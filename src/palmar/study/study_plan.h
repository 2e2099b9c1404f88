// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "palmar/grasp/find/grasp_settings.h"
#include "palmar/grasp/grip.h"
#include "palmar/grasp/task_force.h"
#include "palmar/population/hand_profile.h"
#include "palmar/population/hand_sample.h"
#include "palmar/population/population.h"
#include "palmar/study/assessment/assessment.h"

namespace palmar::study {

/// One population with how its hands are drawn.
struct StudyPopulation {
  population::Population population;
  population::SamplingOptions sampling;
};

/// One hand of a study.
struct StudyHand {
  int population = 0;  ///< index into StudyPlan::populations
  population::HandSample sample;
};

/// One product of a study, in one size.
struct StudyProduct {
  std::string name;              ///< unique in the study: "handle r3", "handle r3 x 0.9"
  std::string family;            ///< what its sizes share: "handle r3"
  double size = 1.0;             ///< factor on the file's lengths
  std::string file;              ///< path as written by the user, or the generating words; a path
                                 ///< is no part of what the study is
  std::string content_hash;      ///< SHA-256 of mesh in mm, hex
  std::string unit = "mm";       ///< of the file, as it was settled
  std::optional<Vec3> at, axis;  ///< where it is held, product frame, mm (before `size`)
  grasp::HoldRequest holding;    ///< by which part and how; excludes `at` and `axis`
  double mass = 0.0;             ///< kg; 0: no load
  /// Name of the product of the same study and size whose grasp at rest is kept, posture and
  /// placement as they are (Xie 2014, 5.5.3: prisms with two fillets in one posture); TOML
  /// `posture_of`. Empty: grasped by itself.
  std::string posture_of;
};

/// One set of equations and grasp settings under which everything is run.
struct StudySetting {
  std::string name = "default";
  double palm_limit_depth = 7.0;    ///< mm
  double finger_limit_depth = 4.0;  ///< mm
  grasp::HandTask task = grasp::HandTask::kUsual;
  /// kTurn: torque about the grip axis, N m; right-handed about the axis towards the thumb's side.
  std::optional<double> turn;
  // How firmly; at most one of the three, for a task that doesn't say it. Of a plan in which none
  // is said limit depths decide; load_study() fills in the usual grip force before.
  std::optional<double> grip_force;      ///< N
  std::optional<double> strength_share;  ///< of `strength`
  bool limit_depths = false;             ///< as firm as closing to the limit depths made it
  std::optional<double> strength;        ///< N; the same for all hands; unset: each person's own
  double least_grip_force = 0.0;  ///< N; to which a share is raised, at most to all of `strength`
  /// Products that are only held (grasp::UsualTask), all of them, are held with the least grip
  /// force in place of the share.
  bool follows_product = false;
  double friction = 0.5;
  /// Whether a grasp comes to rest; if not, it stays as the hand was closed (Xie 2014).
  bool is_balanced = true;
  contact::ContactModel model = contact::palmar_model();
  bool indices = true;
  /// Whether the indices have the volume of the wrench space, too: a tenth of a study's time.
  bool wrench_volume = false;
  /// Whether the indices have the largest torque about the grip axis (held_torque.h), too.
  bool torque = false;
  /// Whether the skin is refined on sharp edges of the product (ContactOptions::refine).
  bool refine = false;
  /// Where a product is held: found once on the mean hand and kept for all (only pressing in and
  /// closing are done again), or searched for every hand.
  bool is_place_per_hand = false;
};

/// Share of hands inside is what accommodation means; unset edges don't limit.
struct StudyLimit {
  std::string quantity;  ///< key of a result: "peak_pressure_cells_mpa", "force_n", an index's key
  std::optional<double> lowest, highest;
};

/// What the setting's strength share is of: its strength, or `own` [N] of the person.
grasp::ShareOfStrength share_of_strength(const StudySetting& setting, double own);

/// Everything a study runs: populations x profiles x products x grips x settings.
struct StudyPlan {
  std::string name, title;
  std::uint64_t seed = 1;
  std::vector<StudyPopulation> populations;
  std::vector<population::HandProfile> profiles;  ///< at least "none"
  std::vector<StudyHand> hands;                   ///< all populations, drawn
  std::vector<StudyProduct> products;
  std::vector<std::optional<grasp::Grip>> grips;  ///< nothing: the power grip that suits the shape
  std::vector<StudySetting> settings;
  std::vector<StudyLimit> limits;
  std::string hand_hash;  ///< of the hand that is scaled
  void check() const;     ///< throws UsageError: object, value, what is allowed
};

/// What check() asks of one product, by its index: throws UsageError if its name is that of an
/// earlier one, or if what it is or keeps can't be.
void check_product(const StudyPlan& plan, std::size_t product);

/// One grasp of the plan. Tasks are numbered hand by hand, so that a hand is prepared once.
struct StudyTask {
  int hand = 0, profile = 0, setting = 0, product = 0, grip = 0;
  auto operator<=>(const StudyTask&) const = default;
};
std::int64_t task_count(const StudyPlan& plan);
StudyTask task_at(const StudyPlan& plan, std::int64_t number);
std::int64_t number_of(const StudyPlan& plan, const StudyTask& task);

/// Part `k` of `n`, from 1: every n-th hand with all that is done with it, so that a hand is
/// prepared once.
struct StudyShard {
  int k = 1, n = 1;
  void check() const;  ///< throws UsageError
  bool operator==(const StudyShard&) const = default;
};
std::string name_of(StudyShard shard);  ///< "2/4"
/// Numbers of its tasks, ascending. Throws UsageError if there are more shards than hands.
std::vector<std::int64_t> tasks_of(const StudyPlan& plan, StudyShard shard = {});

}  // namespace palmar::study
