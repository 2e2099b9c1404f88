// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>

#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/workflow/study/study_shards.h"
#include "study/study_arguments.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct MergeArguments {
  std::vector<std::string> shards;
  std::string out;
};

int run_merge(const MergeArguments& arguments, const Context& context) {
  const workflow::StudyMergeOutcome merged =
      workflow::merge_shards({arguments.shards.begin(), arguments.shards.end()}, arguments.out,
                             make_progress(context.common));
  finish_progress();
  if (context.common.json) {
    const Json json = {{"store", arguments.out},
                       {"shards", merged.shards},
                       {"grasps", study::task_count(merged.plan)},
                       {"results_sha256", merged.digest}};
    print(json.dump(2) + "\n");
  } else {
    print(fmt::format("joined {} shard{}: {}\nresults {}\n{}\n", merged.shards,
                      merged.shards == 1 ? "" : "s", study_size_text(merged.plan), merged.digest,
                      arguments.out));
  }
  return 0;
}

Json state_json(const workflow::StudyStoreState& one) {
  Json json = {{"store", one.path.string()}, {"state", one.state},  {"shard", name_of(one.shard)},
               {"done", one.done},           {"grasps", one.total}, {"outcomes", one.outcomes},
               {"failed", one.reasons}};
  if (one.seconds_left) json["seconds_left"] = *one.seconds_left;
  if (!one.detail.empty()) json["detail"] = one.detail;
  return json;
}

std::string state_text(const workflow::StudyStoreState& one) {
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
  const workflow::StudyStatus status = workflow::study_status({names.begin(), names.end()});
  const int exit_code = status.is_sound() ? 0 : InputError("").exit_code();
  const std::vector<std::string>& absent = status.absent_shards;
  if (context.common.json) {
    Json list = Json::array();
    for (const workflow::StudyStoreState& one : status.stores) list.push_back(state_json(one));
    const Json json = {{"stores", std::move(list)},
                       {"absent_shards", absent},
                       {"done", status.done},
                       {"grasps", status.total},
                       {"failed", status.failed}};
    print(json.dump(2) + "\n");
    return exit_code;
  }
  std::string text;
  std::map<std::string, int> count;
  for (const workflow::StudyStoreState& one : status.stores) {
    text += state_text(one);
    ++count[one.state];
  }
  for (const std::string& name : absent) {
    text += fmt::format("{:<10} shard {:<7} has no store yet\n", "absent", name);
  }
  if (status.stores.size() > 1 || !absent.empty()) {
    std::string counts;
    for (const auto& [state, number] : count) counts += fmt::format(", {} {}", number, state);
    if (!absent.empty()) counts += fmt::format(", {} absent", absent.size());
    text += fmt::format("{} of {} grasps{}\n", status.done, status.total, counts);
  }
  print(text);
  return exit_code;
}

}  // namespace

void add_study_shard_commands(CLI::App& noun, Context& context) {
  const auto merge_options = std::make_shared<MergeArguments>();
  CLI::App* merge =
      add_verb(noun, "merge", "Join the shards of a study to what one process would have written",
               "palmar study merge shards --out whole.palmar");
  merge->add_option("SHARD", merge_options->shards, "Finished shards, or a folder with them")
      ->required();
  merge->add_option("--out", merge_options->out, "Store to write; must not exist yet")->required();
  merge->callback([&context, merge_options] {
    context.run = [&context, merge_options] { return run_merge(*merge_options, context); };
  });

  const auto names = std::make_shared<std::vector<std::string>>();
  CLI::App* status = add_verb(noun, "status", "How far a study is, over all its shards",
                              "palmar study status women.palmar");
  status->add_option("STORE", *names, "Stores, or folders with stores")->required();
  status->callback([&context, names] {
    context.run = [&context, names] { return run_status(*names, context); };
  });
}

}  // namespace palmar::cli
