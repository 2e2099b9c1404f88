// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/study/study_shards.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <set>

#include "palmar/core/error.h"
#include "palmar/records/study/study_progress.h"
#include "palmar/records/study/study_store.h"
#include "palmar/workflow/study/missing_grasps.h"

namespace palmar::workflow {
namespace {

namespace fs = std::filesystem;

/// Files as given; of a folder every store in it, by name.
std::vector<fs::path> stores_of(const std::vector<fs::path>& names) {
  std::vector<fs::path> paths;
  for (const fs::path& name : names) {
    if (!fs::is_directory(name)) {
      paths.emplace_back(name);
      continue;
    }
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(name)) {
      const std::string file = entry.path().filename().string();
      if (entry.path().extension() == ".palmar" && file.front() != '.') {
        found.push_back(entry.path());
      }
    }
    std::sort(found.begin(), found.end());
    paths.insert(paths.end(), found.begin(), found.end());
  }
  return paths;
}

void take_note(const records::StudyProgressNote& note, StudyStoreState& state) {
  state.state = "running";
  state.shard = note.shard;
  state.done = note.done;
  state.total = note.total;
  state.outcomes = note.outcomes;
  state.reasons = note.reasons;
  const auto run_now = static_cast<double>(note.done - note.done_before);
  const auto age = static_cast<double>(std::time(nullptr) - note.updated);
  if (run_now > 0.0) {
    const double rest = static_cast<double>(note.total - note.done) * note.seconds / run_now;
    state.seconds_left = std::max(0.0, rest - age);
  }
  state.detail = fmt::format("process {} on {}", note.process, note.host);
}

StudyStoreState state_of(const fs::path& path) {
  StudyStoreState state;
  state.path = path;
  try {
    const records::StudyStore store(path);
    state.shard = store.shard();
    state.total = static_cast<std::int64_t>(study::tasks_of(store.plan(), store.shard()).size());
    state.state = store.is_finished() ? "finished" : "stopped";
    store.for_each(false, [&](const study::StudyRecord& record) {
      ++state.done;
      ++state.outcomes[name_of(record.outcome)];
      if (record.outcome == study::StudyOutcome::kFailed) ++state.reasons[record.reason];
    });
    const std::vector<std::int64_t> rest = store.missing();
    if (store.is_finished() && !rest.empty()) {
      state.state = "damaged";
      state.detail = missing_grasps(rest);
    }
  } catch (const records::StudyBusy&) {
    state.state = "running";
    if (const auto note = records::read_study_progress(path)) take_note(*note, state);
  } catch (const Error& error) {
    state.state = "unreadable";
    state.detail = error.what();
  }
  return state;
}

/// Shards that the others speak of but that have no store, by "k/n".
std::vector<std::string> absent_shards(const std::vector<StudyStoreState>& states) {
  std::map<int, std::set<int>> seen;
  for (const StudyStoreState& one : states) {
    if (one.total > 0) seen[one.shard.n].insert(one.shard.k);
  }
  std::vector<std::string> absent;
  for (const auto& [count, known] : seen) {
    for (int k = 1; k <= count; ++k) {
      if (known.count(k) == 0) absent.push_back(name_of(study::StudyShard{k, count}));
    }
  }
  return absent;
}

}  // namespace

StudyMergeOutcome merge_shards(const std::vector<fs::path>& shards, const fs::path& out,
                               const Progress& progress) {
  const std::vector<fs::path> stores = stores_of(shards);
  records::merge_studies(stores, out, progress);
  const records::StudyStore store(out);
  return {.plan = store.plan(), .shards = stores.size(), .digest = store.digest()};
}

bool StudyStatus::is_sound() const {
  return std::none_of(stores.begin(), stores.end(), [](const StudyStoreState& one) {
    return one.state == "unreadable" || one.state == "damaged";
  });
}

StudyStatus study_status(const std::vector<fs::path>& stores) {
  StudyStatus status;
  for (const fs::path& path : stores_of(stores)) status.stores.push_back(state_of(path));
  if (status.stores.empty()) {
    throw InputError(fmt::format("{}: holds no study (*.palmar)",
                                 stores.empty() ? "study status" : stores.front().string()));
  }
  for (const StudyStoreState& one : status.stores) {
    status.done += one.done;
    status.total += one.total;
    for (const auto& [reason, times] : one.reasons) status.failed += times;
  }
  status.absent_shards = absent_shards(status.stores);
  return status;
}

}  // namespace palmar::workflow
