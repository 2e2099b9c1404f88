// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace palmar::phantom {

/// How far a synthetic person is from the hand that it starts from, beside its size. The defaults
/// are a near relative: the start hand's proportions, webs and reference posture (posed by
/// pose_skin()), joints a degree and half a millimetre off its own.
struct PersonDispersion {
  /// Proportions of surveys by their own rulers instead of the start hand's (see sized_hand()), the
  /// reference posture by the person's own soft tissue instead of pose_skin().
  bool is_free = false;
  double shortest = 165.0, longest = 194.0;  ///< hand length, mm
  double axis = 0.02;      ///< of a flexion axis in each of three directions, rad, deviation
  double slant = 0.015;    ///< of its slant towards the phalanx, rad, deviation
  double centre = 0.5;     ///< of a joint along the finger, mm, deviation; half of it dorsally
  double relief = 1.0;     ///< heights of the bumps of the outline over those of a near relative
  double fingertip = 0.0;  ///< share by which fingertips are slimmer or blunter, deviation
  double knuckle = 0.0;    ///< share by which finger joints are thicker than shafts, deviation
  double web = 0.0;        ///< of the webs between fingers along them, mm, deviation
  double crease = 0.8;     ///< of creases along the finger, mm, deviation; at the wrist half more
  double crease_slope = 0.0;  ///< by which they run obliquely, rad, deviation
  double table = 0.0;         ///< of the knuckles' flexion when fingers lie on a table, rad
};

/// A person as far from the template as people are from each other. Flexion axes: 0.09 rad in both
/// directions across the axis, held to 2.5 of it, are 6.5 degrees off in the mean (people's differ
/// by 5 to 8). The others are our choice; nothing of Palmar was chosen with such persons in view.
inline constexpr PersonDispersion kFreePerson{.is_free = true,
                                              .shortest = 150.0,
                                              .longest = 222.0,
                                              .axis = 0.09,
                                              .slant = 0.09,
                                              .centre = 1.0,
                                              .relief = 1.6,
                                              .fingertip = 0.07,
                                              .knuckle = 0.03,
                                              .web = 1.5,
                                              .crease = 1.3,
                                              .crease_slope = 0.08,
                                              .table = 0.015};

}  // namespace palmar::phantom
