// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/marker_set_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "palmar/core/error.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

TEST(MarkerSetFile, LabelsAreMatchedWithoutSubjectAndCase) {
  hand::MarkerSet set;
  for (const char* label : {"index_nail", "thumb_nail", "ring_nail", "little_nail", "lost"}) {
    set.label.emplace_back(label);
    set.point.emplace_back();
  }
  formats::MarkerRecording recording;
  recording.labels = {"Anna:Thumb_Nail", "extra", "index_nail", "Anna:ring_nail", "LITTLE_NAIL"};
  recording.frames.push_back({1, {}, {}});
  for (int i = 0; i < 5; ++i) recording.frames[0].position.emplace_back(Vec3(i, 0, 0));
  const MatchedMarkers matched = match_markers(set, recording, "take.c3d");
  ASSERT_EQ(matched.set.label.size(), 4U);
  EXPECT_EQ(matched.frames[0][0]->x(), 2.0);  // index
  EXPECT_EQ(matched.frames[0][1]->x(), 0.0);  // thumb
  ASSERT_EQ(matched.notes.size(), 2U);
  EXPECT_THAT(matched.notes[0], HasSubstr("lost"));
  EXPECT_THAT(matched.notes[1], HasSubstr("extra"));
  recording.labels = {"p1", "p2", "p3", "p4", "p5"};
  try {
    match_markers(set, recording, "take.c3d");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("take.c3d: 0 of the marker set's 5 labels"));
    EXPECT_THAT(error.what(), HasSubstr("p1, p2"));
  }
}

}  // namespace
}  // namespace palmar::records
