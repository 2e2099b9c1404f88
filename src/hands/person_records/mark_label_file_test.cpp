// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_records/mark_label_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::person_records {
namespace {

using ::testing::HasSubstr;
using Kind = hand::MarkLabel::Kind;

std::vector<hand::MarkLabel> labels_in(const std::string& rows) {
  const formats::TestFolder folder;
  formats::write_file(folder / "marks.csv", "posture,mark,name,x_mm,y_mm,z_mm\n" + rows);
  return read_mark_labels((folder / "marks.csv").string());
}

std::string refusal_of_marks(const std::string& rows) {
  return formats::message_of<InputError>([&] { labels_in(rows); });
}

TEST(MarkLabelFile, ReadsNamesRemovalsAndAdditions) {
  const auto labels = labels_in(
      "reference,crease,wrist,1,2,3\nreference,crease,,4,5,6\nfinger_flexion,dot,none,7,8,9\n"
      "reference,added_dot,palm,-1,0.5,2\n");
  ASSERT_EQ(labels.size(), 3U);  // a row without a name says nothing
  EXPECT_EQ(labels[0].kind, Kind::kCrease);
  EXPECT_EQ(labels[0].segment, hand::Segment::kPalm);
  EXPECT_EQ(labels[0].point, Vec3(1, 2, 3));
  EXPECT_EQ(labels[1].posture, hand::ScanPosture::kFingerFlexion);
  EXPECT_FALSE(labels[1].segment);
  EXPECT_THAT(labels[1].place, HasSubstr("marks.csv:4"));
  EXPECT_TRUE(labels[2].is_added);
}

TEST(MarkLabelFile, WritesWhatItReads) {
  const std::vector<capture::TakenMark> marks{
      {hand::ScanPosture::kReference, Kind::kCrease, hand::Segment::kPalm, {1, 2, 3}},
      {hand::ScanPosture::kReference, Kind::kDot, hand::Segment::kPalm, {4, 5, 6}},
      {hand::ScanPosture::kFingerAbduction, Kind::kDot, {}, {7, 8, 9}},
      {hand::ScanPosture::kFingerFlexion, Kind::kDot, hand::Segment::kRingDistal, {-7.25, 8, 9}}};
  const formats::TestFolder folder;
  formats::write_file(folder / "taken.csv", records::format_csv(mark_table(marks)));
  const auto labels = read_mark_labels((folder / "taken.csv").string());
  ASSERT_EQ(labels.size(), 3U);
  EXPECT_EQ(labels[2].segment, hand::Segment::kRingDistal);
  EXPECT_EQ(labels[2].point, marks[3].point);
}

TEST(MarkLabelFile, NamesLineAndWhatIsAllowed) {
  EXPECT_THAT(refusal_of_marks("reference,crease,indx_middle,1,2,3\n"),
              AllOf(HasSubstr("marks.csv:2"), HasSubstr("\"index_middle\"")));
  EXPECT_THAT(refusal_of_marks("reference,crease,palm,1,2,3\n"), HasSubstr("names no crease"));
  EXPECT_THAT(refusal_of_marks("reference,line,wrist,1,2,3\n"), HasSubstr("added_crease"));
  EXPECT_THAT(refusal_of_marks("sideways,dot,palm,1,2,3\n"), HasSubstr("is no posture"));
  EXPECT_THAT(refusal_of_marks("reference,added_dot,none,1,2,3\n"), HasSubstr("must have a name"));
  EXPECT_THAT(refusal_of_marks("reference,dot,palm,1,two,3\n"), HasSubstr("y_mm"));
}

}  // namespace
}  // namespace palmar::person_records
