// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/person/person_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar::records {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PersonFile person_in(const std::string& text) {
  const formats::TestFolder folder;
  formats::write_file(folder / "anna.toml", text);
  return read_person((folder / "anna.toml").string());
}

std::string refusal(const std::string& text) {
  return formats::message_of<InputError>([&] { person_in(text); });
}

TEST(PersonFile, ReadsWhatIsKnown) {
  const PersonFile person = person_in(R"(side = "left"
[scan]
pick_dot = [1, 2.5, -3]
[[mark]]
mark = "crease"
name = "wrist"
at_mm = [4, 5, 6]
[[mark]]  # changes nothing
mark = "dot"
name = ""
at_mm = [0, 0, 0]
[[mark]]
posture = "finger_flexion"
mark = "dot"
name = "none"
at_mm = [7, 8, 9]
[[bone]]
name = "scaphoid"
at_mm = [3, -12.5, 40]
[measured_mm]
hand_length = 181
)");
  EXPECT_EQ(person.side, hand::Side::kLeft);
  EXPECT_FALSE(person.pick_crease);
  ASSERT_TRUE(person.pick_dot);
  EXPECT_EQ(*person.pick_dot, Vec3(1, 2.5, -3));
  ASSERT_EQ(person.marks.size(), 2U);
  EXPECT_EQ(person.marks[0].posture, hand::ScanPosture::kReference);
  EXPECT_EQ(person.marks[0].segment, hand::Segment::kPalm);
  EXPECT_EQ(person.marks[0].point, Vec3(4, 5, 6));
  EXPECT_THAT(person.marks[0].place, HasSubstr("anna.toml:4"));
  EXPECT_EQ(person.marks[1].posture, hand::ScanPosture::kFingerFlexion);
  EXPECT_FALSE(person.marks[1].segment);
  ASSERT_EQ(person.bones.size(), 1U);
  EXPECT_EQ(person.bones[0].name, "scaphoid");
  EXPECT_EQ(person.bones[0].point, Vec3(3, -12.5, 40));
  ASSERT_EQ(person.sizes.size(), 1U);
  EXPECT_EQ(person.sizes[0].dimension.kind, hand::DimensionKind::kHandLength);
  EXPECT_EQ(person.sizes[0].value, 181.0);
}

TEST(PersonFile, AnEmptyOneKnowsNothing) {
  const PersonFile person = person_in("# nothing yet\n");
  EXPECT_FALSE(person.side);
  EXPECT_TRUE(person.marks.empty() && person.bones.empty() && person.sizes.empty());
}

TEST(PersonFile, ABoneWithoutANameChangesNothing) {
  const PersonFile person = person_in("[[bone]]\nname = \"\"\nat_mm = [1, 2, 3]\n");
  EXPECT_TRUE(person.bones.empty());
}

/// Entries alike but for where they were read.
void expect_same(const PersonFile& one, const PersonFile& other) {
  EXPECT_EQ(one.side, other.side);
  EXPECT_EQ(one.pick_crease, other.pick_crease);
  EXPECT_EQ(one.pick_dot, other.pick_dot);
  ASSERT_EQ(one.marks.size(), other.marks.size());
  for (std::size_t k = 0; k < one.marks.size(); ++k) {
    EXPECT_EQ(one.marks[k].posture, other.marks[k].posture) << k;
    EXPECT_EQ(one.marks[k].kind, other.marks[k].kind) << k;
    EXPECT_EQ(one.marks[k].is_added, other.marks[k].is_added) << k;
    EXPECT_EQ(one.marks[k].segment, other.marks[k].segment) << k;
    EXPECT_EQ(one.marks[k].point, other.marks[k].point) << k;
  }
  ASSERT_EQ(one.bones.size(), other.bones.size());
  for (std::size_t k = 0; k < one.bones.size(); ++k) {
    EXPECT_EQ(one.bones[k].name, other.bones[k].name);
    EXPECT_EQ(one.bones[k].point, other.bones[k].point);
  }
  ASSERT_EQ(one.sizes.size(), other.sizes.size());
  for (std::size_t k = 0; k < one.sizes.size(); ++k) {
    EXPECT_EQ(one.sizes[k].dimension, other.sizes[k].dimension);
    EXPECT_EQ(one.sizes[k].value, other.sizes[k].value);
  }
}

TEST(PersonFile, WhatIsWrittenIsReadAgain) {
  using Kind = hand::MarkLabel::Kind;
  PersonFile person;
  person.side = hand::Side::kLeft;
  person.pick_crease = Vec3(1e-7, -0.0, 1e5);
  person.pick_dot = Vec3(1.0 / 3.0, 2, -99999.999999999985);
  // Every posture, both kinds, found and added, and every name.
  for (int p = 0; p < hand::kScanPostureCount; ++p) {
    for (int s = 0; s < hand::kSegmentCount; ++s) {
      for (const Kind kind : {Kind::kCrease, Kind::kDot}) {
        for (const bool is_added : {false, true}) {
          person.marks.push_back({static_cast<hand::ScanPosture>(p),
                                  kind,
                                  is_added,
                                  static_cast<hand::Segment>(s),
                                  Vec3(0.1 * p, -0.7 * s, 5),
                                  {}});
        }
      }
    }
    person.marks.push_back(
        {static_cast<hand::ScanPosture>(p), Kind::kDot, false, {}, Vec3(0.1, 0.2, 0.3), {}});
  }
  for (const char* name : {"scaphoid", "with \"quotes\" and \\", "a\nnew line\ttab",
                           "Kahnbein \xc3\xa4", "\x7f", "# = [[bone]]", " "}) {
    person.bones.push_back({name, Vec3(0.1, 1e-300, 12345.678901234567), {}});
  }
  person.sizes = {{{hand::DimensionKind::kHandCircumference}, 500.0},  // by name
                  {{hand::DimensionKind::kHandLength}, 181.30000000000001},
                  {{hand::DimensionKind::kSegmentWidth, hand::Segment::kThumbDistal}, 1.0}};
  const std::string text = format_person(person);
  expect_same(parse_person(text, "anna.toml"), person);
  EXPECT_EQ(format_person(parse_person(text, "anna.toml")), text);
}

TEST(PersonFile, NothingIsWrittenOfNothing) {
  EXPECT_TRUE(PersonFile{}.is_empty());
  EXPECT_EQ(format_person({}), "");
  PersonFile person;
  person.pick_dot = Vec3(1, 2, 3);
  EXPECT_FALSE(person.is_empty());
  expect_same(parse_person(format_person(person), "a.toml"), person);
}

TEST(PersonFile, AMarkWithoutANameIsWrittenAndChangesNothing) {
  const std::string text = format_person_mark({"reference", "dot", "", Vec3(1, 2, 3), {}}, "17");
  EXPECT_EQ(text,
            "[[mark]]  # 17\nposture = \"reference\"\nmark = \"dot\"\nname = \"\"\n"
            "at_mm = [1.0, 2.0, 3.0]\n");
  EXPECT_TRUE(parse_person(text, "found.toml").is_empty());
}

TEST(PersonFile, WhatIsSaidLaterCounts) {
  const PersonFile known = person_in(
      "side = \"left\"\n[scan]\npick_dot = [1, 2, 3]\n[[bone]]\nname = \"scaphoid\"\n"
      "at_mm = [1, 2, 3]\n[measured_mm]\nhand_length = 181\nhand_width = 80\n");
  PersonFile more;
  expect_same(merged(known, more), known);
  more.side = hand::Side::kRight;
  more.sizes = {{{hand::DimensionKind::kHandLength}, 183.0}};
  more.bones = {{"lunate", Vec3(4, 5, 6), {}}};
  const PersonFile both = merged(known, more);
  EXPECT_EQ(both.side, hand::Side::kRight);
  EXPECT_EQ(*both.pick_dot, Vec3(1, 2, 3));
  ASSERT_EQ(both.bones.size(), 2U);
  EXPECT_EQ(both.bones[1].name, "lunate");
  ASSERT_EQ(both.sizes.size(), 2U);
  EXPECT_EQ(both.sizes[0].dimension.kind, hand::DimensionKind::kHandWidth);
  EXPECT_EQ(both.sizes[1].value, 183.0);
}

TEST(PersonFile, NamesLineAndWhatIsAllowed) {
  EXPECT_THAT(refusal("sied = \"left\"\n"), AllOf(HasSubstr("anna.toml:1"), HasSubstr("side")));
  EXPECT_THAT(refusal("side = \"both\"\n"), HasSubstr("right or left"));
  EXPECT_THAT(refusal("[[mark]]\nmark = \"dot\"\nname = \"palm\"\n"), HasSubstr("at_mm"));
  EXPECT_THAT(refusal("[[mark]]\nmark = \"dot\"\nname = \"palm\"\nat_mm = [1, 2]\n"),
              HasSubstr("three are required"));
  EXPECT_THAT(refusal("[[mark]]\nmark = \"dot\"\nname = \"indx_middle\"\nat_mm = [1, 2, 3]\n"),
              HasSubstr("\"index_middle\""));
  EXPECT_THAT(refusal("[[mark]]\nmark = \"line\"\nname = \"wrist\"\nat_mm = [1, 2, 3]\n"),
              HasSubstr("added_crease"));
  EXPECT_THAT(refusal("[measured_mm]\nhand_lenght = 181\n"), HasSubstr("\"hand_length\""));
  EXPECT_THAT(refusal("[measured_mm]\nhand_length = 1810\n"), HasSubstr("500"));
  EXPECT_THAT(refusal("side = \n"), HasSubstr("no TOML"));
}

}  // namespace
}  // namespace palmar::records
