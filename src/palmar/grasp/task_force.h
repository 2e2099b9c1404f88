// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "palmar/contact/friction/friction.h"
#include "palmar/grasp/grip.h"
#include "palmar/product/product.h"

namespace palmar::grasp {

// The force of the task: how firmly all designs and hands of one comparison are held when nothing
// is said about it. Were each held as firmly as closing to the limit depths makes it, the more
// loosely held design would look the more comfortable one.

/// What a hand is asked to do with a product.
enum class HandTask {
  kUsual,    ///< what UsualTask says of the products
  kSqueeze,  ///< grips it firmly, whatever it is
  kHold,     ///< holds what its load asks for (holding_grip_force())
  kCarry,    ///< that while its person walks (kWalking)
  kTurn      ///< turns it with a torque about the grip axis
};
inline constexpr std::array kHandTasks = {HandTask::kUsual, HandTask::kSqueeze, HandTask::kHold,
                                          HandTask::kCarry, HandTask::kTurn};
std::string_view name_of(HandTask task);  ///< "usual", "squeeze", "hold", "carry", "turn"
/// Throws UsageError listing the names.
HandTask hand_task_named(std::string_view name);
/// Only as much force as a load takes.
inline bool holds_load(HandTask task) {
  return task == HandTask::kHold || task == HandTask::kCarry;
}
inline bool says_how_firmly(HandTask task) { return holds_load(task) || task == HandTask::kTurn; }

/// Upward acceleration of what is carried in walking, standard gravities: the ground's reaction
/// then peaks at 1.1 to 1.2 times a body's weight (textbooks of gait, not read for this), and what
/// hangs from the body follows it. The more of it.
inline constexpr double kWalking = 0.2;

/// Share of the grip strength. 0.25 lies between what a hand can keep up for ten minutes (18.9 %,
/// SD 2.5; Kwak et al. 2023, Eur J Appl Physiol 123) and the mean at work with a hand tool (28.3 %,
/// measured with an instrumented knife; McGorry, Dowd & Dempsey 2003, Appl Ergon 34:375-382).
inline constexpr double kUsualStrengthShare = 0.25;
inline constexpr double kUsualAge = 45.0;  ///< years; about the middle of adult life: our choice

/// Mean grip_strength() of women and men of kUsualAge [N], each sex counted once: 427 N.
double usual_grip_strength();

/// How much more than a load takes people press, so that it doesn't slip: by 10 to 40 % (Westling &
/// Johansson 1984; Johansson & Flanagan 2009, both at second hand). The most of it.
inline constexpr double kGripMargin = 1.4;

/// Grip force [N] of two opposed contacts that hold a load [N] by friction, with that margin:
///
///     F = kGripMargin load / (2 mu)
///
/// 0 without friction, which then has no share in holding it.
double holding_grip_force(double load, double friction);

/// What even the lightest thing is held with, N; our choice.
inline constexpr double kLightestHold = 1.0;

/// Density of a product whose mass isn't known [g/cm^3]: water's, that of most plastics. For the
/// question alone whether the usual grip force holds it; nothing weighs on the hand.
inline constexpr double kAssumedDensity = 1.0;

/// The largest load among the products of a comparison.
struct HeaviestLoad {
  double force = 0.0;         ///< N; weight and further force
  std::string product;        ///< that has it
  bool is_estimated = false;  ///< its weight: from its volume and kAssumedDensity

  /// Takes another product into account. Without a weight in `load` it is estimated, if the
  /// product encloses a volume.
  void add(const product::Product& product, const contact::ProductLoad& load);
};

/// A grip force as a share of what a person reaches; which force that is depends on the grip.
struct ShareOfStrength {
  double share = kUsualStrengthShare;  ///< above 0 to 1
  double strength = 0.0;               ///< N, of a power grip
  std::string whose;                   ///< "women of 45 years (Steiber 2016)"; may be empty
  double least = 0.0;                  ///< N; what holds a load: a smaller share is raised to it
  std::string why_least;               ///< "the 12.0 N of kettle by friction ..."
  bool holds_only = false;  ///< `least` alone, but at least kLightestHold (UsualTask::kHold)

  /// Takes `least` from a load, as friction holds it.
  void take_least(double friction, const HeaviestLoad& heaviest);
  double reached(Grip grip) const;  ///< N; strength times strength_share(grip)
  /// N; the share of that, or `least` if it is more, but not above all of it. A push holds nothing:
  /// the share.
  double force(Grip grip) const;
  bool is_raised(Grip grip) const;  ///< by `least`
  /// Where the force comes from, to follow "107 N: ".
  std::string words(Grip grip) const;
};

/// "women and men of 45 years (mean; Steiber 2016)": whose strength usual_grip_strength() is.
std::string usual_people();

/// What is asked for when nothing is said: kUsualStrengthShare of usual_grip_strength(), raised to
/// what holds the heaviest product.
ShareOfStrength usual_share(double friction, const HeaviestLoad& heaviest = {});

}  // namespace palmar::grasp
