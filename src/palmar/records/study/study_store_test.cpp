// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/study/study_store.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/hand/skin/thumb_cmc.h"
#include "palmar/records/product/made_product.h"
#include "palmar/records/study/study_export.h"
#include "palmar/records/study/study_plan_json.h"

namespace palmar {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

TriangleMesh tetrahedron(double size) {
  return {{{0, 0, 0}, {size, 0, 0.1}, {0, size / 3, 0}, {0, 0, size}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

/// No hand that could hold anything: the store doesn't look at it.
Hand stored_hand() {
  Hand hand;
  hand.name = "stored";
  hand.skin = tetrahedron(50.0 / 7);
  hand.segment.assign(4, Segment::kPalm);
  hand.region.assign(4, Region::kThenar);
  for (int j = 0; j < kJointCount; ++j) {
    hand.skeleton.joints[j] = {static_cast<JointId>(j), Vec3(j, 1, 2), {}};
  }
  for (int d = 0; d < kDofCount; ++d) {
    JointDof dof;
    dof.dof = static_cast<Dof>(d);
    dof.axis = Vec3(1, d / 7.0, 0).normalized();
    dof.lower = -1;
    dof.upper = 3;
    hand.skeleton.joints[d % kJointCount].dofs.push_back(dof);
  }
  hand.skeleton.fingertips.fill(Vec3(8, 180, 1.0 / 3));
  hand.skeleton.thumb_cmc = make_cmc_limits(make_cmc_joint({28, 36, 19}, {45, 59, 34}));
  hand.weights = {{JointId::kWrist, {0, 2}, {0.1, 1}, {1.0 / 3, 1}, {}}};
  hand.tissue = default_tissue();
  return hand;
}

struct Study {
  StudyPlan plan;
  StudyInputs inputs;
};

/// 5 hands x 2 products x 2 grips.
Study small_study() {
  Study study;
  StudyPlan& plan = study.plan;
  plan.name = "small";
  plan.title = "Small \"study\", äöü";
  plan.seed = 7;
  plan.populations.push_back({});
  plan.populations[0].population.name = "given";
  plan.profiles.push_back({});
  for (int h = 0; h < 5; ++h) {
    StudyHand hand;
    hand.sample.label = "person " + std::to_string(h);
    hand.sample.sex = h % 2 == 0 ? Sex::kMale : Sex::kFemale;
    hand.sample.dimensions = {{*hand_dimension_named("hand_length"), 180.0 + h / 3.0}};
    plan.hands.push_back(hand);
  }
  const MadeProduct made{"cylinder", {{"diameter_mm", 35.0}, {"length_mm", 20.0}}};
  StudyProduct cylinder;
  cylinder.name = cylinder.family = "cylinder";
  cylinder.file = words_of(made);
  StudyProduct file = cylinder;
  file.name = file.family = "tetrahedron";
  file.file = "tetrahedron.stl";
  file.at = Vec3(1.0 / 3.0, 2, 3);
  study.inputs.products = {make_solid(made), {}};
  study.inputs.products[1].mesh = tetrahedron(31.0);
  cylinder.content_hash = content_hash(study.inputs.products[0].mesh);
  file.content_hash = content_hash(study.inputs.products[1].mesh);
  plan.products = {cylinder, file};
  plan.grips = {std::nullopt, Grip::kTripod};
  plan.settings.push_back({});
  plan.limits.push_back({"force_n", std::nullopt, 50.0});
  study.inputs.base = std::make_shared<const Hand>(stored_hand());
  plan.hand_hash = content_hash(*study.inputs.base);
  return study;
}

/// A record with something everywhere, numbers without a short binary form.
StudyRecord record_for(std::int64_t number) {
  StudyRecord record;
  record.number = number;
  const double x = static_cast<double>(number) / 7.0;
  record.outcome = number % 6 == 5 ? StudyOutcome::kFailed : StudyOutcome::kHeld;
  if (record.outcome == StudyOutcome::kFailed) {
    record.reason = "no, \"reason\"";
    return record;
  }
  record.grip = number % 2 == 0 ? Grip::kMediumWrap : Grip::kTripod;
  record.is_balanced = number % 3 == 0;
  if (number % 4 != 2) {  // the others are placed by coordinates
    StudyHold held;
    held.hold.part = 2;
    held.hold.part_name = "handle";
    held.hold.grip = record.grip;
    held.hold.along = x / 3.0;
    held.hold.edge = -x / 9.0;
    held.hold.toward = number % 2 == 0 ? 1 : -1;
    held.hold.turn = x;
    held.hold.is_over_end = number % 3 == 1;
    if (number % 3 != 0) held.kind = PartKind::kLoop;
    held.words = "medium wrap of the \"handle\"";
    record.hold = held;
  }
  record.force = 10.0 + x;
  record.grip_force = 5.0 + x;
  record.area = 1000.0 * x;
  record.peak_pressure = 0.1 * x;
  record.peak_pressure_cells = 0.05 * x;
  record.mean_pressure = 0.01 * x;
  record.demand = {x / 10.0, 3 * x, 2 * x};
  record.regions = {{Region::kThumbDistal, x, 2 * x, 3 * x, 4 * x, 5 * x},
                    {Region::kThenar, x, x, x, x, x / 3.0}};
  record.indices = {{"grip_force_n", 5.0 + x}, {"friction_in_use", x / 11.0}};
  // Not in the catalogue, in an order of their own, not in every record.
  if (number % 3 != 1) record.indices.push_back({"another_quantity", x});
  if (number % 3 != 0) record.indices.push_back({"a_quantity", 2 * x});
  for (std::size_t d = 0; d < record.posture.angle.size(); ++d) {
    record.posture.angle[d] = x + static_cast<double>(d) / 9.0;
  }
  record.product_from_hand = Rigid3::about_axis(Vec3(0, 0.6, 0.8), Vec3(1, 2, 3), x);
  for (int v = 0; v < 200; v += 1 + static_cast<int>(number % 3)) {
    record.skin_pressure.vertex.push_back(300 * v + 1);
    record.skin_pressure.value.push_back(static_cast<float>(0.01 * v + x));
  }
  if (number % 5 == 3) {
    record.fallbacks.lemke_solutions = static_cast<int>(number);
    record.fallbacks.band_levels = 1;
  }
  record.seconds = 0.5 + x;
  return record;
}

void expect_same(const StudyRecord& a, const StudyRecord& b) {
  EXPECT_EQ(a.number, b.number);
  EXPECT_EQ(a.outcome, b.outcome);
  EXPECT_EQ(a.reason, b.reason);
  EXPECT_EQ(a.grip, b.grip);
  EXPECT_EQ(a.is_balanced, b.is_balanced);
  ASSERT_EQ(a.hold.has_value(), b.hold.has_value());
  if (a.hold) {
    EXPECT_TRUE(is_same(*a.hold, *b.hold));
    EXPECT_EQ(a.hold->kind, b.hold->kind);
    EXPECT_EQ(a.hold->hold.part_name, b.hold->hold.part_name);
  }
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.grip_force, b.grip_force);
  EXPECT_EQ(a.area, b.area);
  EXPECT_EQ(a.peak_pressure, b.peak_pressure);
  EXPECT_EQ(a.peak_pressure_cells, b.peak_pressure_cells);
  EXPECT_EQ(a.mean_pressure, b.mean_pressure);
  EXPECT_EQ(a.demand.range_share, b.demand.range_share);
  EXPECT_EQ(a.demand.grip_strength, b.demand.grip_strength);
  EXPECT_EQ(a.demand.nail_room, b.demand.nail_room);
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (std::size_t i = 0; i < a.regions.size(); ++i) {
    EXPECT_EQ(a.regions[i].region, b.regions[i].region);
    EXPECT_EQ(a.regions[i].mean_pressure, b.regions[i].mean_pressure);
  }
  const auto values = [](const StudyRecord& record) {
    std::map<std::string, double> result;
    for (const IndexRecord& index : record.indices) result[index.key] = index.value;
    return result;
  };
  EXPECT_EQ(values(a), values(b));
  EXPECT_EQ(a.posture.angle, b.posture.angle);
  EXPECT_EQ(a.product_from_hand.rotation.coeffs(), b.product_from_hand.rotation.coeffs());
  EXPECT_EQ(a.product_from_hand.translation, b.product_from_hand.translation);
  EXPECT_EQ(a.skin_pressure.vertex, b.skin_pressure.vertex);
  EXPECT_EQ(a.skin_pressure.value, b.skin_pressure.value);
  EXPECT_EQ(a.product_pressure.vertex, b.product_pressure.vertex);
  EXPECT_EQ(a.fallbacks, b.fallbacks);
}

void fill(const fs::path& path, const std::vector<std::int64_t>& numbers) {
  StudyStore store(path, StudyAccess::kWrite);
  for (const std::int64_t number : numbers) store.keep(record_for(number));
}

/// A finished store whose grasps came in this order.
void make_store(const fs::path& path, const Study& study, std::vector<std::int64_t> order,
                StudyShard shard = {}) {
  StudyStore::create(path, study.plan, study.inputs, shard);
  fill(path, order);
  StudyStore store(path, StudyAccess::kWrite);
  store.finish();
}

TEST(StudyStore, KeepsTheFacesOfProducts) {
  const TestFolder folder;
  const fs::path path = folder / "faces.palmar";
  Study study = small_study();
  auto faces = std::make_shared<ProductFaces>();
  ProductFace fillet, plane;
  fillet.number = 1;
  fillet.kind = FaceKind::kCylinder;
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
  EXPECT_EQ(read_file(path)[63], 2);
  const auto has_faces = [&](const fs::path& store) {
    const StudyInputs inputs = StudyStore(store).inputs();
    const ProductFaces& kept = *inputs.products.at(1).faces;
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
  EXPECT_EQ(read_file(path)[63], 2);
  merge_studies({path}, folder / "merged.palmar");
  has_faces(folder / "merged.palmar");
}

TEST(StudyStore, GivesBackWhatItWasGiven) {
  const TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  fill(path, {3, 0, 17});
  const StudyStore store(path);
  EXPECT_EQ(store.done(), (std::vector<std::int64_t>{0, 3, 17}));
  EXPECT_EQ(store.missing().size(), 17U);
  EXPECT_FALSE(store.is_finished());
  std::vector<std::int64_t> seen;
  store.for_each(true, [&](const StudyRecord& record) {
    seen.push_back(record.number);
    expect_same(record, record_for(record.number));
    EXPECT_EQ(record.seconds, record_for(record.number).seconds);
  });
  EXPECT_EQ(seen, (std::vector<std::int64_t>{0, 3, 17}));
  store.for_each(false, [](const StudyRecord& record) {
    EXPECT_TRUE(record.skin_pressure.vertex.empty());
    EXPECT_EQ(record.force, record_for(record.number).force);
  });
  expect_same(store.record(17), record_for(17));
  EXPECT_THAT(message_of<UsageError>([&] { store.record(4); }), HasSubstr("grasp 4 is not in it"));
  EXPECT_EQ(format_plan(store.plan()), format_plan(study.plan));
  const StudyInputs inputs = store.inputs();
  EXPECT_EQ(format_plan(store.plan()), format_plan(study.plan));
  EXPECT_EQ(content_hash(*inputs.base), study.plan.hand_hash);
  EXPECT_EQ(inputs.products[1].mesh.vertices, study.inputs.products[1].mesh.vertices);
  // The cylinder is made again and so keeps its exact distance; radius 17.5 mm.
  EXPECT_DOUBLE_EQ(inputs.products[0].distance->at(Vec3(10, 0, 0)).distance, -7.5);
}

TEST(StudyStore, FinishedFilesHaveTheSameBytesWhateverTheOrder) {
  const TestFolder folder;
  const Study study = small_study();
  std::vector<std::int64_t> order = tasks_of(study.plan);
  make_store(folder / "a.palmar", study, order);
  std::reverse(order.begin(), order.end());
  make_store(folder / "b.palmar", study, order);
  const std::string bytes = read_file(folder / "a.palmar");
  EXPECT_EQ(bytes, read_file(folder / "b.palmar"));
  const StudyStore store(folder / "a.palmar");
  EXPECT_TRUE(store.is_finished());
  EXPECT_EQ(store.digest().size(), 64U);
  EXPECT_TRUE(store.missing().empty());
  expect_same(store.record(19), record_for(19));
  // Looking at it or opening it to go on changes nothing, and nothing is left beside it.
  StudyStore(folder / "b.palmar", StudyAccess::kWrite).finish();
  EXPECT_EQ(bytes, read_file(folder / "b.palmar"));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()), 2);
}

TEST(StudyStore, AnyOtherResultHasAnotherDigest) {
  const TestFolder folder;
  const Study study = small_study();
  make_store(folder / "a.palmar", study, tasks_of(study.plan));
  StudyStore::create(folder / "b.palmar", study.plan, study.inputs);
  {
    StudyStore store(folder / "b.palmar", StudyAccess::kWrite);
    for (const std::int64_t number : tasks_of(study.plan)) {
      StudyRecord record = record_for(number);
      if (number == 6) record.skin_pressure.value[3] += 1e-6F;
      store.keep(record);
    }
    store.finish();
  }
  EXPECT_NE(StudyStore(folder / "a.palmar").digest(), StudyStore(folder / "b.palmar").digest());
}

TEST(StudyStore, MergedShardsHaveTheBytesOfOneRun) {
  const TestFolder folder;
  const Study study = small_study();
  make_store(folder / "whole.palmar", study, tasks_of(study.plan));
  std::vector<fs::path> shards;
  for (int k = 1; k <= 3; ++k) {
    shards.push_back(folder / ("shard" + std::to_string(k)));
    make_store(shards.back(), study, tasks_of(study.plan, {k, 3}), {k, 3});
  }
  std::swap(shards[0], shards[2]);
  merge_studies(shards, folder / "merged.palmar");
  EXPECT_EQ(read_file(folder / "whole.palmar"), read_file(folder / "merged.palmar"));

  const fs::path out = folder / "out.palmar";
  const auto refused = [&](const std::vector<fs::path>& paths) {
    return message_of<UsageError>([&] { merge_studies(paths, out); });
  };
  EXPECT_THAT(refused({shards[0], shards[2]}), HasSubstr("missing 2/3 of the study \"small\""));
  EXPECT_THAT(refused({shards[0], shards[1], shards[2], shards[1]}),
              HasSubstr("are both shard 2/3"));
  make_store(folder / "shard-of-2", study, tasks_of(study.plan, {1, 2}), {1, 2});
  EXPECT_THAT(refused({shards[2], folder / "shard-of-2"}), HasSubstr("is shard 1/2"));
  Study other = study;
  other.plan.settings[0].friction = 0.3;
  make_store(folder / "other", other, tasks_of(other.plan, {2, 3}), {2, 3});
  EXPECT_THAT(refused({shards[2], folder / "other", shards[0]}),
              HasSubstr("is of another study than"));
  EXPECT_THAT(refused({shards[2], folder / "other", shards[0]}),
              HasSubstr("setting \"default\": friction was 0.5, now 0.3"));
  StudyStore::create(folder / "begun", study.plan, study.inputs, {2, 3});
  EXPECT_THAT(refused({shards[0], folder / "begun", shards[2]}),
              HasSubstr("is not finished (8 grasps are missing)"));
  EXPECT_FALSE(fs::exists(out));
  EXPECT_THAT(message_of<OutputError>([&] { merge_studies(shards, folder / "merged.palmar"); }),
              HasSubstr("is there already"));
}

TEST(StudyStore, OneProcessWritesAtATime) {
  const TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  {
    StudyStore store(path, StudyAccess::kWrite);
    store.keep(record_for(0));
    // The locks belong to processes, so another one has to ask.
    for (const auto access : {StudyAccess::kWrite, StudyAccess::kRead}) {
      const pid_t child = fork();
      if (child == 0) {
        int code = 1;
        try {
          const StudyStore second(path, access);
        } catch (const StudyBusy& busy) {
          code = std::string(busy.what()).find("a.palmar: in use by another process") ==
                         std::string::npos
                     ? 2
                     : 0;
        } catch (...) {
          code = 3;
        }
        _exit(code);
      }
      int status = -1;
      waitpid(child, &status, 0);
      EXPECT_EQ(status, 0);
    }
    store.keep(record_for(1));
  }
  EXPECT_EQ(StudyStore(path).done().size(), 2U);
}

TEST(StudyStore, KillingTheWriterLosesNothingThatWasKept) {
  const TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  const std::vector<std::int64_t> all = tasks_of(study.plan);
  for (int round = 0; StudyStore(path).missing().size() > 0; ++round) {
    ASSERT_LT(round, 40);
    int channel[2];
    ASSERT_EQ(pipe(channel), 0);
    const pid_t child = fork();
    if (child == 0) {
      StudyStore store(path, StudyAccess::kWrite);
      for (const std::int64_t number : store.missing()) {
        store.keep(record_for(number));
        const char number_kept = static_cast<char>(number);
        if (write(channel[1], &number_kept, 1) != 1) _exit(1);
      }
      close(channel[1]);  // a parent that waits for a second one when one was left
      pause();
      _exit(0);
    }
    close(channel[1]);
    // Killed right after it reported the second grasp: while it keeps the third.
    char number_kept = 0;
    std::int64_t last = -1;
    for (int i = 0; i < 2 && read(channel[0], &number_kept, 1) == 1; ++i) last = number_kept;
    if (round % 2 == 1) std::this_thread::sleep_for(std::chrono::microseconds(300 * round));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(channel[0]);
    const std::vector<std::int64_t> done = StudyStore(path).done();
    if (last < 0) continue;
    EXPECT_TRUE(std::binary_search(done.begin(), done.end(), last)) << round;
  }
  StudyStore(path, StudyAccess::kWrite).finish();
  make_store(folder / "whole.palmar", study, all);
  EXPECT_EQ(read_file(path), read_file(folder / "whole.palmar"));
}

TEST(StudyStore, DamagedFilesAreNamed) {
  const TestFolder folder;
  const Study study = small_study();
  make_store(folder / "good.palmar", study, tasks_of(study.plan));
  const std::string good = read_file(folder / "good.palmar");
  const fs::path bad = folder / "bad.palmar";
  const auto outcome = [&](const std::string& bytes) {
    write_file(bad, bytes);
    return message_of<InputError>([&] {
      const StudyStore store(bad);
      store.inputs();
      store.for_each(true, [](const StudyRecord&) {});
    });
  };
  EXPECT_EQ(outcome(good), "");
  EXPECT_THAT(outcome("no study at all, but text"), HasSubstr("bad.palmar: is no study of Palmar"));
  EXPECT_THAT(outcome(good.substr(0, 50)), HasSubstr("bad.palmar: is no study of Palmar"));
  for (const std::size_t length : {std::size_t{4096}, good.size() / 3, good.size() - 16384}) {
    EXPECT_THAT(outcome(good.substr(0, length)), HasSubstr("bad.palmar: is damaged")) << length;
  }
  std::string newer = good;
  EXPECT_EQ(newer[63], 1);  // no faces: every Palmar reads it
  newer[63] = 3;
  EXPECT_THAT(outcome(newer), HasSubstr("bad.palmar: study of version 3; this program reads up to "
                                        "version 2 (a newer Palmar wrote it)"));
  // One byte of a value: the same file for SQLite, another result.
  const double force = record_for(4).force;
  std::string big_endian(reinterpret_cast<const char*>(&force), sizeof force);
  std::reverse(big_endian.begin(), big_endian.end());
  const std::size_t at = good.find(big_endian);
  ASSERT_NE(at, good.npos);
  std::string flipped = good;
  flipped[at + 7] ^= 1;
  EXPECT_THAT(outcome(flipped), HasSubstr("bad.palmar: grasp 4 is damaged"));
  EXPECT_THAT(message_of<InputError>([&] { StudyStore(folder / "none.palmar"); }),
              HasSubstr("none.palmar: no such file"));
  EXPECT_THAT(message_of<InputError>([&] { StudyStore(folder.path()); }),
              HasSubstr("is a directory"));
  // Any byte: named or without effect, never a crash.
  for (std::size_t i = 100; i < good.size(); i += 997) {
    std::string changed = good;
    changed[i] = static_cast<char>(changed[i] ^ 0x55);
    const std::string said = outcome(changed);
    EXPECT_TRUE(said.empty() || said.find("bad.palmar") != said.npos) << said;
  }
}

TEST(StudyStore, FoldersThatCantBeWrittenAreNamed) {
  const TestFolder folder;
  const Study study = small_study();
  EXPECT_THAT(message_of<OutputError>(
                  [&] { StudyStore::create(folder / "none/a.palmar", study.plan, study.inputs); }),
              HasSubstr("does not exist"));
  make_store(folder / "a.palmar", study, tasks_of(study.plan));
  EXPECT_THAT(message_of<OutputError>(
                  [&] { StudyStore::create(folder / "a.palmar", study.plan, study.inputs); }),
              HasSubstr("a.palmar: is there already"));
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(StudyStore(folder / "a.palmar").done().size(), 20U) << "reading needs no permission";
  EXPECT_NE(message_of<OutputError>(
                [&] { StudyStore::create(folder / "b.palmar", study.plan, study.inputs); }),
            "");
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(StudyStore, AFullDiskIsNamedAndLosesNothing) {
  const TestFolder folder;
  const Study study = small_study();
  const fs::path path = folder / "a.palmar";
  StudyStore::create(path, study.plan, study.inputs);
  const pid_t child = fork();
  if (child == 0) {
    // No file may grow beyond what the store has now and a little more.
    signal(SIGXFSZ, SIG_IGN);
    const auto size = static_cast<rlim_t>(120'000);
    const struct rlimit limit = {size, size};
    setrlimit(RLIMIT_FSIZE, &limit);
    int kept = 0;
    try {
      StudyStore store(path, StudyAccess::kWrite);
      for (const std::int64_t number : store.missing()) {
        store.keep(record_for(number));
        ++kept;
      }
    } catch (const OutputError& error) {
      const bool is_named =
          std::string(error.what()).find("a.palmar: the disk ") != std::string::npos;
      _exit(is_named ? 100 + kept : 1);
    } catch (...) {
      _exit(2);
    }
    _exit(3);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  ASSERT_GE(WEXITSTATUS(status), 100) << "no named outcome";
  EXPECT_EQ(std::ssize(StudyStore(path).done()), WEXITSTATUS(status) - 100);
}

TEST(StudyStore, ExportsEveryTableWithUnits) {
  const TestFolder folder;
  const Study study = small_study();
  make_store(folder / "a.palmar", study, tasks_of(study.plan));
  const auto files = export_study(StudyStore(folder / "a.palmar"), folder / "tables", true);
  EXPECT_EQ(files.size(), 11U);
  const std::string grasps = read_file(folder / "tables/grasps.csv");
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
  EXPECT_THAT(read_file(folder / "tables/hands.csv"),
              HasSubstr("hand,population,label,stratum,sex,age_years,grip_strength_n,"
                        "hand_length_mm\n0,given,person 0,,male,,,180\n"));
  EXPECT_THAT(read_file(folder / "tables/postures.csv"), HasSubstr("_deg,"));
}

TEST(StudyPlanJson, KeepsHowAProductIsHeld) {
  Study study = small_study();
  const std::string without = format_plan(study.plan);
  EXPECT_THAT(without, Not(HasSubstr("holding")));  // as before there was anything to say
  HoldRequest& asked = study.plan.products[1].holding;
  asked.hold = Hold{};
  asked.hold->grip = Grip::kTripod;
  asked.hold->turn = 0.1 + 0.2;
  asked.hold->fingertips = {{Finger::kIndex, {.along = 0.3, .turn = -1.0 / 3.0, .height = 7.5}}};
  asked.part = 3;
  asked.part_name = "lid";
  asked.along = 0.25;
  asked.toward = Vec3(0.0, 0.6, 0.8);
  asked.purpose = HoldPurpose::kHandOver;
  const StudyPlan back = parse_plan(format_plan(study.plan), "plan");
  EXPECT_EQ(format_plan(back), format_plan(study.plan));
  const HoldRequest& read = back.products[1].holding;
  ASSERT_TRUE(read.hold.has_value());
  EXPECT_EQ(read.hold->grip, Grip::kTripod);
  EXPECT_EQ(read.hold->turn, 0.1 + 0.2);
  ASSERT_EQ(read.hold->fingertips.size(), 1U);
  EXPECT_EQ(read.hold->fingertips[0].place.turn, -1.0 / 3.0);
  EXPECT_EQ(read.part, 3);
  EXPECT_EQ(read.part_name, "lid");
  EXPECT_EQ(read.along, 0.25);
  EXPECT_EQ(read.toward, Vec3(0.0, 0.6, 0.8));
  EXPECT_EQ(read.purpose, HoldPurpose::kHandOver);
  EXPECT_TRUE(back.products[0].holding.is_empty());
  EXPECT_FALSE(plan_differences(study.plan, parse_plan(without, "plan")).empty());
}

TEST(StudyPlanJson, ReadsBackAndReportsWhatDiffers) {
  const Study study = small_study();
  const StudyPlan back = parse_plan(format_plan(study.plan), "plan");
  EXPECT_EQ(format_plan(back), format_plan(study.plan));
  EXPECT_TRUE(plan_differences(study.plan, back).empty());
  StudyPlan now = study.plan;
  now.settings[0].limit_depths = true;
  EXPECT_THAT(plan_differences(study.plan, now),
              testing::ElementsAre("setting \"default\": limit_depths was false, now true"));
  now = study.plan;
  now.products[1].content_hash = std::string(64, '0');
  now.hands[3].sample.dimensions[0].value += 1e-9;
  now.seed = 8;
  now.grips.pop_back();
  EXPECT_THAT(
      plan_differences(study.plan, now),
      testing::ElementsAre("seed was 7, now 8",
                           "product \"tetrahedron\": its shape has changed "
                           "(tetrahedron.stl)",
                           "had 2 grips, now 1", "hand \"person 3\": its dimensions have changed"));
  EXPECT_THAT(message_of<InputError>([&] { parse_plan("{\"name\": 3}", "x.palmar"); }),
              HasSubstr("x.palmar: its plan can't be read"));
}

TEST(StudyPlanJson, OlderPlanWithoutAForceWasHeldAtLimitDepths) {
  nlohmann::json plan = nlohmann::json::parse(format_plan(small_study().plan));
  nlohmann::json& setting = plan.at("settings").at(0);
  for (const char* key : {"limit_depths", "strength_n", "least_grip_force_n"}) setting.erase(key);
  const StudySetting old = parse_plan(plan.dump(), "plan").settings.at(0);
  EXPECT_TRUE(old.limit_depths);
  EXPECT_FALSE(old.grip_force || old.strength_share || old.strength);
  setting["grip_force_n"] = 40.0;
  EXPECT_FALSE(parse_plan(plan.dump(), "plan").settings.at(0).limit_depths);
}

}  // namespace
}  // namespace palmar
