// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/posture/posture_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/geometry/degrees.h"
#include "palmar/records/posture/posture_report.h"

namespace palmar::records {
namespace {

using ::testing::HasSubstr;

/// Every range -30 to 90 degrees, reference 5 degrees.
hand::Skeleton plain_skeleton() {
  hand::Skeleton skeleton;
  for (int j = 0; j < hand::kJointCount; ++j) {
    skeleton.joints[j].id = static_cast<hand::JointId>(j);
  }
  for (int d = 0; d < hand::kDofCount; ++d) {
    hand::JointDof dof;
    dof.dof = static_cast<hand::Dof>(d);
    dof.reference = 5 * geometry::kDegree;
    dof.lower = -30 * geometry::kDegree;
    dof.upper = 90 * geometry::kDegree;
    skeleton.joints[d % hand::kJointCount].dofs.push_back(dof);
  }
  return skeleton;
}

class PostureFileTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        std::filesystem::temp_directory_path() / ("palmar_posture_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  PostureFile read(const std::string& text, const std::string& name = "angles.json") {
    const std::string path = (folder_ / name).string();
    formats::write_file(path, text);
    return read_postures(path, skeleton_);
  }
  std::string message(const std::string& text) {
    try {
      read(text);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::filesystem::path folder_;
  hand::Skeleton skeleton_ = plain_skeleton();
};

TEST_F(PostureFileTest, AnObjectOfAnglesInDegreesOrRadians) {
  const PostureFile file =
      read(R"({"index_mcp_flexion_deg": 40, "thumb_ip_flexion_rad": 0.5, "time_s": 2.5})");
  ASSERT_EQ(file.frames.size(), 1U);
  const PostureFrame& frame = file.frames.front();
  EXPECT_NEAR(frame.posture[hand::Dof::kIndexMcpFlexion], 40 * geometry::kDegree, 1e-15);
  EXPECT_EQ(frame.posture[hand::Dof::kThumbIpFlexion], 0.5);
  EXPECT_EQ(frame.posture[hand::Dof::kRingDipFlexion],
            5 * geometry::kDegree);  // not given: reference
  EXPECT_EQ(frame.missing.size(), 21U);
  EXPECT_TRUE(frame.clamped.empty());
  EXPECT_EQ(frame.time, 2.5);
}

TEST_F(PostureFileTest, AnglesBeyondTheRangeAreClampedAndReported) {
  const PostureFrame frame =
      read(R"({"index_pip_flexion_deg": 120, "index_dip_flexion_deg": 90})").frames.front();
  ASSERT_EQ(frame.clamped.size(), 1U);  // 90 degrees is the limit itself
  EXPECT_EQ(frame.clamped[0].dof, hand::Dof::kIndexPipFlexion);
  EXPECT_NEAR(frame.clamped[0].asked, 120 * geometry::kDegree, 1e-12);
  EXPECT_NEAR(frame.clamped[0].used, 90 * geometry::kDegree, 1e-12);
}

TEST_F(PostureFileTest, GraspsAssessmentsAndListsAreTakenApart) {
  const PostureFrame grasp = read(R"({"status": "held", "grip": "tripod",
      "posture": {"index_pip_flexion_deg": 10},
      "product_from_hand": {"quaternion_wxyz": [0.6, 0, 0.8, 0], "translation_mm": [1, 2, 3],
                            "matrix_rows_mm": []}})")
                                 .frames.front();
  EXPECT_EQ(grasp.grip, grasp::Grip::kTripod);
  ASSERT_TRUE(grasp.product_from_hand);
  EXPECT_EQ(grasp.product_from_hand->translation, Vec3(1, 2, 3));
  EXPECT_EQ(grasp.product_from_hand->rotation.y(), 0.8);
  const PostureFile set = read(R"({"assessments": [
      {"grasp": {"posture": {"index_pip_flexion_deg": 10}}},
      {"grasp": {"posture": {"index_pip_flexion_deg": 20}}}]})");
  ASSERT_EQ(set.frames.size(), 2U);
  EXPECT_EQ(set.frames[1].name, "assessment 2");
  EXPECT_NEAR(set.frames[1].posture[hand::Dof::kIndexPipFlexion], 20 * geometry::kDegree, 1e-15);
  EXPECT_THROW(frame_of(set, "x", {}), InputError);
  EXPECT_THROW(frame_of(set, "x", 3), UsageError);
  EXPECT_EQ(&frame_of(set, "x", 2), &set.frames[1]);
  EXPECT_EQ(read(R"([{"index_pip_flexion_deg": 1}, {"index_pip_flexion_deg": 2}])").frames.size(),
            2U);
}

TEST_F(PostureFileTest, AMatrixStandsForAPlacement) {
  const PostureFrame frame = read(R"({"posture": {"index_pip_flexion_deg": 10},
      "product_from_hand": {"matrix_rows_mm": [[0,-1,0,4],[1,0,0,5],[0,0,1,6],[0,0,0,1]]}})")
                                 .frames.front();
  EXPECT_LT((*frame.product_from_hand * Vec3(1, 0, 0) - Vec3(4, 6, 6)).norm(), 1e-12);
}

TEST_F(PostureFileTest, OneRowPerFrameInCsv) {
  const PostureFile file = read(
      "# a comment\nframe,time_s,index_pip_flexion_deg,thumb_ip_flexion_rad\n"
      "1,0.00,10,0.1\n2,0.01,,0.2\n");
  ASSERT_EQ(file.frames.size(), 2U);
  EXPECT_EQ(file.frames[1].time, 0.01);
  EXPECT_NEAR(file.frames[0].posture[hand::Dof::kIndexPipFlexion], 10 * geometry::kDegree, 1e-15);
  EXPECT_EQ(file.frames[1].posture[hand::Dof::kIndexPipFlexion],
            5 * geometry::kDegree);  // an empty cell
  EXPECT_EQ(file.frames[1].missing.size(), 22U);
}

TEST_F(PostureFileTest, WhatIsWrittenReadsBack) {
  PostureReport report{.hand = "h", .source = "s", .labels = {}, .postures = {}};
  for (int f = 0; f < 3; ++f) {
    FoundPosture found;
    found.number = f + 1;
    found.frame.time = 0.1 * f;
    for (int d = 0; d < hand::kDofCount; ++d) found.frame.posture.angle[d] = 0.01 * d * (f + 1);
    report.postures.push_back(found);
  }
  for (const std::string& text : {posture_report_json(report), posture_report_csv(report)}) {
    const PostureFile file = read(text);
    ASSERT_EQ(file.frames.size(), 3U);
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_EQ(file.frames[f].time, report.postures[f].frame.time);
      EXPECT_TRUE(file.frames[f].missing.empty());
      for (std::size_t d = 0; d < hand::kDofCount; ++d) {
        EXPECT_NEAR(file.frames[f].posture.angle[d], report.postures[f].frame.posture.angle[d],
                    1e-15);
      }
    }
  }
  report.postures.resize(1);
  EXPECT_EQ(read(posture_report_json(report)).frames.size(), 1U);
}

TEST_F(PostureFileTest, MistakesAreNamed) {
  EXPECT_THAT(message(R"({"index_pip_flexon_deg": 4})"),
              HasSubstr("did you mean index_pip_flexion_deg?"));
  EXPECT_THAT(message(R"({"index_pip_flexion": 4})"), HasSubstr("index_pip_flexion_deg or"));
  EXPECT_THAT(message(R"({"index_pip_flexion_deg": 4, "index_pip_flexion_rad": 0.1})"),
              HasSubstr("given twice"));
  EXPECT_THAT(message(R"({"index_pip_flexion_rad": 40})"), HasSubstr("is it in degrees"));
  EXPECT_THAT(message(R"({"index_pip_flexion_deg": "40"})"), HasSubstr("a number is needed"));
  EXPECT_THAT(message(R"({"posture": {}})"), HasSubstr("no joint angle"));
  EXPECT_THAT(message("{}"), HasSubstr("no joint angle"));
  EXPECT_THAT(message("{\"index_pip_flexion_deg\": "), HasSubstr("no valid JSON"));
  EXPECT_THAT(message(R"({"frames": []})"), HasSubstr("at least one"));
  EXPECT_THAT(message("index_pip_flexion_deg\nforty\n"), HasSubstr("angles.json:2"));
  EXPECT_THAT(message("index_pip_flexion_deg\n"), HasSubstr("no angles below the header"));
  EXPECT_THAT(message("index_pip_deg\n1\n"), HasSubstr("angles.json:1: column"));
  EXPECT_THAT(message("index_pip_flexion_deg,ring_pip_flexion_deg\n1\n"), HasSubstr("has 1 cells"));
  EXPECT_THAT(message("index_pip_flexion_deg;index_pip_flexion_deg\n1;2\n"),
              HasSubstr("are both called"));
  EXPECT_THAT(message(std::string("\x01\x02\x00\x03", 4)), HasSubstr("no text"));
  EXPECT_THAT(message(R"({"posture": {"index_pip_flexion_deg": 1}, "product_from_hand":
      {"quaternion_wxyz": [1, 1, 0, 0], "translation_mm": [0, 0, 0]}})"),
              HasSubstr("has length 1.414"));
  EXPECT_THAT(message(R"({"posture": {"index_pip_flexion_deg": 1}, "product_from_hand":
      {"matrix_rows_mm": [[-1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]}})"),
              HasSubstr("mirroring"));
}

}  // namespace
}  // namespace palmar::records
