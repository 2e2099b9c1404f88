// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/hand_from_scan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "hands/phantom/mri/scan_defects.h"
#include "hands/phantom/photo/painted_hand.h"
#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "template_fixture.h"

namespace palmar::tests {
namespace {

using ::testing::HasSubstr;

/// A left hand in two postures, scanned with noise and holes, lying anywhere.
class HandFromScanTest : public TemplateTest {
 protected:
  static constexpr hand::ScanPosture kFlexed = hand::ScanPosture::kFingerFlexion;

  static const phantom::PaintedHand& person() {
    static const phantom::PaintedHand made = [] {
      phantom::PaintedHandOptions options;
      options.seed = 21;
      options.side = hand::Side::kLeft;
      options.levels = 1;
      return phantom::make_painted_hand(hand(), {hand::ScanPosture::kReference, kFlexed}, options);
    }();
    return made;
  }
  static const phantom::ScannedSurface& scanned(hand::ScanPosture posture) {
    static std::map<hand::ScanPosture, phantom::ScannedSurface> all;
    if (!all.contains(posture)) {
      phantom::ScanDefects defects;
      defects.seed = 5 + static_cast<std::uint64_t>(posture);
      all[posture] = phantom::scanned_surface(phantom::surface_of(person(), posture), 0.0, defects);
    }
    return all.at(posture);
  }
  static capture::SurfaceScan scan(hand::ScanPosture posture) {
    const geometry::ColouredMesh& surface = scanned(posture).surface;
    return {std::string(name_of(posture)), surface.mesh, capture::find_skin_marks(surface, "scan")};
  }
  static const capture::HandFromScan& made() {
    static const capture::HandFromScan result = capture::make_hand_from_scans(
        hand(), {{hand::ScanPosture::kReference, scan(hand::ScanPosture::kReference)},
                 {kFlexed, scan(kFlexed)}});
    return result;
  }
};

TEST_F(HandFromScanTest, MeasuresThePerson) {
  const hand::Hand& found = made().scanned.hand;
  EXPECT_EQ(found.side, hand::Side::kLeft);
  EXPECT_NO_THROW(geometry::require_closed_manifold(found.skin, "skin"));
  const hand::HandDimensions &d = found.dimensions, &t = person().dimensions;
  // Asked for: 1.1 mm in length, 1.2 in breadth, 1.0 in thickness, in the mean (Xie
  // 2014, 4.5).
  EXPECT_NEAR(d.hand_length, t.hand_length, 1.0);
  EXPECT_NEAR(d.hand_circumference, t.hand_circumference, 1.0);
  double length = 0.0, width = 0.0, thickness = 0.0;
  for (std::size_t k = 0; k < hand::kSegmentCount; ++k) {
    length += std::abs(d.segment[k].length - t.segment[k].length);
    width += std::abs(d.segment[k].width - t.segment[k].width);
    thickness += std::abs(d.segment[k].thickness - t.segment[k].thickness);
  }
  EXPECT_LT(length / hand::kSegmentCount, 0.5);
  EXPECT_LT(width / hand::kSegmentCount, 0.5);
  EXPECT_LT(thickness / hand::kSegmentCount, 0.5);
}

TEST_F(HandFromScanTest, SkinLiesOnTheTrueSkin) {
  const phantom::PaintedPosture& truth = person().postures.at(hand::ScanPosture::kReference);
  const geometry::ClosestPointQuery query({truth.skin, person().triangles});
  const geometry::Rigid3 true_from_found =
      scanned(hand::ScanPosture::kReference).scan_from_hand.inverse() *
      made().scanned.patient_from_hand;
  double sum = 0.0;
  int count = 0;
  const hand::Hand& found = made().scanned.hand;
  for (const Vec3& v : found.skin.vertices) {
    if (v.y() < 0.0) continue;  // the forearm was cut
    sum += query.closest(true_from_found * v)->distance;
    ++count;
  }
  EXPECT_LT(sum / count, 0.25);
}

TEST_F(HandFromScanTest, JointsLieWhereThePersonBends) {
  for (const auto& [posture, scan_from_hand] : made().scan_from_hand) {
    const hand::Skeleton& skeleton = made().scanned.hand.skeleton;
    const hand::PosedSkeleton posed = hand::pose_skeleton(skeleton, made().postures.at(posture));
    const geometry::Rigid3 true_from_found =
        scanned(posture).scan_from_hand.inverse() * scan_from_hand;
    double off = 0.0;
    for (const hand::Segment segment : {hand::Segment::kIndexMiddle, hand::Segment::kMiddleMiddle,
                                        hand::Segment::kRingMiddle, hand::Segment::kLittleMiddle}) {
      const auto& truth = person().postures.at(posture).joint.at(segment);
      const hand::JointDof& found = skeleton.joint(hand::joint_of(segment)).dofs.back();
      const auto proximal = static_cast<std::size_t>(segment) - 1;
      const geometry::Rigid3 by = true_from_found * posed.segment[proximal];
      const double turn =
          std::acos(std::min(1.0, std::abs((by.rotation * found.axis).dot(truth.axis))));
      EXPECT_LT(turn * 180.0 / std::numbers::pi, 5.0) << name_of(segment) << name_of(posture);
      off += (by * found.centre - truth.centre).norm() / 4.0;
    }
    EXPECT_LT(off, 2.0) << name_of(posture);
  }
}

TEST_F(HandFromScanTest, FindsCreasesAndDots) {
  EXPECT_TRUE(made().creases.missing.empty());
  const auto& truth = person().postures.at(hand::ScanPosture::kReference);
  const geometry::Rigid3 scan_from_hand = scanned(hand::ScanPosture::kReference).scan_from_hand;
  const capture::SkinMarks marks = scan(hand::ScanPosture::kReference).marks;
  int found = 0;
  for (const phantom::PaintedDot& dot : truth.dots) {
    for (const capture::InkDot& seen : marks.dots) {
      if ((seen.point - scan_from_hand * dot.point).norm() < 0.5) {
        ++found;
        break;
      }
    }
  }
  EXPECT_GE(found, 0.96 * static_cast<double>(truth.dots.size()));
  EXPECT_LE(marks.dots.size(), truth.dots.size());
}

// A bracelet's edge or a strap's, 12 mm towards the elbow, once took the place of the crease.
TEST_F(HandFromScanTest, OfTwoLinesAtTheWristTheNearerOneIsTaken) {
  const hand::Hand& hand = made().scanned.hand;
  const hand::HandCreases suggested(hand.skin, hand.skeleton);
  const geometry::Rigid3 hand_from_scan = made().scanned.patient_from_hand.inverse();
  const hand::CreasePlane& wrist = suggested.wrist();
  capture::SkinMarks marks = scan(hand::ScanPosture::kReference).marks;
  const capture::FoundCreases one = capture::find_creases(marks, hand_from_scan, suggested);
  ASSERT_TRUE(one.shift.contains(hand::Segment::kPalm));
  EXPECT_TRUE(one.other_wrist.empty());
  const Vec3 away = hand_from_scan.inverse().rotation * (-12.0 * wrist.normal);
  const auto drawn = marks.lines;
  for (capture::InkLine line : drawn) {
    if (std::abs(wrist.value(hand_from_scan * line.point.front())) > 6.0) continue;
    for (Vec3& p : line.point) p += away;
    marks.lines.push_back(line);
  }
  ASSERT_GT(marks.lines.size(), drawn.size());
  const capture::FoundCreases two = capture::find_creases(marks, hand_from_scan, suggested);
  ASSERT_EQ(two.other_wrist.size(), 1U);
  EXPECT_NEAR(two.other_wrist.front(), one.shift.at(hand::Segment::kPalm) - 12.0, 0.5);
  EXPECT_NEAR(two.shift.at(hand::Segment::kPalm), one.shift.at(hand::Segment::kPalm), 0.1);
}

// The line alone, with nothing beside it to choose from: the hand is 11.5 mm too long, as a
// reported one was, and that is said with what its skin, fingers and breadth let one expect.
TEST_F(HandFromScanTest, AStrapTakenForTheWristsCreaseIsDoubted) {
  const auto doubts = [](const capture::HandFromScan& of) {
    return std::count_if(of.notes.begin(), of.notes.end(),
                         [](const std::string& note) { return note.find("Hand length is ") == 0; });
  };
  EXPECT_EQ(doubts(made()), 0);
  const hand::Hand& hand = made().scanned.hand;
  const hand::HandCreases suggested(hand.skin, hand.skeleton);
  const geometry::Rigid3 hand_from_scan = made().scanned.patient_from_hand.inverse();
  const hand::CreasePlane& wrist = suggested.wrist();
  capture::SurfaceScan strap = scan(hand::ScanPosture::kReference);
  const Vec3 away = hand_from_scan.inverse().rotation * (-11.5 * wrist.normal);
  for (capture::InkLine& line : strap.marks.lines) {
    if (std::abs(wrist.value(hand_from_scan * line.point.front())) > 6.0) continue;
    for (Vec3& p : line.point) p += away;
  }
  const capture::HandFromScan longer =
      capture::make_hand_from_scans(this->hand(), {{hand::ScanPosture::kReference, strap}});
  EXPECT_NEAR(longer.scanned.hand.dimensions.hand_length, person().dimensions.hand_length + 11.5,
              1.5);
  EXPECT_EQ(doubts(longer), 1);
}

// Those on the back of a proximal phalanx as well, which lie where the skin still is the palm's.
TEST_F(HandFromScanTest, DotsBelongToTheBoneThatTheyWereDrawnOn) {
  int dots = 0;
  for (const capture::TakenMark& mark : made().marks) {
    if (mark.kind != hand::MarkLabel::Kind::kDot) continue;
    const geometry::Rigid3& scan_from_hand = scanned(mark.posture).scan_from_hand;
    const auto& truth = person().postures.at(mark.posture).dots;
    const auto drawn =
        std::min_element(truth.begin(), truth.end(), [&](const auto& a, const auto& b) {
          return (scan_from_hand * a.point - mark.point).norm() <
                 (scan_from_hand * b.point - mark.point).norm();
        });
    EXPECT_EQ(mark.segment, drawn->segment) << name_of(mark.posture);
    ++dots;
  }
  EXPECT_GE(dots, 96);  // of 100
}

/// A line of ink points across the palmar side of a finger, `off` mm distal of its crease.
capture::InkLine line_at(const hand::HandCreases& creases, hand::Segment segment, double off) {
  const hand::CreasePlane& plane = creases.proximal_crease(segment);
  const hand::Finger finger = *hand::finger_of(segment);
  const auto chain = hand::segments_of(finger);
  const int node =
      static_cast<int>(std::find(chain.begin(), chain.end(), segment) - chain.begin()) +
      (finger == hand::Finger::kThumb ? 2 : 1);
  const Vec3 palmar = creases.palmar_direction(finger, node);
  const Vec3 aside = plane.normal.cross(palmar).normalized();
  const Vec3 out = aside.cross(plane.normal);
  capture::InkLine line;
  for (int k = -6; k <= 6; ++k) {
    line.point.push_back(plane.point + off * plane.normal + 6.0 * out + k * aside);
    line.weight.push_back(1.0);
  }
  return line;
}

// Where the skin alone misjudges a finger by half a phalanx, the order of the lines says which
// crease is which; a line that is nearer to the next crease than to its own was lost before.
TEST_F(HandFromScanTest, CreasesAreRecognisedByTheirOrder) {
  const hand::HandCreases creases(hand().skin, hand().skeleton);
  capture::SkinMarks marks;
  const std::array<std::pair<hand::Segment, double>, 3> drawn{
      {{hand::Segment::kMiddleProximal, 1.0},
       {hand::Segment::kMiddleMiddle, 7.0},
       {hand::Segment::kMiddleDistal, 10.0}}};
  for (const auto& [segment, off] : drawn) marks.lines.push_back(line_at(creases, segment, off));
  capture::FoundCreases found = capture::find_creases(marks, {}, creases);
  for (const auto& [segment, off] : drawn) {
    EXPECT_NEAR(found.shift.at(segment), off, 1e-6) << name_of(segment);
  }
  EXPECT_EQ(found.missing.size(), std::size_t{hand::kSegmentCount - 3});
  // Far off as well: nothing but creases is drawn right across a finger.
  capture::SkinMarks far;
  far.lines = {line_at(creases, hand::Segment::kMiddleProximal, 1.0),
               line_at(creases, hand::Segment::kMiddleMiddle, 13.0),
               line_at(creases, hand::Segment::kMiddleDistal, 11.0)};
  EXPECT_NEAR(capture::find_creases(far, {}, creases).shift.at(hand::Segment::kMiddleMiddle), 13.0,
              1e-6);
  // The whole finger misjudged by more than half a phalanx: three lines are the three creases.
  far.lines = {line_at(creases, hand::Segment::kMiddleProximal, 15.0),
               line_at(creases, hand::Segment::kMiddleMiddle, 15.0),
               line_at(creases, hand::Segment::kMiddleDistal, 15.0)};
  found = capture::find_creases(far, {}, creases);
  EXPECT_NEAR(found.shift.at(hand::Segment::kMiddleProximal), 15.0, 1e-6);
  EXPECT_NEAR(found.shift.at(hand::Segment::kMiddleDistal), 15.0, 1e-6);
  // Somebody who says that the last line is none is believed, and what that person calls it.
  const Vec3 last = marks.lines[2].point[6];
  marks.crease_labels = {{last, {}, "m.csv:2"}};
  EXPECT_FALSE(
      capture::find_creases(marks, {}, creases).plane.contains(hand::Segment::kMiddleDistal));
  marks.crease_labels = {{last, hand::Segment::kRingDistal, "m.csv:2"}};
  EXPECT_TRUE(capture::find_creases(marks, {}, creases).plane.contains(hand::Segment::kRingDistal));
  marks.crease_labels.push_back({last, hand::Segment::kMiddleDistal, "m.csv:3"});
  try {
    capture::find_creases(marks, {}, creases);
    FAIL() << "one line has two names";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("m.csv:3: m.csv:2 gives the same line another name"));
  }
}

TEST_F(HandFromScanTest, KnowsTheOtherSideAndWhatIsNoHand) {
  const auto message = [&](std::map<hand::ScanPosture, capture::SurfaceScan> scans,
                           std::optional<hand::Side> side) {
    try {
      capture::make_hand_from_scans(hand(), scans, side);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message({{kFlexed, scan(kFlexed)}}, {}), HasSubstr("reference posture"));
  EXPECT_THAT(message({{hand::ScanPosture::kReference, scan(hand::ScanPosture::kReference)}},
                      hand::Side::kRight),
              HasSubstr("reference: shows a left hand, not a right one"));
}

}  // namespace
}  // namespace palmar::tests
