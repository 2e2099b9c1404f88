// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "hands/capture/joints/measured_joints.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::capture {

/// Dots on the thumb's two phalanges as the reference scan (x) and another one (y) show them; hand
/// frame, the palm standing still, mm.
struct ThumbDots {
  std::vector<Vec3> x_proximal, y_proximal, x_distal, y_distal;
};

/// Where the thumb is in a scan.
struct ThumbReading {
  geometry::Rigid3 metacarpal;  ///< its motion from the reference, hand frame
  double mp = 0.0;              ///< angles of its hinges, rad
  double ip = 0.0;              ///< rad
  double residual = 0.0;        ///< rms of the dots' distances, mm
  int dots = 0;
};

/// Motion of the thumb's metacarpal, on which no dots are: M, with the joint's centre c,
///   M p = M0 c + t + R0 Exp(d) (p - c),
/// t, d and the turns m, i of MP and IP joint (axes as in the skeleton) that make
///   sum |M MP(m) x - y|^2 + sum |M MP(m) IP(i) x - y|^2      over s^2 = (1 mm)^2
///   + |t|^2 / (1.5 mm)^2 + (|d|^2 + (m - m0)^2 + (i - i0)^2) / (8 degrees)^2
/// least: the base of the metacarpal stays on the trapezium, the skin (M0 with R0,
/// m0, i0 of `by_skin`) shows roughly how it lies.
ThumbReading read_thumb(const ThumbDots& dots, const hand::Skeleton& skeleton,
                        const hand::Posture& by_skin);

/// Puts the thumb's CMC joint into `joints` by what of its limit postures is among `readings` (Xie
/// 2014, eq. 2-5, 2-6; there from MRI): measure_cmc() of the metacarpal's motions. The limits'
/// angles in `joints.postures` are the ends of the ranges then; of every other reading, also
/// without limits, those that carry the metacarpal nearest to where it was read. `hand`: whose skin
/// the readings stand on.
void take_thumb_readings(const hand::Hand& hand,
                         const std::map<hand::ScanPosture, ThumbReading>& readings,
                         MeasuredJoints& joints);

/// True for the four limit postures of the thumb.
bool is_thumb_limit(hand::ScanPosture posture);

}  // namespace palmar::capture
