// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/scan/mark_labels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::capture {
namespace {

using ::testing::HasSubstr;
using Kind = hand::MarkLabel::Kind;

/// Two dots 10 mm apart and a line.
SkinMarks found() {
  SkinMarks marks;
  marks.dots = {{{0, 0, 0}, 7.0, {}}, {{10, 0, 0}, 7.0, {}}};
  InkLine line;
  line.point = {{0, 50, 0}, {10, 50, 0}};
  line.weight = {1.0, 1.0};
  marks.lines.push_back(line);
  return marks;
}

hand::MarkLabel label(Kind kind, const Vec3& point, std::optional<hand::Segment> segment, int line,
                      bool is_added = false) {
  return {hand::ScanPosture::kReference,  kind, is_added, segment, point,
          "m.csv:" + std::to_string(line)};
}

SkinMarks labelled(const std::vector<hand::MarkLabel>& labels) {
  SkinMarks marks = found();
  std::map<hand::ScanPosture, SkinMarks*> scans{{hand::ScanPosture::kReference, &marks}};
  apply_mark_labels(labels, scans);
  return marks;
}

std::string refusal(const std::vector<hand::MarkLabel>& labels) {
  try {
    labelled(labels);
  } catch (const InputError& error) {
    return error.what();
  }
  return "none";
}

TEST(MarkLabels, NameTakeAwayAndAddDots) {
  const SkinMarks marks = labelled({label(Kind::kDot, {1, 0, 0}, hand::Segment::kRingMiddle, 2),
                                    label(Kind::kDot, {10, 2, 0}, {}, 3),
                                    label(Kind::kDot, {30, 0, 0}, hand::Segment::kPalm, 4, true)});
  ASSERT_EQ(marks.dots.size(), 2U);
  EXPECT_EQ(marks.dots[0].point, Vec3(0, 0, 0));
  EXPECT_EQ(marks.dots[0].segment, hand::Segment::kRingMiddle);
  EXPECT_EQ(marks.dots[1].point, Vec3(30, 0, 0));
  EXPECT_EQ(marks.dots[1].segment, hand::Segment::kPalm);
}

TEST(MarkLabels, NameAndAddCreases) {
  const SkinMarks marks =
      labelled({label(Kind::kCrease, {2, 50, 0}, {}, 2),
                label(Kind::kCrease, {0, 80, 0}, hand::Segment::kIndexMiddle, 3, true),
                label(Kind::kCrease, {9, 80, 0}, hand::Segment::kIndexMiddle, 4, true)});
  ASSERT_EQ(marks.crease_labels.size(), 1U);
  EXPECT_FALSE(marks.crease_labels[0].crease);
  ASSERT_EQ(marks.added_lines.size(), 1U);
  EXPECT_EQ(marks.added_lines[0].crease, hand::Segment::kIndexMiddle);
  EXPECT_EQ(marks.added_lines[0].point.size(), 2U);
}

TEST(MarkLabels, NameTheLineThatCannotBe) {
  const auto palm = hand::Segment::kPalm;
  EXPECT_THAT(refusal({label(Kind::kDot, {5, 0, 0}, palm, 7)}),
              AllOf(HasSubstr("m.csv:7: no dot within 3 mm"), HasSubstr("5.0 mm away")));
  EXPECT_THAT(
      refusal({label(Kind::kDot, {0, 1, 0}, palm, 2), label(Kind::kDot, {0, 2, 0}, palm, 5)}),
      AllOf(HasSubstr("m.csv:5"), HasSubstr("named in m.csv:2")));
  EXPECT_THAT(refusal({label(Kind::kCrease, {0, 60, 0}, palm, 2)}), HasSubstr("10.0 mm away"));
  EXPECT_THAT(refusal({label(Kind::kCrease, {0, 80, 0}, palm, 2, true)}),
              AllOf(HasSubstr("wrist"), HasSubstr("5 mm or more apart")));
  hand::MarkLabel other = label(Kind::kDot, {0, 0, 0}, palm, 9);
  other.posture = hand::ScanPosture::kFingerFlexion;
  EXPECT_THAT(refusal({other}), HasSubstr("m.csv:9: no scan shows the posture finger_flexion"));
}

}  // namespace
}  // namespace palmar::capture
