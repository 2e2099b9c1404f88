// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/capture/person_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"

namespace palmar {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

PersonFile person_in(const std::string& text) {
  const TestFolder folder;
  write_file(folder / "anna.toml", text);
  return read_person((folder / "anna.toml").string());
}

std::string refusal(const std::string& text) {
  return message_of<InputError>([&] { person_in(text); });
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
  EXPECT_EQ(person.side, Side::kLeft);
  EXPECT_FALSE(person.pick_crease);
  ASSERT_TRUE(person.pick_dot);
  EXPECT_EQ(*person.pick_dot, Vec3(1, 2.5, -3));
  ASSERT_EQ(person.marks.size(), 2U);
  EXPECT_EQ(person.marks[0].posture, ScanPosture::kReference);
  EXPECT_EQ(person.marks[0].segment, Segment::kPalm);
  EXPECT_EQ(person.marks[0].point, Vec3(4, 5, 6));
  EXPECT_THAT(person.marks[0].place, HasSubstr("anna.toml:4"));
  EXPECT_EQ(person.marks[1].posture, ScanPosture::kFingerFlexion);
  EXPECT_FALSE(person.marks[1].segment);
  ASSERT_EQ(person.bones.size(), 1U);
  EXPECT_EQ(person.bones[0].name, "scaphoid");
  EXPECT_EQ(person.bones[0].point, Vec3(3, -12.5, 40));
  ASSERT_EQ(person.sizes.size(), 1U);
  EXPECT_EQ(person.sizes[0].dimension.kind, DimensionKind::kHandLength);
  EXPECT_EQ(person.sizes[0].value, 181.0);
}

TEST(PersonFile, AnEmptyOneKnowsNothing) {
  const PersonFile person = person_in("# nothing yet\n");
  EXPECT_FALSE(person.side);
  EXPECT_TRUE(person.marks.empty() && person.bones.empty() && person.sizes.empty());
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
}  // namespace palmar
