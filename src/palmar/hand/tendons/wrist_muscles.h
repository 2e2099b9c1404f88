// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "palmar/hand/hand.h"
#include "palmar/hand/tendons/tendon.h"

namespace palmar::hand {

/// Flexion and radial deviation of the hand against the forearm, in this order; mm.
using WristVector = Eigen::Vector2d;

/// Where the wrist is. By default in the position of function, 30 degrees extended (textbooks have
/// 20 to 30; our choice), where the fibres of all muscles are taken to be best.
struct WristPosture {
  double flexion = -0.5236;  ///< rad
  double deviation = 0.0;    ///< rad, to the radial side
  void check() const;        ///< throws UsageError outside -70 to 75 and -35 to 20 degrees
};

/// The muscles that move the wrist alone.
enum class WristMuscle {
  kEcrl,  ///< extensor carpi radialis longus
  kEcrb,  ///< extensor carpi radialis brevis
  kEcu,   ///< extensor carpi ulnaris
  kFcr,   ///< flexor carpi radialis
  kFcu    ///< flexor carpi ulnaris
};
inline constexpr int kWristMuscleCount = 5;
std::string_view name_of(WristMuscle muscle);             ///< "ecrl"
std::string_view anatomical_name_of(WristMuscle muscle);  ///< "extensor carpi radialis longus"

/// What they can do in a posture.
struct WristMuscles {
  std::array<WristVector, kWristMuscleCount> arm;  ///< mm
  std::array<double, kWristMuscleCount> strength;  ///< at full activation, N
};

/// Forces at full activation and fibre lengths: the model of Lee et al. 2015 (PLoS ONE
/// 10:e0121712), times `tension` over 45 N/cm^2; force-length as in HandMuscles. Arms of flexion:
/// the model of Gonzalez, Buchanan & Delp 1997 (J Biomech 30:705-712; values at the straight wrist
/// and their change with flexion, at second hand). Arms of deviation: one hand (Mirakhorlo et al.
/// 2016). Arms grow with the distance of the wrist from the middle finger's MCP (90 mm in a hand of
/// 185 mm).
WristMuscles wrist_muscles(const Hand& hand, const WristPosture& posture, double tension);

/// Moment arms at the wrist of a digit's muscle that comes from the forearm, mm; 0 of the hand's
/// own muscles. FDS 15, FDP and FPL 12.5 mm flex (Brand & Hollister 1993, at second hand), in the
/// carpal tunnel without an arm of deviation (our choice); EDC extends as ECRB does, beside which
/// it lies (our choice). Deviation of extensors and all of the thumb's: one hand (Mirakhorlo et al.
/// 2016).
WristVector wrist_arm(const Hand& hand, Finger finger, Tendon tendon);

/// How much longer than in the position of function the wrist makes a muscle with these arms, mm.
double wrist_stretch(const WristVector& arm, const WristPosture& posture);

/// Moment [N mm] in the sense of the wrist's flexion of a force [N] at a point and a free moment
/// [N mm] on the hand; hand frame.
double wrist_moment(const Hand& hand, const Vec3& force, const Vec3& point,
                    const Vec3& moment = Vec3::Zero());

/// Active force of a muscle over that at its best length: exp(-(l - 1)^2 / 0.45) (Thelen 2003), l
/// the fibre length over the best one.
double force_length(double stretch, double best_length);

}  // namespace palmar::hand
