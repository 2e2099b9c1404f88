// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <pybind11/stl.h>

#include "arrays.h"
#include "bindings.h"
#include "palmar/core/error.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/report/study/study_csv.h"
#include "palmar/study/statistics/study_analysis.h"
#include "palmar/workflow/study/study.h"
#include "palmar/workflow/study/study_export.h"
#include "palmar/workflow/study/study_report.h"
#include "palmar/workflow/study/study_shards.h"
#include "palmar/workflow/words/hold_words.h"
#include "study_table.h"
#include "task.h"

namespace palmar::python {
namespace {

constexpr const char* kSaidByFile = "a study file says it";

/// A study file, or products and who holds them.
records::StudyRequest study_request(Arguments& arguments) {
  records::StudyRequest request;
  std::string file;
  if (arguments.take("file", file)) {
    std::vector<std::string> products;
    arguments.take("products", products);
    if (!products.empty()) {
      throw UsageError("setting \"products\" doesn't go with the others: a study file says it");
    }
    request = records::read_study_file(file);
  } else {
    workflow::QuickStudy quick;
    arguments.take("products", quick.products);
    if (quick.products.empty()) {
      throw UsageError("what is to be studied is not said: a study file or a product is required");
    }
    arguments.take("unit", quick.unit);
    arguments.take("population", quick.populations);
    arguments.take("hands", quick.hands);
    arguments.take("profile", quick.profiles);
    arguments.take("grip", quick.grips);
    quick.holding = holding_of(arguments);
    arguments.take("hand", quick.hand);
    arguments.take("mass_kg", quick.mass);
    std::string task = "usual";
    arguments.take("task", task);
    quick.task = grasp::hand_task_named(task);
    arguments.take("turn_n_m", quick.turn);
    arguments.take("grip_force_n", quick.grip_force);
    arguments.take("strength_share", quick.strength_share);
    arguments.take("limit_depths", quick.limit_depths);
    request = workflow::study_of(quick);
  }
  std::uint64_t seed = 0;
  if (arguments.take("seed", seed) && seed != 0) request.seed = seed;
  return request;
}

py::dict summary(const workflow::StudyRunOutcome& outcome) {
  py::dict counts, reasons;
  for (const auto& [how, count] : outcome.outcomes) counts[py::str(name_of(how))] = count;
  for (const auto& [reason, count] : outcome.reasons) reasons[py::str(reason)] = count;
  return py::dict(py::arg("study") = outcome.plan.name, py::arg("store") = outcome.store.string(),
                  py::arg("shard") = name_of(outcome.shard), py::arg("grasps") = outcome.grasps,
                  py::arg("run_now") = outcome.run_now, py::arg("outcomes") = counts,
                  py::arg("failed") = reasons, py::arg("seconds") = outcome.seconds,
                  py::arg("results_sha256") = outcome.digest);
}

py::dict run(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::StudyRunRequest request;
  request.study = study_request(arguments);
  arguments.take("out", request.out);
  std::vector<double> shard;
  if (arguments.take("shard", shard)) {
    if (shard.size() != 2) throw UsageError("setting \"shard\": two numbers (k, n) are required");
    request.shard = {static_cast<int>(shard[0]), static_cast<int>(shard[1])};
  }
  arguments.finish(kSaidByFile);
  return summary(
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink& notes) {
        request.note = notes;
        return run_study(request, watch);
      }));
}

py::dict resume(const std::string& store, const py::object& progress, const py::object& note) {
  return summary(
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink& notes) {
        return workflow::resume_study(store, notes, watch);
      }));
}

py::dict plan(py::dict given, const py::object& progress, const py::object& note) {
  Arguments arguments(std::move(given));
  workflow::StudyPlanRequest request;
  request.study = study_request(arguments);
  arguments.take("sample", request.has_sample);
  arguments.finish(kSaidByFile);
  const workflow::StudyPlanOutcome outcome =
      run_task({progress, note}, [&](const Progress& watch, const workflow::NoteSink& notes) {
        request.note = notes;
        return workflow::plan_study(request, watch);
      });
  py::dict result = from_json(records::format_plan(outcome.plan));
  result["grasps"] = study::task_count(outcome.plan);
  if (const auto& estimate = outcome.estimate) {
    const auto hands = static_cast<std::int64_t>(outcome.plan.hands.size());
    result["threads"] = outcome.threads;
    result["estimated_seconds"] = estimate->seconds(hands, outcome.threads);
    result["estimated_memory_mb"] = estimate->memory(outcome.threads);
  }
  return result;
}

py::dict merge(const std::vector<std::string>& shards, const std::string& out,
               const py::object& progress) {
  const std::vector<std::filesystem::path> paths(shards.begin(), shards.end());
  const workflow::StudyMergeOutcome outcome =
      run_task({progress, {}}, [&](const Progress& watch, const workflow::NoteSink&) {
        return workflow::merge_shards(paths, out, watch);
      });
  return py::dict(py::arg("study") = outcome.plan.name, py::arg("store") = out,
                  py::arg("grasps") = study::task_count(outcome.plan),
                  py::arg("shards") = outcome.shards, py::arg("results_sha256") = outcome.digest);
}

py::dict status(const std::vector<std::string>& stores) {
  const std::vector<std::filesystem::path> paths(stores.begin(), stores.end());
  const workflow::StudyStatus found = run_task({}, [&](const Progress&, const workflow::NoteSink&) {
    return workflow::study_status(paths);
  });
  py::list all;
  for (const workflow::StudyStoreState& one : found.stores) {
    all.append(py::dict(py::arg("store") = one.path.string(), py::arg("state") = one.state,
                        py::arg("detail") = one.detail, py::arg("shard") = name_of(one.shard),
                        py::arg("done") = one.done, py::arg("total") = one.total,
                        py::arg("seconds_left") = one.seconds_left));
  }
  return py::dict(py::arg("stores") = all, py::arg("absent_shards") = found.absent_shards,
                  py::arg("done") = found.done, py::arg("total") = found.total,
                  py::arg("failed") = found.failed);
}

py::str report(py::dict given, const py::object& progress) {
  Arguments arguments(std::move(given));
  workflow::StudyReportRequest request;
  arguments.take("store", request.store);
  arguments.take("out", request.folder);
  arguments.take("threshold_kpa", request.report.threshold, 1e-3);
  arguments.take("significance", request.report.comparison.significance);
  arguments.take("most_grasps", request.report.most_grasps);
  arguments.take("language", request.report.language);
  arguments.take("pictures", request.report.pictures);
  arguments.take("figures", request.report.figure_files);
  arguments.take("excel", request.report.extras.excel);
  std::string project;
  if (arguments.take("project", project))
    request.report.extras.project = records::read_project(project);
  arguments.finish();
  return run_task({progress, {}},
                  [&](const Progress& watch, const workflow::NoteSink&) {
                    return workflow::report_study(request, watch);
                  })
      .string();
}

std::vector<std::string> export_tables(const std::string& store, const std::string& folder,
                                       bool with_fields, const py::object& progress) {
  const workflow::StudyExportRequest request{store, folder, with_fields};
  const workflow::StudyExportOutcome outcome =
      run_task({progress, {}}, [&](const Progress& watch, const workflow::NoteSink&) {
        return workflow::export_study(request, watch);
      });
  std::vector<std::string> files;
  for (const std::filesystem::path& one : outcome.files) files.push_back(one.string());
  return files;
}

/// The study's answer and statistics; everything that its report's tables hold.
py::dict statistics(py::dict given) {
  Arguments arguments(std::move(given));
  workflow::StudyCompareRequest request;
  arguments.take("store", request.store);
  arguments.take("quantities", request.quantities);
  arguments.take("significance", request.comparison.significance);
  arguments.take("language", request.language);
  arguments.finish();
  struct Found {
    workflow::StudyCompareOutcome compared;
    study::StudyAnalysis analysis;
  };
  const Found found = run_task({}, [&](const Progress&, const workflow::NoteSink&) {
    Found one{workflow::compare_study(request), {}};
    one.analysis = study::analyse_study(one.compared.results, request.comparison);
    return one;
  });
  py::dict result;
  const report::StudyAnswer& answer = found.compared.answer;
  result["sentence"] = answer.sentence;
  result["reasons"] = answer.reasons;
  for (const report::NamedTable& one : report::study_csv(found.compared.results, found.analysis)) {
    result[py::str(std::filesystem::path(one.name).stem().string())] = table(one.table);
  }
  return result;
}

py::dict grasps(const std::string& store) {
  const workflow::StudyCompareOutcome outcome =
      run_task({}, [&](const Progress&, const workflow::NoteSink&) {
        workflow::StudyCompareRequest request;
        request.store = store;
        return workflow::compare_study(request);
      });
  return grasp_table(outcome.results);
}

}  // namespace

void bind_studies(py::module_& module) {
  module.def("study_run", &run, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("study_resume", &resume, py::arg("store"), py::arg("progress"), py::arg("note"));
  module.def("study_plan", &plan, py::arg("arguments"), py::arg("progress"), py::arg("note"));
  module.def("study_merge", &merge, py::arg("shards"), py::arg("out"), py::arg("progress"));
  module.def("study_status", &status, py::arg("stores"));
  module.def("study_report", &report, py::arg("arguments"), py::arg("progress"));
  module.def("study_export", &export_tables, py::arg("store"), py::arg("folder"), py::arg("fields"),
             py::arg("progress"));
  module.def("study_statistics", &statistics, py::arg("arguments"));
  module.def("study_grasps", &grasps, py::arg("store"));
}

}  // namespace palmar::python
