// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "study/study_arguments.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/formats/text_scan.h"
#include "palmar/population/hand_profile.h"
#include "palmar/study/study_task.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostSampled = 24;  // grasps of the sample; some seconds

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// MB that the process holds now.
double resident_memory() {
  std::ifstream file("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  file >> total >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

/// MB that it held at most.
double largest_memory() {
  struct rusage usage {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) * 1024.0 / 1e6;
}

bool looks_like_file(const std::string& name) {
  return name.find('/') != name.npos || fs::path(name).has_extension();
}

PopulationRequest population_request(const std::string& name) {
  PopulationRequest request;
  if (!looks_like_file(name)) {
    request.preset = name;
  } else if (fs::path(name).extension() == ".toml") {
    request.file = name;
  } else {
    request.table = name;
  }
  return request;
}

}  // namespace

void StudyArguments::add_to(CLI::App& verb) {
  CLI::Option* toml = verb.add_option("FILE", file, "Study file (docs/using/studies.md)");
  const auto add = [&](const char* name, auto& value, const char* text) {
    CLI::Option* option = verb.add_option(name, value, text);
    option->excludes(toml);
    return option;
  };
  add("--product", products, "Without FILE: a mesh file, may be given several times")
      ->allow_extra_args(false);
  add("--unit", unit, "Unit of mesh files that carry none: mm, cm, m, inch");
  add("--population", populations,
      "Without FILE: a built-in population (`palmar population list`), a population file (.toml) "
      "or "
      "a table of given hands (.csv); xie2014 if not given")
      ->allow_extra_args(false);
  add("--hands", hands, "Hands to draw from each population; 30 if not given")
      ->check(CLI::Range(1, 1'000'000));
  add("--profile", profiles, "none, reduced_range, thick_gloves ...; may be given several times")
      ->allow_extra_args(false);
  add("--grip", grips, "auto, medium_wrap, tripod ...; may be given several times")
      ->allow_extra_args(false);
  add("--hand", hand, "Hand that is scaled: template or a *.hand.glb file");
}

StudyRequest StudyArguments::request(const Context& context) const {
  StudyRequest request;
  if (!file.empty()) {
    request = read_study_file(file);
  } else {
    if (products.empty()) {
      throw UsageError("what is to be studied is not said: FILE.toml or --product is required");
    }
    request.name = fs::path(products.front()).stem().string();
    for (const std::string& name : products) {
      ProductRequest product;
      product.file = name;
      product.unit = parse_unit(unit);
      request.products.push_back(std::move(product));
    }
    for (const std::string& name : populations) {
      request.populations.push_back(population_request(name));
    }
    if (populations.empty()) request.populations.push_back(population_request("xie2014"));
    for (PopulationRequest& one : request.populations) {
      if (hands > 0 && !one.table.empty()) {
        throw UsageError("--hands has no meaning with the given hands of " + one.table);
      }
      if (hands > 0) one.sampling.hands = hands;
    }
    for (const std::string& name : profiles) request.profiles.push_back(profile_named(name));
    for (const std::string& name : grips) request.grips.push_back(asked_grip_named(name));
    if (!hand.empty()) request.hand = hand;
  }
  if (context.common.seed != 0) request.seed = context.common.seed;
  return request;
}

LoadedStudy StudyArguments::load(const Context& context) const {
  const StudyRequest asked = request(context);
  LoadedStudy study = load_study(asked, load_hand(asked.hand));
  for (const std::string& text : study.notes) note(context.common, text);
  return study;
}

StudyShard parse_shard(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t slash = text.find('/');
  const auto k = parse_integer(std::string_view(text).substr(0, slash));
  const auto n =
      slash == text.npos ? std::nullopt : parse_integer(std::string_view(text).substr(slash + 1));
  constexpr long long kMost = 1'000'000;
  if (!k || !n || *k < 1 || *n < *k || *n > kMost) {
    throw UsageError("--shard is \"" + text + "\"; k/n with 1 <= k <= n is required, as in 2/4");
  }
  return {static_cast<int>(*k), static_cast<int>(*n)};
}

std::string study_size_text(const StudyPlan& plan) {
  const auto counted = [](std::size_t count, const std::string& one) {
    return fmt::format("{} {}{}", count, one, count == 1 ? "" : "s");
  };
  std::string text = counted(plan.hands.size(), "hand");
  const auto add = [&](std::size_t count, const std::string& one) {
    if (count > 1) text += " x " + counted(count, one);
  };
  add(plan.profiles.size(), "profile");
  add(plan.settings.size(), "setting");
  text += " x " + counted(plan.products.size(), "product");
  add(plan.grips.size(), "grip");
  return fmt::format("{} = {} grasps", text, task_count(plan));
}

std::string missing_text(const std::vector<std::int64_t>& numbers) {
  constexpr std::size_t kMost = 10;
  std::string list;
  for (std::size_t i = 0; i < std::min(kMost, numbers.size()); ++i) {
    list += fmt::format("{}{}", i == 0 ? "" : ", ", numbers[i]);
  }
  return fmt::format("finished, but {} grasp{} not in it: {}{}", numbers.size(),
                     numbers.size() == 1 ? " is" : "s are", list,
                     numbers.size() > kMost ? " ..." : "");
}

std::string duration_text(double seconds) {
  if (seconds < 100.0) return fmt::format("{:.3g} s", seconds);
  if (seconds < 6000.0) return fmt::format("{:.0f} min", std::ceil(seconds / 60.0));
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

double StudyEstimate::seconds(std::int64_t hands, int threads) const {
  const std::int64_t rounds = (hands + threads - 1) / threads;
  return seconds_once + static_cast<double>(rounds) * seconds_per_hand;
}

double StudyEstimate::memory(int threads) const {
  return memory_once + threads * memory_per_thread;
}

StudyEstimate estimate_study(const LoadedStudy& study, const Progress& progress) {
  const StudyPlan& plan = study.plan;
  const std::vector<std::int64_t> all = tasks_of(plan);
  const std::size_t per_hand = all.size() / plan.hands.size();
  std::vector<std::int64_t> tasks(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(per_hand));
  StudyEstimate estimate;
  estimate.sample = static_cast<int>(std::min(per_hand, kMostSampled));
  tasks.resize(static_cast<std::size_t>(estimate.sample));

  const auto start = Clock::now();
  progress.update(0.1, "measuring a few grasps");
  StudyBench bench(plan, study.inputs);
  bench.prepare(tasks, progress);
  estimate.seconds_once = seconds_since(start);
  estimate.memory_once = resident_memory();
  const auto grasps = Clock::now();
  int done = 0;
  bench.run_hand(
      0, tasks,
      [&](const StudyRecord&) {
        progress.update(0.1 + 0.9 * ++done / estimate.sample, "measuring a few grasps");
      },
      progress);
  // Hand and grasps: what one hand costs once is in the sample once.
  estimate.seconds_per_hand =
      seconds_since(grasps) * static_cast<double>(per_hand) / static_cast<double>(estimate.sample);
  estimate.memory_per_thread = std::max(20.0, largest_memory() - estimate.memory_once);
  // Places of products that the sample left out.
  estimate.seconds_once *= static_cast<double>(per_hand) / static_cast<double>(estimate.sample);
  return estimate;
}

}  // namespace palmar::cli
