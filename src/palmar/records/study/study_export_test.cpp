// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_export.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/records/study/study_store_fixture.h"

namespace palmar::records {
namespace {

using study_fixture::make_store;
using study_fixture::small_study;
using study_fixture::Study;
using ::testing::HasSubstr;

TEST(StudyStore, ExportsEveryTableWithUnits) {
  const formats::TestFolder folder;
  const Study study = small_study();
  make_store(folder / "a.palmar", study, study::tasks_of(study.plan));
  const auto files = export_study(StudyStore(folder / "a.palmar"), folder / "tables", true);
  EXPECT_EQ(files.size(), 11U);
  const std::string grasps = formats::read_file(folder / "tables/grasps.csv");
  EXPECT_THAT(grasps, HasSubstr("grip_force_n,force_n,contact_area_mm2,peak_pressure_mpa"));
  EXPECT_EQ(std::count(grasps.begin(), grasps.end(), '\n'), 21);
  EXPECT_THAT(grasps, HasSubstr("\n5,1,given,person 1,none,default,cylinder,tripod,failed,\"no, "
                                "\"\"reason\"\"\",medium_wrap,0,0,"));
  EXPECT_THAT(
      grasps,
      HasSubstr("demand_nail_room_mm,solver_fallbacks,part,part_name,part_kind,along,toward,"
                "turn_deg,hold\n"));
  EXPECT_THAT(grasps, HasSubstr(",2,handle,loop,"));
  EXPECT_THAT(grasps, HasSubstr("\"medium wrap of the \"\"handle\"\"\"\n"));
  EXPECT_THAT(formats::read_file(folder / "tables/hands.csv"),
              HasSubstr("hand,population,label,stratum,sex,age_years,grip_strength_n,"
                        "hand_length_mm\n0,given,person 0,,male,,,180\n"));
  EXPECT_THAT(formats::read_file(folder / "tables/postures.csv"), HasSubstr("_deg,"));
}

}  // namespace
}  // namespace palmar::records
