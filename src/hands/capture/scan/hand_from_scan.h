// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "hands/capture/scan/dotted_thumb.h"
#include "hands/capture/scan/mark_labels.h"
#include "hands/capture/scan/placed_skeleton.h"
#include "hands/capture/scan/scanned_hand.h"
#include "hands/capture/scan/skin_marks.h"
#include "palmar/core/progress.h"
#include "palmar/hand/dimensions/tape_measures.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/person/scan_posture.h"

namespace palmar::capture {

/// A surface scan of one posture.
struct SurfaceScan {
  std::string name;             ///< of its file, for messages
  geometry::TriangleMesh skin;  ///< mm, oriented outwards; may have holes; any frame
  SkinMarks marks;              ///< in the same frame; empty without colours
};

/// What the dots show of one joint.
struct DottedJoint {
  hand::Segment segment{};      ///< distal of it
  hand::ScanPosture posture{};  ///< against the reference posture
  double turn = 0.0;            ///< rad, from the reference
  double residual = 0.0;        ///< rms of the dots that a fixed axis leaves, mm
  double axis_change = 0.0;     ///< of the axis against that found from the skin, rad
  double axis_error = 0.0;      ///< standard error of the axis' tilt in either direction, rad
  double centre_change = 0.0;   ///< of the joint's centre, mm
  int dots = 0;
};

struct HandFromScan {
  ScannedHand scanned;                ///< its dimensions are those between the person's creases
  FoundCreases creases;               ///< hand frame
  hand::HandTape tape;                ///< along the skin between these creases
  std::map<hand::Segment, int> dots;  ///< seen in the reference scan
  std::vector<TakenMark> marks;       ///< of all scans
  std::vector<DottedJoint> joints;
  std::map<hand::ScanPosture, ThumbReading> thumb;               ///< in every other scan
  std::map<hand::ScanPosture, hand::MeshFit> fits;               ///< of the hand in the other scans
  std::map<hand::ScanPosture, hand::Posture> postures;           ///< angles of every scan
  std::map<hand::ScanPosture, geometry::Rigid3> scan_from_hand;  ///< where the palm lies in every
                                                                 ///< scan
  std::vector<double> distance;  ///< per skin vertex: to the reference scan, mm; -1: no scan there
  std::vector<std::string> notes;
};

/// Where joints and fingertips are in one scan, mm.
struct PlacedJoints {
  struct Place {
    Vec3 axis = Vec3::UnitX(), centre = Vec3::Zero();  ///< of flexion
  };
  std::map<hand::Segment, Place> joint;     ///< the one proximal of it
  std::map<hand::Segment, Vec3> fingertip;  ///< of the last segments
};
/// The hand's joints as it was fitted to a scan, in that scan's frame. `posture`: one of
/// made.postures.
PlacedJoints joints_in_scan(const HandFromScan& made, hand::ScanPosture posture);

/// Makes a person's hand of surface scans: the reference posture (natural, fingers apart) at least;
/// finger_flexion and finger_abduction show joints if dots were drawn (Xie 2014, chapter 4).
///
/// 1. Joints by the skin (place_skeleton()), moved to the drawn creases.
/// 2. The model registered to the scan as for images (make_scanned_hand()).
/// 3. That hand is fitted to the other scans; where its skin would carry the dots, dots are looked
///    for (match_markers()).
/// 4. Joint by joint from the palm outwards: axis u, point p and angle t that make
///      sum |Rot(u, p, t) x_i - M^-1 y_i|^2 / s^2 + |u - u0|^2 / a^2 + |p - p0|^2 / b^2
///    least, M the motion of the part before, x and y the dots of the part behind in both scans, u0
///    and p0 the skin's; a = 6 degrees, b = 1.5 mm, s by the dots' own residuals (fit_dot_hinge()).
///    Xie 2014 takes the dots alone; three dots close together on sliding skin show an axis to four
///    degrees only. Axes about which dots and skin disagree are named.
/// 5. The thumb's limit postures give its CMC joint by four transforms (dotted_thumb.h) and correct
///    the thumb ball.
/// 6. The hand again with these joints; flexion and abduction scanned are the ends of the ranges.
///
/// `model` may be of either side; `side`: as for place_skeleton(). Creases and dots that lack are
/// named and done without, a scan in which this hand isn't found as well. Throws InputError without
/// a reference scan, or if no hand is found in it.
HandFromScan make_hand_from_scans(const hand::Hand& model,
                                  const std::map<hand::ScanPosture, SurfaceScan>& scans,
                                  std::optional<hand::Side> side = {},
                                  const Progress& progress = {});

}  // namespace palmar::capture
