// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// study_scale PALMAR SMALL.palmar HANDS FOLDER: what a large study costs beside its grasps. The
// finished study SMALL gives plan and results; its first population is drawn anew with HANDS hands,
// and hand k gets the results of one of SMALL's hands, moved by up to 5 %, so that no two are
// alike. Prints the time to keep and to close the study, the size of its file and the most disk
// that it took, and time and memory of what people do with it: `study status`, `compare`, `export`
// and `report` of the program PALMAR. Asked: seconds; not three times its size at its end.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "palmar/population/hand_sample.h"
#include "palmar/records/study/study_store.h"
#include "palmar/study/study_plan.h"

namespace {

namespace fs = std::filesystem;
using namespace palmar;

double seconds_of(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Bytes of all files in a folder.
double bytes_in(const fs::path& folder) {
  double sum = 0.0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const auto size = entry.file_size(error);
    if (!error) sum += static_cast<double>(size);
  }
  return sum;
}

/// The most that a folder took while it was looked at.
class DiskWatch {
 public:
  explicit DiskWatch(fs::path folder) : folder_(std::move(folder)), thread_([this] { watch(); }) {}
  ~DiskWatch() {
    ends_ = true;
    thread_.join();
  }
  double most() const { return most_; }

 private:
  void watch() {
    while (!ends_) {
      most_ = std::max(most_.load(), bytes_in(folder_));
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }
  fs::path folder_;
  std::atomic<double> most_{0.0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

void scale(study::StudyRecord& record, double factor) {
  for (double* const value :
       {&record.force, &record.grip_force, &record.area, &record.peak_pressure,
        &record.peak_pressure_cells, &record.mean_pressure}) {
    *value *= factor;
  }
  for (study::RegionRecord& region : record.regions) {
    for (double* const value : {&region.force, &region.area, &region.peak_pressure,
                                &region.peak_pressure_cells, &region.mean_pressure}) {
      *value *= factor;
    }
  }
  for (study::IndexRecord& index : record.indices) index.value *= factor;
  for (study::SparseField* const field : {&record.skin_pressure, &record.product_pressure}) {
    for (float& value : field->value) value *= static_cast<float>(factor);
  }
}

/// Runs the program; its time, and its memory as the system's largest so far.
void print_command(const std::string& palmar, const std::vector<std::string>& words) {
  int status = 0;
  std::fflush(stdout);
  rusage usage{};
  const double seconds = seconds_of([&] {
    const pid_t child = fork();
    if (child == 0) {
      std::vector<char*> arguments = {const_cast<char*>(palmar.c_str())};
      for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
      arguments.push_back(nullptr);
      if (std::freopen("/dev/null", "w", stdout) == nullptr) _exit(127);
      execv(palmar.c_str(), arguments.data());
      _exit(127);
    }
    wait4(child, &status, 0, &usage);
  });
  const auto of = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  std::printf("%-24s %8.1f s  %6.1f s of processors  %6.0f MB%s\n", ("study " + words[1]).c_str(),
              seconds, of(usage.ru_utime) + of(usage.ru_stime),
              static_cast<double>(usage.ru_maxrss) / 1024.0,
              status == 0 ? "" : "  (ended with an error)");
}

int run(const std::string& palmar, const fs::path& small_path, int hands, const fs::path& folder) {
  fs::create_directories(folder);
  const fs::path path = folder / "large.palmar";
  const records::StudyStore small(small_path);
  study::StudyPlan plan = small.plan();
  const study::StudyPlan before = plan;
  study::StudyPopulation& drawn = plan.populations.front();
  drawn.sampling.hands = hands;
  plan.populations.resize(1);
  plan.hands.clear();
  for (population::HandSample& sample :
       population::sample_hands(drawn.population, drawn.sampling)) {
    plan.hands.push_back({0, std::move(sample)});
  }
  std::vector<study::StudyRecord> known;
  small.for_each(true, [&](const study::StudyRecord& record) { known.push_back(record); });
  const auto per_hand = static_cast<std::int64_t>(known.size() / before.hands.size());
  const std::int64_t grasps = study::task_count(plan);
  {
    const DiskWatch watch(folder);
    records::StudyStore::create(path, plan, small.inputs());
    records::StudyStore store(path, records::StudyAccess::kWrite);
    std::mt19937_64 random(1);
    const double keeping = seconds_of([&] {
      for (std::int64_t number = 0; number < grasps; ++number) {
        const std::int64_t hand =
            number / per_hand % static_cast<std::int64_t>(before.hands.size());
        study::StudyRecord record =
            known[static_cast<std::size_t>(hand * per_hand + number % per_hand)];
        record.number = number;
        scale(record, 0.95 + 0.1 * static_cast<double>(random() >> 11) * 0x1p-53);
        store.keep(record);
      }
    });
    const double closing = seconds_of([&] { store.finish(); });
    const auto size = static_cast<double>(fs::file_size(path));
    std::printf("%lld grasps of %d hands, %lld a hand\n", static_cast<long long>(grasps), hands,
                static_cast<long long>(per_hand));
    std::printf("%-24s %8.1f s  %6.2f ms a grasp\n", "keep", keeping,
                1000.0 * keeping / static_cast<double>(grasps));
    std::printf("%-24s %8.1f s\n", "close", closing);
    std::printf(
        "%-24s %8.0f MB %6.1f kB a grasp; at most %.2f times that on the disk (asked: not 3)\n",
        "file", size / 1e6, size / 1e3 / static_cast<double>(grasps), watch.most() / size);
  }
  const std::string store = path.string();
  print_command(palmar, {"study", "status", store});
  print_command(palmar, {"study", "compare", store});
  print_command(palmar, {"study", "export", store, "--out", (folder / "tables").string()});
  print_command(palmar,
                {"study", "report", store, "--out", (folder / "report").string(), "--quiet"});
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 || std::atoi(argv[3]) < 1) {
    std::fprintf(stderr, "usage: study_scale PALMAR SMALL.palmar HANDS FOLDER\n");
    return 2;
  }
  try {
    return run(argv[1], argv[2], std::atoi(argv[3]), argv[4]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "study_scale: %s\n", error.what());
    return 1;
  }
}
