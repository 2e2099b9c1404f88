// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/job_shelf.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <thread>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/test_files.h"
#include "palmar/server/job_file.h"

namespace palmar::server {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// In place of the program: a script that says and writes what it would. A study counts to 3 in its
/// store, one line per 0.1 s, and goes on where it was stopped.
constexpr const char* kProgram = R"sh(#!/bin/sh
last() { for word in "$@"; do :; done; echo "$word"; }
case "$1 $2" in
  "study plan")
    echo "progress 0.1 reading"
    printf '{\n  "title": "A",\n  "grasps": 24,\n  "estimated_seconds": 7.5\n}\n' ;;
  "study run")
    out=$(last "$@")
    touch "$out"
    while [ "$(wc -l < "$out")" -lt 3 ]; do
      sleep 0.1
      echo grasp >> "$out"
      echo "progress 0.5 holding"
    done ;;
  "study report") mkdir -p "$5" && echo page > "$5/report.html" && echo 1,2 > "$5/hands.csv" ;;
  "redesign press")
    out=$(last "$@")
    mkdir -p "$out" && echo shape > "$out/pressed.stl"
    case "$*" in
      *--no-compare*) ;;
      *) mkdir -p "$out/report" && echo page > "$out/report/report.html" ;;
    esac ;;
  "hand from-scan")
    out=$(last "$@")
    echo "$*" >> "$(dirname "$out")/told.txt"
    echo glb > "$out" && echo page > "$(dirname "$out")/report.html" ;;
  "assess "*)
    echo "palmar: reading" >&2
    echo "palmar: old.stl: is no mesh" >&2
    exit 3 ;;
esac
)sh";

class Jobs : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "palmar_jobs_XXXXXX").string();
    test_folder = mkdtemp(name.data());
    program = test_folder / "program";
    std::ofstream(program) << kProgram;
    fs::permissions(program, fs::perms::owner_all);
    ShelvedProduct product;
    product.file_name = "old.stl";
    product.argument = "parts/old.stl";
    product.unit = geometry::LengthUnit::kMillimetre;
    product.path = test_folder / "old.stl";
    formats::write_file(product.path, "a mesh");
    products = {product, product};
    products[1].file_name = "new.stl";
    study = parse_job_request(
        R"({"kind": "study", "products": ["p1", "p2"], "populations": ["ansur2"], "hands": 3})");
  }
  void TearDown() override { fs::remove_all(test_folder); }

  std::unique_ptr<JobShelf> shelf() const {
    return std::make_unique<JobShelf>(test_folder / "jobs", program);
  }
  static Job wait_for(const JobShelf& jobs, const std::string& key,
                      const std::function<bool(const Job&)>& is_so) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    Job job;
    do {
      job = jobs.find(key).value_or(Job{});
      if (is_so(job)) return job;
      if (job.state == JobState::kFailed) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    } while (std::chrono::steady_clock::now() < end);
    ADD_FAILURE() << "it stands at " << name_of(job.state) << " " << job.message;
    return job;
  }
  static Job wait_for(const JobShelf& jobs, const std::string& key, JobState state) {
    return wait_for(jobs, key, [state](const Job& job) { return job.state == state; });
  }

  fs::path test_folder, program;
  std::vector<ShelvedProduct> products;
  JobRequest study;
};

TEST_F(Jobs, StudyIsEstimatedThenRunAndItsFilesAreThere) {
  const auto jobs = shelf();
  const std::string key = jobs->add(study, products).key;
  Job job = wait_for(*jobs, key, JobState::kNew);
  EXPECT_EQ(job.title, "old, new");
  EXPECT_EQ(job.estimate_seconds, 7.5);
  EXPECT_EQ(job.grasps, 24);
  ASSERT_EQ(job.commands.size(), 2U);
  EXPECT_THAT(job.commands[0], HasSubstr("--product parts/old.stl"));
  EXPECT_FALSE(job.has_report);
  jobs->start(key);
  job = wait_for(*jobs, key, [](const Job& one) { return one.share > 0.0; });
  EXPECT_EQ(job.state, JobState::kRunning);
  EXPECT_EQ(job.doing, "holding");
  EXPECT_THROW(jobs->remove(key), UsageError);
  job = wait_for(*jobs, key, JobState::kDone);
  EXPECT_TRUE(job.has_report);
  EXPECT_THAT(jobs->files(job), testing::ElementsAre("hands.csv", "report.html", "study.palmar"));
  EXPECT_EQ(formats::read_file(*jobs->file(job, "hands.csv")), "1,2\n");
  for (const char* name : {"../job.json", "log.txt", "", "/etc/passwd"}) {
    EXPECT_FALSE(jobs->file(job, name)) << name;
  }
  jobs->remove(key);
  EXPECT_FALSE(jobs->find(key));
  EXPECT_FALSE(fs::exists(test_folder / "jobs" / key));
}

TEST_F(Jobs, CancelledStudyGoesOnWhereItWas) {
  const auto jobs = shelf();
  const std::string key = jobs->add(study, products).key;
  wait_for(*jobs, key, JobState::kNew);
  jobs->start(key);
  wait_for(*jobs, key, [](const Job& one) { return one.share > 0.0; });
  jobs->cancel(key);
  const Job job = wait_for(*jobs, key, JobState::kStopped);
  const std::string kept = formats::read_file(jobs->store(job));
  EXPECT_FALSE(kept.empty());
  jobs->start(key);
  wait_for(*jobs, key, JobState::kDone);
  EXPECT_EQ(formats::read_file(jobs->store(job)), "grasp\ngrasp\ngrasp\n");
}

TEST_F(Jobs, AnotherServerFindsWhatOneLeft) {
  std::string key;
  {
    const auto jobs = shelf();
    key = jobs->add(study, products).key;
    wait_for(*jobs, key, JobState::kNew);
    jobs->start(key);
    wait_for(*jobs, key, [](const Job& one) { return one.share > 0.0; });
    // As a killed server leaves it.
    fs::copy(test_folder / "jobs", test_folder / "left", fs::copy_options::recursive);
  }
  EXPECT_EQ(shelf()->find(key)->state, JobState::kStopped) << "it was stopped in order";
  fs::remove_all(products[0].path);  // jobs have copies of their own
  JobShelf again(test_folder / "left", program);
  ASSERT_EQ(again.list().size(), 1U);
  EXPECT_EQ(again.find(key)->state, JobState::kStopped);
  EXPECT_EQ(again.find(key)->estimate_seconds, 7.5);
  again.start(key);
  const Job job = wait_for(again, key, JobState::kDone);
  EXPECT_EQ(formats::read_file(again.store(job)), "grasp\ngrasp\ngrasp\n");
}

TEST_F(Jobs, OneRunsAtATimeAndFailuresSayWhy) {
  const auto jobs = shelf();
  const std::string first = jobs->add(study, products).key;
  wait_for(*jobs, first, JobState::kNew);
  jobs->start(first);
  wait_for(*jobs, first, JobState::kRunning);
  const std::string second =
      jobs->add(parse_job_request(R"({"kind": "compare", "products": ["p1", "p2"]})"), products)
          .key;
  const std::string third =
      jobs->add(parse_job_request(R"({"kind": "compare", "products": ["p1", "p2"]})"), products)
          .key;
  EXPECT_EQ(jobs->find(second)->state, JobState::kWaiting);
  jobs->cancel(third);
  EXPECT_EQ(jobs->find(third)->state, JobState::kStopped);
  const Job failed = wait_for(*jobs, second, JobState::kFailed);
  EXPECT_EQ(failed.message, "old.stl: is no mesh");
  EXPECT_EQ(jobs->find(first)->state, JobState::kDone);
  EXPECT_EQ(jobs->find(third)->state, JobState::kStopped);
}

TEST_F(Jobs, EndsAtOnceWithItsChild) {
  const auto jobs = shelf();
  const std::string key = jobs->add(study, products).key;
  wait_for(*jobs, key, JobState::kNew);
  jobs->start(key);
  wait_for(*jobs, key, [](const Job& one) { return one.share > 0.0; });
  const auto start = std::chrono::steady_clock::now();
  jobs->cancel(key);
  wait_for(*jobs, key, JobState::kStopped);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
}

TEST_F(Jobs, RedesignIsLookedAtBeforeItRuns) {
  const auto jobs = shelf();
  const JobRequest press = parse_job_request(R"({"kind": "redesign", "products": ["p1"],
      "verb": "press", "populations": ["ansur2"], "hands": 12})");
  const std::string key = jobs->add(press, {products[0]}).key;
  Job job = wait_for(*jobs, key, JobState::kNew);
  EXPECT_TRUE(job.has_preview);
  EXPECT_FALSE(job.has_report);
  EXPECT_THAT(jobs->made(job), testing::ElementsAre("preview/pressed.stl"));
  EXPECT_EQ(formats::read_file(*jobs->made_file(job, "preview/pressed.stl")), "shape\n");
  for (const char* name : {"job.json", "preview/../job.json", "/etc/passwd", "preview", ""}) {
    EXPECT_FALSE(jobs->made_file(job, name)) << name;
  }
  jobs->start(key);
  job = wait_for(*jobs, key, JobState::kDone);
  EXPECT_TRUE(job.has_report);
  EXPECT_THAT(jobs->files(job), testing::ElementsAre("pressed.stl"));
}

TEST_F(Jobs, HandIsMadeAgainFromTheSameFiles) {
  const auto jobs = shelf();
  formats::write_file(test_folder / "reference.ply", "a scan");
  formats::create_folder(test_folder / "sent");
  fs::rename(test_folder / "reference.ply", test_folder / "sent" / "reference.ply");
  const auto asked = [](const std::string& more) {
    return parse_job_request(
        R"({"kind": "hand", "method": "scan", "uploads": "k", "name": "anna")" + more + "}");
  };
  const std::string key = jobs->add(asked(""), {}, test_folder / "sent").key;
  Job job = wait_for(*jobs, key, JobState::kDone);
  EXPECT_TRUE(job.has_hand);
  EXPECT_TRUE(job.has_report);
  EXPECT_EQ(job.title, "anna");
  EXPECT_THAT(job.commands.front(), HasSubstr("from-scan reference.ply"));
  EXPECT_EQ(formats::read_file(*jobs->hand_file(key)), "glb\n");
  EXPECT_FALSE(jobs->hand_file("nothing"));
  jobs->revise(key, asked(R"(, "corrections": [{"posture": "reference", "mark": "dot",
                              "name": "palm", "place_mm": [1, 2, 3]}])"));
  job = wait_for(*jobs, key, JobState::kDone);
  const std::string told = formats::read_file(*jobs->made_file(job, "found/told.txt"));
  EXPECT_EQ(std::count(told.begin(), told.end(), '\n'), 2) << "what it made is still there";
  EXPECT_THAT(told, HasSubstr("--known " + (test_folder / "jobs" / key / "person.toml").string()));
  EXPECT_THAT(job.commands.front(), HasSubstr("from-scan reference.ply --known person.toml"));
  EXPECT_THAT(jobs->files(job), testing::Contains("person.toml"));
  const records::PersonFile known = records::read_person(jobs->file(job, "person.toml")->string());
  ASSERT_EQ(known.marks.size(), 1U);
  EXPECT_EQ(known.marks[0].segment, hand::Segment::kPalm);
  EXPECT_EQ(known.marks[0].point, Vec3(1, 2, 3));
  // Nothing is known any more.
  jobs->revise(key, asked(""));
  job = wait_for(*jobs, key, JobState::kDone);
  EXPECT_THAT(job.commands.front(), Not(HasSubstr("--known")));
  EXPECT_FALSE(jobs->file(job, "person.toml"));
  // Other files, or another job, are none of it.
  EXPECT_THROW(jobs->revise(key, study), UsageError);
  JobRequest other = asked("");
  other.hand.uploads = "elsewhere";
  EXPECT_THROW(jobs->revise(key, other), UsageError);
  // Another server finds it.
  JobShelf again(test_folder / "jobs", program);
  EXPECT_TRUE(again.hand_file(key).has_value());
  // What isn't a scan makes no hand, and leaves nothing.
  formats::create_folder(test_folder / "text");
  formats::write_file(test_folder / "text" / "notes.txt", "x");
  EXPECT_THROW(jobs->add(asked(""), {}, test_folder / "text"), UsageError);
  EXPECT_EQ(jobs->list().size(), 1U);
}

TEST_F(Jobs, WhatIsKnownOfAPersonIsSentWithTheRest) {
  const auto jobs = shelf();
  const auto asked = [](const std::string& method, const std::string& more) {
    return parse_job_request(R"({"kind": "hand", "uploads": "k", "name": "anna", "method": ")" +
                             method + '"' + more + "}");
  };
  const fs::path sent = test_folder / "sent";
  formats::create_folder(sent);
  formats::write_file(sent / "reference.ply", "a scan");
  formats::write_file(sent / "anna.toml",
                      "side = \"left\"\n[scan]\npick_dot = [1, 2, 3]\n[[mark]]\nmark = \"dot\"\n"
                      "name = \"none\"\nat_mm = [4, 5, 6]\n[[bone]]\nname = \"capitate\"\n"
                      "at_mm = [7, 8, 9]\n[measured_mm]\nhand_length = 181\n");
  const std::string key = jobs->add(asked("scan", R"(, "side": "right")"), {}, sent).key;
  Job job = wait_for(*jobs, key, JobState::kDone);
  EXPECT_THAT(job.commands.front(), HasSubstr("from-scan reference.ply --known person.toml"));
  // What is chosen on the page counts more; the rest is kept, also what scans don't need.
  const std::string written = formats::read_file(*jobs->file(job, "person.toml"));
  EXPECT_THAT(written, testing::AllOf(HasSubstr("side = \"right\""), HasSubstr("pick_dot"),
                                      HasSubstr("name = \"none\""), HasSubstr("capitate"),
                                      HasSubstr("hand_length = 181.0")));
  EXPECT_FALSE(fs::exists(test_folder / "jobs" / key / "sources" / "anna.toml"));
  // Another server has it, too.
  JobShelf again(test_folder / "jobs", program);
  EXPECT_EQ(records::format_person(again.find(key)->request.hand.known), written);

  // Measures are enough for a quick hand, and not for a scan.
  fs::remove(sent / "reference.ply");
  EXPECT_THAT(jobs->add(asked("quick", ""), {}, sent).commands.front(),
              testing::StartsWith("palmar hand quick --known person.toml"));
  const auto refusal = [&](const std::string& text) {
    formats::write_file(sent / "reference.ply", "a scan");
    formats::write_file(sent / "anna.toml", text);
    return formats::message_of<Error>([&] { jobs->add(asked("scan", ""), {}, sent); });
  };
  EXPECT_THAT(refusal("side = \"both\"\n"), testing::StartsWith("anna.toml:1: "));
  EXPECT_THAT(refusal("[[bone]]\nname = \"../x\"\nat_mm = [1, 2, 3]\n"), HasSubstr("../x"));
  formats::write_file(sent / "bob.toml", "");
  EXPECT_THAT(refusal(""), HasSubstr("bob.toml"));
  EXPECT_EQ(jobs->list().size(), 2U);
  EXPECT_EQ(std::distance(fs::directory_iterator(test_folder / "jobs"), {}), 2);
}

TEST_F(Jobs, AHandOfAnEarlierVersionOpens) {
  const fs::path place = test_folder / "jobs" / "j1";
  formats::create_folder(place / "found");
  formats::write_file(place / "found" / "anna.hand.glb", "glb");
  formats::write_file(place / "corrections.csv", "posture,mark,name,x_mm,y_mm,z_mm\n");
  formats::write_file(place / "job.json",
                      R"({"palmar_job": 1, "title": "anna", "request": {"kind": "hand",
      "products": [], "language": "en", "hold": null, "method": "scan", "uploads": "k1",
      "name": "anna", "side": "left", "unit": null, "crease_colour": "green", "dot_colour": "blue",
      "population": null, "sheet": null, "wrist_inside_mm": 0.0, "palm_up": false,
      "sizes_mm": {"hand_length": 181.0}, "corrections": [
        {"posture": "reference", "mark": "dot", "name": "palm", "place_mm": [1.0, 2.0, 3.0]},
        {"posture": "reference", "mark": "added_dot", "name": "none", "place_mm": [1.0, 2.0, 3.0]},
        {"posture": "", "mark": "", "name": "capitate", "place_mm": [4.0, 5.0, 6.0]}]},
      "products": [], "created_ms": 1, "state": "done", "message": "", "estimate_seconds": null,
      "grasps": 0, "commands": ["palmar hand from-scan a.ply --marks corrections.csv"]})");
  const auto job = shelf()->find("j1");
  ASSERT_TRUE(job);
  EXPECT_TRUE(job->has_hand);
  EXPECT_EQ(job->request.hand.known.side, hand::Side::kLeft);
  EXPECT_EQ(job->request.hand.known.marks.size(), 1U);
  EXPECT_EQ(job->request.hand.known.bones.size(), 1U);
}

TEST_F(Jobs, RefusesWhatCantBe) {
  const auto jobs = shelf();
  EXPECT_THROW(jobs->start("nothing"), UsageError);
  EXPECT_THROW(jobs->cancel(".."), UsageError);
  EXPECT_THROW(jobs->remove("../jobs"), UsageError);
  products[1].unit = geometry::LengthUnit::kInch;
  EXPECT_THROW(jobs->add(study, products), UsageError) << "two units for one --unit";
  JobShelf nowhere(std::nullopt, program);
  EXPECT_THROW(nowhere.add(study, products), OutputError);
  // What is damaged is left out.
  formats::create_folder(test_folder / "jobs" / "j1");
  formats::write_file(test_folder / "jobs" / "j1" / "job.json", "{\"palmar_job\": 1");
  EXPECT_TRUE(shelf()->list().empty());
}

TEST(JobFile, ProgressIsALine) {
  ASSERT_TRUE(progress_in("progress 0.25 holding the cup").has_value());
  EXPECT_EQ(progress_in("progress 0.25 holding the cup")->share, 0.25);
  EXPECT_EQ(progress_in("progress 0.25 holding the cup")->doing, "holding the cup");
  for (const char* line : {"", "progress", "progress ", "progress 2 x", "progress nan x", "0.5"}) {
    EXPECT_FALSE(progress_in(line)) << line;
  }
}

TEST(JobFile, EstimateIsTakenFromItsLines) {
  const StudyEstimateWords words =
      study_estimate_in("{\n  \"grasps\": 24,\n  \"cut\": \"abc\n  \"estimated_seconds\": 7.5\n}");
  EXPECT_EQ(words.grasps, 24);
  EXPECT_EQ(words.seconds, 7.5);
  for (const char* text : {"", "{", "  \"estimated_seconds\": x", "    \"estimated_seconds\": 3"}) {
    EXPECT_FALSE(study_estimate_in(text).seconds) << text;
  }
}

}  // namespace
}  // namespace palmar::server
