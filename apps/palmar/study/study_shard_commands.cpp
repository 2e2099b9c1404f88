// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/records/study/study_progress.h"
#include "palmar/records/study/study_store.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

struct MergeArguments {
  std::vector<std::string> shards;
  std::string out;
};

/// Files as given; of a folder every store in it, by name.
std::vector<fs::path> stores_of(const std::vector<std::string>& names) {
  std::vector<fs::path> paths;
  for (const std::string& name : names) {
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

int run_merge(const MergeArguments& arguments, const Context& context) {
  const Progress progress = make_progress(context.common);
  const std::vector<fs::path> shards = stores_of(arguments.shards);
  merge_studies(shards, arguments.out, progress);
  finish_progress();
  const StudyStore store(arguments.out);
  if (context.common.json) {
    const Json json = {{"store", arguments.out},
                       {"shards", shards.size()},
                       {"grasps", task_count(store.plan())},
                       {"results_sha256", store.digest()}};
    print(json.dump(2) + "\n");
  } else {
    print(fmt::format("joined {} shard{}: {}\nresults {}\n{}\n", shards.size(),
                      shards.size() == 1 ? "" : "s", study_size_text(store.plan()), store.digest(),
                      arguments.out));
  }
  return 0;
}

/// How far one store is.
struct StoreState {
  fs::path path;
  std::string state;  ///< "finished", "running", "stopped", "damaged", "unreadable"
  std::string detail;
  StudyShard shard;
  std::int64_t done = 0, total = 0;
  std::map<std::string, std::int64_t> outcomes, reasons;
  std::optional<double> seconds_left;
};

void take_note(const StudyProgressNote& note, StoreState& state) {
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

StoreState state_of(const fs::path& path) {
  StoreState state;
  state.path = path;
  try {
    const StudyStore store(path);
    state.shard = store.shard();
    state.total = static_cast<std::int64_t>(tasks_of(store.plan(), store.shard()).size());
    state.state = store.is_finished() ? "finished" : "stopped";
    store.for_each(false, [&](const StudyRecord& record) {
      ++state.done;
      ++state.outcomes[name_of(record.outcome)];
      if (record.outcome == StudyOutcome::kFailed) ++state.reasons[record.reason];
    });
    const std::vector<std::int64_t> rest = store.missing();
    if (store.is_finished() && !rest.empty()) {
      state.state = "damaged";
      state.detail = missing_text(rest);
    }
  } catch (const StudyBusy&) {
    state.state = "running";
    if (const auto note = read_study_progress(path)) take_note(*note, state);
  } catch (const Error& error) {
    state.state = "unreadable";
    state.detail = error.what();
  }
  return state;
}

/// Shards that the others speak of but that have no store, by "k/n".
std::vector<std::string> absent_shards(const std::vector<StoreState>& states) {
  std::map<int, std::set<int>> seen;
  for (const StoreState& one : states) {
    if (one.total > 0) seen[one.shard.n].insert(one.shard.k);
  }
  std::vector<std::string> absent;
  for (const auto& [count, known] : seen) {
    for (int k = 1; k <= count; ++k) {
      if (known.count(k) == 0) absent.push_back(name_of(StudyShard{k, count}));
    }
  }
  return absent;
}

Json state_json(const StoreState& one) {
  Json json = {{"store", one.path.string()}, {"state", one.state},  {"shard", name_of(one.shard)},
               {"done", one.done},           {"grasps", one.total}, {"outcomes", one.outcomes},
               {"failed", one.reasons}};
  if (one.seconds_left) json["seconds_left"] = *one.seconds_left;
  if (!one.detail.empty()) json["detail"] = one.detail;
  return json;
}

std::string state_text(const StoreState& one) {
  std::string text = fmt::format("{:<10} ", one.state);
  if (one.total > 0) {
    text += fmt::format("shard {:<7} {:>7} of {:<7} {:>3.0f} %  ", name_of(one.shard), one.done,
                        one.total,
                        100.0 * static_cast<double>(one.done) / static_cast<double>(one.total));
  }
  text += one.path.string();
  if (one.seconds_left) text += fmt::format(", about {} left", duration_text(*one.seconds_left));
  if (!one.detail.empty()) text += " (" + one.detail + ")";
  text += "\n";
  for (const auto& [reason, count] : one.reasons) {
    text += fmt::format("           failed: {} ({})\n", reason, count);
  }
  return text;
}

int run_status(const std::vector<std::string>& names, const Context& context) {
  std::vector<StoreState> states;
  for (const fs::path& path : stores_of(names)) states.push_back(state_of(path));
  if (states.empty()) {
    throw InputError(fmt::format("{}: holds no study (*.palmar)", names.front()));
  }
  std::int64_t done = 0, total = 0, failed = 0;
  std::map<std::string, int> count;
  for (const StoreState& one : states) {
    done += one.done;
    total += one.total;
    ++count[one.state];
    for (const auto& [reason, times] : one.reasons) failed += times;
  }
  const int exit_code =
      count.count("unreadable") + count.count("damaged") > 0 ? InputError("").exit_code() : 0;
  const std::vector<std::string> absent = absent_shards(states);
  if (context.common.json) {
    Json list = Json::array();
    for (const StoreState& one : states) list.push_back(state_json(one));
    const Json json = {{"stores", std::move(list)},
                       {"absent_shards", absent},
                       {"done", done},
                       {"grasps", total},
                       {"failed", failed}};
    print(json.dump(2) + "\n");
    return exit_code;
  }
  std::string text;
  for (const StoreState& one : states) text += state_text(one);
  for (const std::string& name : absent) {
    text += fmt::format("{:<10} shard {:<7} has no store yet\n", "absent", name);
  }
  if (states.size() > 1 || !absent.empty()) {
    std::string counts;
    for (const auto& [state, number] : count) counts += fmt::format(", {} {}", number, state);
    if (!absent.empty()) counts += fmt::format(", {} absent", absent.size());
    text += fmt::format("{} of {} grasps{}\n", done, total, counts);
  }
  print(text);
  return exit_code;
}

}  // namespace

void add_study_shard_commands(CLI::App& noun, Context& context) {
  const auto merge_options = std::make_shared<MergeArguments>();
  CLI::App* merge =
      add_verb(noun, "merge", "Join the shards of a study to what one process would have written",
               "palmar study merge shards/*.palmar --out study.palmar");
  merge->add_option("SHARD", merge_options->shards, "Finished shards, or a folder with them")
      ->required();
  merge->add_option("--out", merge_options->out, "Store to write; must not be there yet")
      ->required();
  merge->callback([&context, merge_options] {
    context.run = [&context, merge_options] { return run_merge(*merge_options, context); };
  });

  const auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* status = add_verb(noun, "status", "How far a study is, over all its shards",
                              "palmar study status shards");
  status->add_option("STORE", *names, "Stores, or folders with stores")->required();
  status->callback([&context, names] {
    context.run = [&context, names] { return run_status(*names, context); };
  });
}

}  // namespace palmar::cli
