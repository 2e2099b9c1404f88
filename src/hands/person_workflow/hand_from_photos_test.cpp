// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/hand_from_photos.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hands/person_workflow/steps/photo_steps.h"
#include "palmar/core/error.h"
#include "palmar/formats/test_files.h"

// Requests that are refused; photographs and what is made of them are tested with the whole
// program.

namespace palmar::person_workflow {
namespace {

using ::testing::HasSubstr;

TEST(HandFromPhotosRequest, NamesTheSettingItsValueAndWhatIsAllowed) {
  HandFromPhotosRequest request;
  request.hand.out = "anna.hand.glb";
  const auto refusal = [&] { return formats::message_of<UsageError>([&] { request.check(); }); };
  EXPECT_THAT(refusal(), HasSubstr("setting \"folders\""));
  request.folders = {"anna"};
  EXPECT_EQ(refusal(), "");
  request.mesh.model.pixel = -2.0;
  EXPECT_THAT(refusal(), HasSubstr("-2"));
}

TEST(PhotoMeshRequest, NamesTheSettingItsValueAndWhatIsAllowed) {
  PhotoMeshRequest request;
  request.out = "hand.stl";
  const auto refusal = [&] { return formats::message_of<UsageError>([&] { request.check(); }); };
  EXPECT_THAT(refusal(), HasSubstr("setting \"folder\""));
  request.folder = "photos";
  EXPECT_EQ(refusal(), "hand.stl: the mesh is written as .ply, with colours");
  request.out = "hand.ply";
  EXPECT_EQ(refusal(), "");
}

TEST(MakeMeshFromPhotos, AFolderThatIsNotThereIsNamed) {
  const formats::TestFolder folder;
  PhotoMeshRequest request;
  request.folder = "nowhere/photos";
  request.out = (folder / "hand.ply").string();
  EXPECT_THAT(formats::message_of<InputError>([&] { make_mesh_from_photos(request); }),
              HasSubstr("nowhere/photos"));
}

TEST(DrawPhotoBoard, WritesOnlySvg) {
  EXPECT_EQ(formats::message_of<UsageError>([] {
              draw_photo_board({"board.png", {}});
            }),
            "board.png: the board is written as .svg");
}

TEST(PhotoMeshReport, ReadsOnlyWhatIsOfTheSameKeyAndMesh) {
  capture::PhotoModel model;
  model.measured_share = 0.75;
  PosedPhotographs work;
  work.warnings = {"dark"};
  const PhotoMeshReport report = photo_mesh_report(work, model, 3.0, "key", "mesh");
  const auto read = read_photo_mesh_report(report.json, "key", "mesh");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->json, report.json);
  EXPECT_EQ(read->measured_share, 0.75);
  EXPECT_EQ(read->warnings, work.warnings);
  EXPECT_FALSE(read_photo_mesh_report(report.json, "other key", "mesh"));
  EXPECT_FALSE(read_photo_mesh_report(report.json, "key", "other mesh"));
  EXPECT_FALSE(read_photo_mesh_report("{\"key\": 3", "key", "mesh"));
}

}  // namespace
}  // namespace palmar::person_workflow
