// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/hand_from_scan.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/geometry/distance/closest_point.h"
#include "palmar/geometry/mesh/mesh_topology.h"
#include "hands/phantom/mri/scan_defects.h"
#include "hands/phantom/photo/painted_hand.h"
#include "template_fixture.h"

namespace palmar {
namespace {

using ::testing::HasSubstr;

/// A left hand in two postures, scanned with noise and holes, lying anywhere.
class HandFromScanTest : public TemplateTest {
 protected:
  static constexpr ScanPosture kFlexed = ScanPosture::kFingerFlexion;

  static const PaintedHand& person() {
    static const PaintedHand made = [] {
      PaintedHandOptions options;
      options.seed = 21;
      options.side = Side::kLeft;
      options.levels = 1;
      return make_painted_hand(hand(), {ScanPosture::kReference, kFlexed}, options);
    }();
    return made;
  }
  static const ScannedSurface& scanned(ScanPosture posture) {
    static std::map<ScanPosture, ScannedSurface> all;
    if (!all.contains(posture)) {
      ScanDefects defects;
      defects.seed = 5 + static_cast<std::uint64_t>(posture);
      all[posture] = scanned_surface(surface_of(person(), posture), 0.0, defects);
    }
    return all.at(posture);
  }
  static SurfaceScan scan(ScanPosture posture) {
    const ColouredMesh& surface = scanned(posture).surface;
    return {std::string(name_of(posture)), surface.mesh, find_skin_marks(surface, "scan")};
  }
  static const HandFromScan& made() {
    static const HandFromScan result = make_hand_from_scans(
        hand(),
        {{ScanPosture::kReference, scan(ScanPosture::kReference)}, {kFlexed, scan(kFlexed)}});
    return result;
  }
};

TEST_F(HandFromScanTest, MeasuresThePerson) {
  const Hand& found = made().scanned.hand;
  EXPECT_EQ(found.side, Side::kLeft);
  EXPECT_NO_THROW(require_closed_manifold(found.skin, "skin"));
  const HandDimensions &d = found.dimensions, &t = person().dimensions;
  // Asked for: 1.1 mm in length, 1.2 in breadth, 1.0 in thickness, in the mean (Xie
  // 2014, 4.5).
  EXPECT_NEAR(d.hand_length, t.hand_length, 1.0);
  EXPECT_NEAR(d.hand_circumference, t.hand_circumference, 1.0);
  double length = 0.0, width = 0.0, thickness = 0.0;
  for (std::size_t k = 0; k < kSegmentCount; ++k) {
    length += std::abs(d.segment[k].length - t.segment[k].length);
    width += std::abs(d.segment[k].width - t.segment[k].width);
    thickness += std::abs(d.segment[k].thickness - t.segment[k].thickness);
  }
  EXPECT_LT(length / kSegmentCount, 0.5);
  EXPECT_LT(width / kSegmentCount, 0.5);
  EXPECT_LT(thickness / kSegmentCount, 0.5);
}

TEST_F(HandFromScanTest, SkinLiesOnTheTrueSkin) {
  const PaintedPosture& truth = person().postures.at(ScanPosture::kReference);
  const ClosestPointQuery query({truth.skin, person().triangles});
  const Rigid3 true_from_found =
      scanned(ScanPosture::kReference).scan_from_hand.inverse() * made().scanned.patient_from_hand;
  double sum = 0.0;
  int count = 0;
  const Hand& found = made().scanned.hand;
  for (const Vec3& v : found.skin.vertices) {
    if (v.y() < 0.0) continue;  // the forearm was cut
    sum += query.closest(true_from_found * v)->distance;
    ++count;
  }
  EXPECT_LT(sum / count, 0.25);
}

TEST_F(HandFromScanTest, JointsLieWhereThePersonBends) {
  for (const auto& [posture, scan_from_hand] : made().scan_from_hand) {
    const Skeleton& skeleton = made().scanned.hand.skeleton;
    const PosedSkeleton posed = pose_skeleton(skeleton, made().postures.at(posture));
    const Rigid3 true_from_found = scanned(posture).scan_from_hand.inverse() * scan_from_hand;
    double off = 0.0;
    for (const Segment segment : {Segment::kIndexMiddle, Segment::kMiddleMiddle,
                                  Segment::kRingMiddle, Segment::kLittleMiddle}) {
      const auto& truth = person().postures.at(posture).joint.at(segment);
      const JointDof& found = skeleton.joint(joint_of(segment)).dofs.back();
      const auto proximal = static_cast<std::size_t>(segment) - 1;
      const Rigid3 by = true_from_found * posed.segment[proximal];
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
  const auto& truth = person().postures.at(ScanPosture::kReference);
  const Rigid3 scan_from_hand = scanned(ScanPosture::kReference).scan_from_hand;
  const SkinMarks marks = scan(ScanPosture::kReference).marks;
  int found = 0;
  for (const PaintedDot& dot : truth.dots) {
    for (const InkDot& seen : marks.dots) {
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
  const Hand& hand = made().scanned.hand;
  const HandCreases suggested(hand.skin, hand.skeleton);
  const Rigid3 hand_from_scan = made().scanned.patient_from_hand.inverse();
  const CreasePlane& wrist = suggested.wrist();
  SkinMarks marks = scan(ScanPosture::kReference).marks;
  const FoundCreases one = find_creases(marks, hand_from_scan, suggested);
  ASSERT_TRUE(one.shift.contains(Segment::kPalm));
  EXPECT_TRUE(one.other_wrist.empty());
  const Vec3 away = hand_from_scan.inverse().rotation * (-12.0 * wrist.normal);
  const auto drawn = marks.lines;
  for (InkLine line : drawn) {
    if (std::abs(wrist.value(hand_from_scan * line.point.front())) > 6.0) continue;
    for (Vec3& p : line.point) p += away;
    marks.lines.push_back(line);
  }
  ASSERT_GT(marks.lines.size(), drawn.size());
  const FoundCreases two = find_creases(marks, hand_from_scan, suggested);
  ASSERT_EQ(two.other_wrist.size(), 1U);
  EXPECT_NEAR(two.other_wrist.front(), one.shift.at(Segment::kPalm) - 12.0, 0.5);
  EXPECT_NEAR(two.shift.at(Segment::kPalm), one.shift.at(Segment::kPalm), 0.1);
}

// The line alone, with nothing beside it to choose from: the hand is 11.5 mm too long, as a
// reported one was, and that is said with what its skin, fingers and breadth let one expect.
TEST_F(HandFromScanTest, AStrapTakenForTheWristsCreaseIsDoubted) {
  const auto doubts = [](const HandFromScan& of) {
    return std::count_if(of.notes.begin(), of.notes.end(),
                         [](const std::string& note) { return note.find("Hand length is ") == 0; });
  };
  EXPECT_EQ(doubts(made()), 0);
  const Hand& hand = made().scanned.hand;
  const HandCreases suggested(hand.skin, hand.skeleton);
  const Rigid3 hand_from_scan = made().scanned.patient_from_hand.inverse();
  const CreasePlane& wrist = suggested.wrist();
  SurfaceScan strap = scan(ScanPosture::kReference);
  const Vec3 away = hand_from_scan.inverse().rotation * (-11.5 * wrist.normal);
  for (InkLine& line : strap.marks.lines) {
    if (std::abs(wrist.value(hand_from_scan * line.point.front())) > 6.0) continue;
    for (Vec3& p : line.point) p += away;
  }
  const HandFromScan longer =
      make_hand_from_scans(this->hand(), {{ScanPosture::kReference, strap}});
  EXPECT_NEAR(longer.scanned.hand.dimensions.hand_length, person().dimensions.hand_length + 11.5,
              1.5);
  EXPECT_EQ(doubts(longer), 1);
}

// Those on the back of a proximal phalanx as well, which lie where the skin still is the palm's.
TEST_F(HandFromScanTest, DotsBelongToTheBoneThatTheyWereDrawnOn) {
  int dots = 0;
  for (const TakenMark& mark : made().marks) {
    if (mark.kind != MarkLabel::Kind::kDot) continue;
    const Rigid3& scan_from_hand = scanned(mark.posture).scan_from_hand;
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
InkLine line_at(const HandCreases& creases, Segment segment, double off) {
  const CreasePlane& plane = creases.proximal_crease(segment);
  const Finger finger = *finger_of(segment);
  const auto chain = segments_of(finger);
  const int node =
      static_cast<int>(std::find(chain.begin(), chain.end(), segment) - chain.begin()) +
      (finger == Finger::kThumb ? 2 : 1);
  const Vec3 palmar = creases.palmar_direction(finger, node);
  const Vec3 aside = plane.normal.cross(palmar).normalized();
  const Vec3 out = aside.cross(plane.normal);
  InkLine line;
  for (int k = -6; k <= 6; ++k) {
    line.point.push_back(plane.point + off * plane.normal + 6.0 * out + k * aside);
    line.weight.push_back(1.0);
  }
  return line;
}

// Where the skin alone misjudges a finger by half a phalanx, the order of the lines says which
// crease is which; a line that is nearer to the next crease than to its own was lost before.
TEST_F(HandFromScanTest, CreasesAreRecognisedByTheirOrder) {
  const HandCreases creases(hand().skin, hand().skeleton);
  SkinMarks marks;
  const std::array<std::pair<Segment, double>, 3> drawn{{{Segment::kMiddleProximal, 1.0},
                                                         {Segment::kMiddleMiddle, 7.0},
                                                         {Segment::kMiddleDistal, 10.0}}};
  for (const auto& [segment, off] : drawn) marks.lines.push_back(line_at(creases, segment, off));
  FoundCreases found = find_creases(marks, {}, creases);
  for (const auto& [segment, off] : drawn) {
    EXPECT_NEAR(found.shift.at(segment), off, 1e-6) << name_of(segment);
  }
  EXPECT_EQ(found.missing.size(), std::size_t{kSegmentCount - 3});
  // Far off as well: nothing but creases is drawn right across a finger.
  SkinMarks far;
  far.lines = {line_at(creases, Segment::kMiddleProximal, 1.0),
               line_at(creases, Segment::kMiddleMiddle, 13.0),
               line_at(creases, Segment::kMiddleDistal, 11.0)};
  EXPECT_NEAR(find_creases(far, {}, creases).shift.at(Segment::kMiddleMiddle), 13.0, 1e-6);
  // The whole finger misjudged by more than half a phalanx: three lines are the three creases.
  far.lines = {line_at(creases, Segment::kMiddleProximal, 15.0),
               line_at(creases, Segment::kMiddleMiddle, 15.0),
               line_at(creases, Segment::kMiddleDistal, 15.0)};
  found = find_creases(far, {}, creases);
  EXPECT_NEAR(found.shift.at(Segment::kMiddleProximal), 15.0, 1e-6);
  EXPECT_NEAR(found.shift.at(Segment::kMiddleDistal), 15.0, 1e-6);
  // Somebody who says that the last line is none is believed, and what that person calls it.
  const Vec3 last = marks.lines[2].point[6];
  marks.crease_labels = {{last, {}, "m.csv:2"}};
  EXPECT_FALSE(find_creases(marks, {}, creases).plane.contains(Segment::kMiddleDistal));
  marks.crease_labels = {{last, Segment::kRingDistal, "m.csv:2"}};
  EXPECT_TRUE(find_creases(marks, {}, creases).plane.contains(Segment::kRingDistal));
  marks.crease_labels.push_back({last, Segment::kMiddleDistal, "m.csv:3"});
  try {
    find_creases(marks, {}, creases);
    FAIL() << "one line has two names";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("m.csv:3: m.csv:2 gives the same line another name"));
  }
}

TEST_F(HandFromScanTest, KnowsTheOtherSideAndWhatIsNoHand) {
  const auto message = [&](std::map<ScanPosture, SurfaceScan> scans, std::optional<Side> side) {
    try {
      make_hand_from_scans(hand(), scans, side);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_THAT(message({{kFlexed, scan(kFlexed)}}, {}), HasSubstr("reference posture"));
  EXPECT_THAT(message({{ScanPosture::kReference, scan(ScanPosture::kReference)}}, Side::kRight),
              HasSubstr("reference: shows a left hand, not a right one"));
}

}  // namespace
}  // namespace palmar
