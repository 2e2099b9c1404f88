// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Requests of every kind, damaged at random, against the whole service with its drawers in a folder
// of its own: each is answered by what a client can be told, nothing crashes, nothing is written
// beside, memory stays. PALMAR_FUZZ_ROUNDS in the environment: how many (a build with sanitizers is
// given some ten thousand).
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/stl.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/server/live_request.h"
#include "palmar/server/service.h"

namespace palmar::server {
namespace {

namespace fs = std::filesystem;

int fuzz_rounds(int usual) {
  const char* const text = std::getenv("PALMAR_FUZZ_ROUNDS");
  return text != nullptr ? std::max(1, std::atoi(text)) : usual;
}

double resident_mb() {
  std::ifstream statm("/proc/self/statm");
  double all = 0.0, resident = 0.0;
  statm >> all >> resident;
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1048576.0;
}

std::string damaged(std::string text, std::mt19937& random) {
  static const std::vector<std::string> pieces = {
      "..",          "/",     "%2f",      "%00",
      "\"",          "{",     "]",        "null",
      "-1",          "1e999", "[[[[",     "--out",
      "/etc/passwd", "hand:", "\xff\xfe", "0",
      "true",        ",",     ":",        "groove:a.csv=1",
      "&name=",      "?",     "#",        std::string(300, 'a')};
  const unsigned changes = random() % 4U;
  for (unsigned k = 0; k < changes; ++k) {
    const std::size_t at = text.empty() ? 0 : random() % text.size();
    switch (random() % 4U) {
      case 0:
        if (!text.empty()) text[at] = static_cast<char>(random() % 256U);
        break;
      case 1:
        text.erase(at, 1 + random() % 20U);
        break;
      case 2:
        text.insert(at, pieces[random() % pieces.size()]);
        break;
      default:
        text.insert(at, 1, static_cast<char>(random() % 256U));
    }
  }
  return text;
}

struct Seed {
  const char* method;
  std::string target, body;
};

class Fuzz : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "palmar_fuzz_XXXXXX").string();
    test_folder = mkdtemp(name.data());
    const fs::path program = test_folder / "program";
    std::ofstream(program) << "#!/bin/sh\nexit 0\n";
    fs::permissions(program, fs::perms::owner_all);
    fs::create_directories(test_folder / "data");
    KeptData kept;
    kept.projects = std::make_shared<ProjectDrawer>(test_folder / "data" / "projects");
    kept.jobs = std::make_shared<JobShelf>(test_folder / "data" / "jobs", program);
    shelf = std::make_shared<ProductShelf>();
    service = std::make_unique<Service>("secret", shelf, kept);
    service->set_place({"127.0.0.1", 8123});
  }
  void TearDown() override {
    service.reset();
    fs::remove_all(test_folder);
  }
  int ask(const Seed& seed) {
    return service
        ->answer({.method = seed.method,
                  .target = seed.target,
                  .host = "127.0.0.1:8123",
                  .origin = "",
                  .authorization = "Bearer secret",
                  .body = seed.body})
        .status;
  }
  std::vector<Seed> seeds() const {
    const std::string redesign =
        R"({"kind":"redesign","products":["p1"],"verb":"features","populations":["ansur2"],"hands":3,
            "vary":["fillet:face=7=1:6"],"preview_mm":3,"radius_mm":[1,9],"language":"de"})";
    const std::string hand =
        R"({"kind":"hand","method":"scan","uploads":"k1","name":"anna","side":"left","unit":"mm",
            "dot_colour":"blue","pick_dot":[1,2,3],"sizes_mm":{"hand_length":181},"corrections":[{"posture":"reference",
            "mark":"dot","name":"palm","place_mm":[1,2,3]}]})";
    return {
        {"GET", "/api/state", ""},
        {"GET", "/bench.js", ""},
        {"POST", "/api/products?name=ball.stl&unit=mm",
         formats::format_stl(geometry::make_icosphere(30.0, 1))},
        {"POST", "/api/products?name=ball.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n"},
        {"POST", "/api/examples?name=ball", ""},
        {"GET", "/api/products/p1", ""},
        {"GET", "/api/products/p1/file", ""},
        {"GET", "/api/projects", ""},
        {"POST", "/api/projects/abc",
         R"({"product":"p1","state":{"hold":1},"picture":"data:image/png,x","history":[]})"},
        {"GET", "/api/projects/abc", ""},
        {"DELETE", "/api/projects/abc", ""},
        {"GET", "/api/jobs", ""},
        {"POST", "/api/jobs",
         R"({"kind":"study","products":["p1"],"populations":["ansur2"],"hands":3})"},
        {"POST", "/api/jobs", R"({"kind":"compare","products":["p1","p2"],"person":"hand:j1"})"},
        {"POST", "/api/jobs", redesign},
        {"POST", "/api/jobs", hand},
        {"GET", "/api/jobs/j1", ""},
        {"POST", "/api/jobs/j1/start", ""},
        {"POST", "/api/jobs/j1/cancel", ""},
        {"POST", "/api/jobs/j1/revise", hand},
        {"POST", "/api/jobs/j1/shelve?name=pressed.stl", ""},
        {"POST", "/api/jobs/j1/shelve?product=1", ""},
        {"GET", "/api/jobs/j1/shape?of=preview&what=before", ""},
        {"GET", "/api/jobs/j1/made?file=found%2Fmarks.csv", ""},
        {"GET", "/api/jobs/j1/files/report.html", ""},
        {"GET", "/api/jobs/j1/report", ""},
        {"GET", "/api/jobs/j1/dots", ""},
        {"DELETE", "/api/jobs/j1", ""},
        {"POST", "/api/uploads/k1?name=reference%2Fa.ply", "ply\n"},
        {"GET", "/api/hands", ""},
    };
  }

  fs::path test_folder;
  std::shared_ptr<ProductShelf> shelf;
  std::unique_ptr<Service> service;
};

TEST_F(Fuzz, DamagedRequestsAreAnsweredAndLeaveNothing) {
  const std::set<int> expected = {200, 400, 404, 405, 409, 413, 422};
  const std::vector<Seed> all = seeds();
  std::mt19937 random(2026);
  const int rounds = fuzz_rounds(3000);
  double half_way = 0.0;
  // What is outside of the drawers.
  const auto beside = [&] {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(test_folder))
      names.insert(entry.path().string());
    return names;
  };
  const std::set<std::string> before = beside();
  std::vector<std::string> keys;
  for (int round = 0; round < rounds; ++round) {
    Seed seed = all[random() % all.size()];
    if (random() % 40U == 0) {  // a job that is there
      const ServiceAnswer jobs = service->answer({.method = "GET",
                                                  .target = "/api/jobs",
                                                  .host = "127.0.0.1:8123",
                                                  .authorization = "Bearer secret"});
      keys.clear();
      for (std::size_t at = jobs.body.find("\"key\":\""); at != std::string::npos;
           at = jobs.body.find("\"key\":\"", at + 1)) {
        keys.push_back(jobs.body.substr(at + 7, jobs.body.find('"', at + 7) - at - 7));
      }
    }
    const std::size_t j1 = seed.target.find("/j1");
    if (!keys.empty() && j1 != std::string::npos) {
      seed.target.replace(j1 + 1, 2, keys[random() % keys.size()]);
    }
    // Room for new jobs.
    if (keys.size() > 60) {
      ask({"DELETE", "/api/jobs/" + keys.back(), ""});
      keys.pop_back();
    }
    seed.target =
        random() % 2U == 0 ? seed.target : "/api" + damaged(seed.target.substr(4), random);
    seed.body = damaged(seed.body, random);
    const int status = ask(seed);
    EXPECT_TRUE(expected.contains(status))
        << status << " for " << seed.method << " " << seed.target << "\n"
        << seed.body.substr(0, 400);
    if (round == rounds / 2) half_way = resident_mb();
  }
  EXPECT_EQ(beside(), before);
#if !defined(__SANITIZE_ADDRESS__)
  // Products on the shelf are few and small here; allocators keep some.
  EXPECT_LT(resident_mb() - half_way, 30.0) << "MB more in the second half";
#endif
}

TEST_F(Fuzz, DamagedJobsAreReadOrRefused) {
  std::mt19937 random(5);
  int refused = 0;
  const int rounds = fuzz_rounds(6000);
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Seed> all = seeds();
    const Seed& seed = all[12 + random() % 4U];
    try {
      const JobRequest request = parse_job_request(damaged(seed.body, random));
      const std::string once = job_request_json(request);
      EXPECT_EQ(job_request_json(parse_job_request(once)), once);
      for (const JobCommand& command : commands_of(request, {{"a.stl", "b.stl", "c.stl", "d.stl"},
                                                             geometry::LengthUnit::kMillimetre,
                                                             "/job/"})) {
        for (const std::string& word : command.words) {
          EXPECT_EQ(word.find("/etc"), std::string::npos) << word;
          EXPECT_EQ(word.find(".."), std::string::npos) << word;
        }
      }
    } catch (const UsageError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, rounds / 4);
}

}  // namespace
}  // namespace palmar::server
