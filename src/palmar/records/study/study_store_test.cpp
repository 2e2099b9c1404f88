// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/records/study/study_store_fixture.h"

namespace palmar::records {
namespace {

namespace fs = std::filesystem;
using study_fixture::expect_same;
using study_fixture::fill;
using study_fixture::make_store;
using study_fixture::record_for;
using study_fixture::small_study;
using study_fixture::Study;
using ::testing::HasSubstr;

TEST(StudyStore, KeepsTheFacesOfProducts) {
  const formats::TestFolder folder;
  const fs::path path = folder / "faces.palmar";
  Study study = small_study();
  auto faces = std::make_shared<product::ProductFaces>();
  product::ProductFace fillet, plane;
  fillet.number = 1;
  fillet.kind = product::FaceKind::kCylinder;
  fillet.radius = 10.0 / 3.0;
  fillet.is_fillet = true;
  fillet.area = 31.0;
  plane.number = 2;
  plane.name = "Griff, \"außen\"";
  plane.part = "drill / handle";
  faces->face = {fillet, plane};
  faces->edge.push_back({});
  faces->edge[0].number = 1;
  faces->edge[0].faces = {0, 1};
  faces->edge[0].points = {{0, 0, 0}, {0, 31.0 / 3.0, 0}};
  faces->face_of_triangle = {0, 1, 1, 0};
  study.inputs.products[1].faces = faces;
  StudyStore::create(path, study.plan, study.inputs);
  EXPECT_EQ(formats::read_file(path)[63], 2);
  const auto has_faces = [&](const fs::path& store) {
    const study::StudyInputs inputs = StudyStore(store).inputs();
    const product::ProductFaces& kept = *inputs.products.at(1).faces;
    EXPECT_EQ(kept.face.size(), 2U);
    EXPECT_EQ(kept.face_of_triangle, faces->face_of_triangle);
    EXPECT_EQ(title_of(kept.face[0]), "face 1 (fillet r 3.33)");
    EXPECT_EQ(kept.face[0].radius, 10.0 / 3.0);
    EXPECT_EQ(title_of(kept.face[1]), title_of(plane));
    EXPECT_EQ(kept.face[1].part, "drill / handle");
    EXPECT_EQ(kept.edge.at(0).points.at(1).y(), 31.0 / 3.0);
    // What Palmar makes brings its own.
    EXPECT_EQ(inputs.products.at(0).faces->face.at(0).name, "side");
  };
  has_faces(path);
  {
    StudyStore store(path, StudyAccess::kWrite);
    for (const std::int64_t number : store.missing()) store.keep(record_for(number));
    store.finish();
  }
  has_faces(path);
  EXPECT_EQ(formats::read_file(path)[63], 2);
  merge_studies({path}, folder / "merged.palmar");
  has_faces(folder / "merged.palmar");
}

TEST(StudyStore, GivesBackWhatItWasGiven) {
  const formats::TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  fill(path, {3, 0, 17});
  const StudyStore store(path);
  EXPECT_EQ(store.done(), (std::vector<std::int64_t>{0, 3, 17}));
  EXPECT_EQ(store.missing().size(), 17U);
  EXPECT_FALSE(store.is_finished());
  std::vector<std::int64_t> seen;
  store.for_each(true, [&](const study::StudyRecord& record) {
    seen.push_back(record.number);
    expect_same(record, record_for(record.number));
    EXPECT_EQ(record.seconds, record_for(record.number).seconds);
  });
  EXPECT_EQ(seen, (std::vector<std::int64_t>{0, 3, 17}));
  store.for_each(false, [](const study::StudyRecord& record) {
    EXPECT_TRUE(record.skin_pressure.vertex.empty());
    EXPECT_EQ(record.force, record_for(record.number).force);
  });
  expect_same(store.record(17), record_for(17));
  EXPECT_THAT(formats::message_of<UsageError>([&] { store.record(4); }),
              HasSubstr("grasp 4 is not in it"));
  EXPECT_EQ(format_plan(store.plan()), format_plan(study.plan));
  const study::StudyInputs inputs = store.inputs();
  EXPECT_EQ(format_plan(store.plan()), format_plan(study.plan));
  EXPECT_EQ(content_hash(*inputs.base), study.plan.hand_hash);
  EXPECT_EQ(inputs.products[1].mesh.vertices, study.inputs.products[1].mesh.vertices);
  // The cylinder is made again and so keeps its exact distance; radius 17.5 mm.
  EXPECT_DOUBLE_EQ(inputs.products[0].distance->at(Vec3(10, 0, 0)).distance, -7.5);
}

TEST(StudyStore, FinishedFilesHaveTheSameBytesWhateverTheOrder) {
  const formats::TestFolder folder;
  const Study study = small_study();
  std::vector<std::int64_t> order = study::tasks_of(study.plan);
  make_store(folder / "a.palmar", study, order);
  std::reverse(order.begin(), order.end());
  make_store(folder / "b.palmar", study, order);
  const std::string bytes = formats::read_file(folder / "a.palmar");
  EXPECT_EQ(bytes, formats::read_file(folder / "b.palmar"));
  const StudyStore store(folder / "a.palmar");
  EXPECT_TRUE(store.is_finished());
  EXPECT_EQ(store.digest().size(), 64U);
  EXPECT_TRUE(store.missing().empty());
  expect_same(store.record(19), record_for(19));
  // Looking at it or opening it to go on changes nothing, and nothing is left beside it.
  StudyStore(folder / "b.palmar", StudyAccess::kWrite).finish();
  EXPECT_EQ(bytes, formats::read_file(folder / "b.palmar"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

TEST(StudyStore, AnyOtherResultHasAnotherDigest) {
  const formats::TestFolder folder;
  const Study study = small_study();
  make_store(folder / "a.palmar", study, study::tasks_of(study.plan));
  StudyStore::create(folder / "b.palmar", study.plan, study.inputs);
  {
    StudyStore store(folder / "b.palmar", StudyAccess::kWrite);
    for (const std::int64_t number : study::tasks_of(study.plan)) {
      study::StudyRecord record = record_for(number);
      if (number == 6) record.skin_pressure.value[3] += 1e-6F;
      store.keep(record);
    }
    store.finish();
  }
  EXPECT_NE(StudyStore(folder / "a.palmar").digest(), StudyStore(folder / "b.palmar").digest());
}

TEST(StudyStore, MergedShardsHaveTheBytesOfOneRun) {
  const formats::TestFolder folder;
  const Study study = small_study();
  make_store(folder / "whole.palmar", study, study::tasks_of(study.plan));
  std::vector<fs::path> shards;
  for (int k = 1; k <= 3; ++k) {
    shards.push_back(folder / ("shard" + std::to_string(k)));
    make_store(shards.back(), study, study::tasks_of(study.plan, {k, 3}), {k, 3});
  }
  std::swap(shards[0], shards[2]);
  merge_studies(shards, folder / "merged.palmar");
  EXPECT_EQ(formats::read_file(folder / "whole.palmar"),
            formats::read_file(folder / "merged.palmar"));

  const fs::path out = folder / "out.palmar";
  const auto refused = [&](const std::vector<fs::path>& paths) {
    return formats::message_of<UsageError>([&] { merge_studies(paths, out); });
  };
  EXPECT_THAT(refused({shards[0], shards[2]}), HasSubstr("missing 2/3 of the study \"small\""));
  EXPECT_THAT(refused({shards[0], shards[1], shards[2], shards[1]}),
              HasSubstr("are both shard 2/3"));
  make_store(folder / "shard-of-2", study, study::tasks_of(study.plan, {1, 2}), {1, 2});
  EXPECT_THAT(refused({shards[2], folder / "shard-of-2"}), HasSubstr("is shard 1/2"));
  Study other = study;
  other.plan.settings[0].friction = 0.3;
  make_store(folder / "other", other, study::tasks_of(other.plan, {2, 3}), {2, 3});
  EXPECT_THAT(refused({shards[2], folder / "other", shards[0]}),
              HasSubstr("is of another study than"));
  EXPECT_THAT(refused({shards[2], folder / "other", shards[0]}),
              HasSubstr("setting \"default\": friction was 0.5, now 0.3"));
  StudyStore::create(folder / "begun", study.plan, study.inputs, {2, 3});
  EXPECT_THAT(refused({shards[0], folder / "begun", shards[2]}),
              HasSubstr("is not finished (8 grasps are missing)"));
  EXPECT_FALSE(fs::exists(out));
  EXPECT_THAT(
      formats::message_of<OutputError>([&] { merge_studies(shards, folder / "merged.palmar"); }),
      HasSubstr("is there already"));
}

}  // namespace
}  // namespace palmar::records
