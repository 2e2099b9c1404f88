// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/assess_bench.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/records/bench/bench_project.h"
#include "palmar/report/page/assessment_report.h"
#include "palmar/workflow/live/live_person.h"
#include "palmar/workflow/live/live_session.h"

namespace palmar::workflow {
namespace {

constexpr double kBenchOpened = 0.2, kBenchAssessed = 0.7;  // shares of the whole

/// A folder that goes with it.
class UnpackingFolder {
 public:
  UnpackingFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "palmar-project-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) {
      throw OutputError(name + ": the folder can't be made: " + std::strerror(errno));
    }
    path_ = name;
  }
  UnpackingFolder(const UnpackingFolder&) = delete;
  UnpackingFolder& operator=(const UnpackingFolder&) = delete;
  ~UnpackingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// What a file in a project gives. Messages name the project and the file in it, not the folder
/// where it was unpacked.
template <typename Read>
auto unpacked(const std::filesystem::path& project, const std::string& what,
              const std::string& file_name, const std::string& bytes, Read read) {
  const UnpackingFolder folder;
  const std::filesystem::path path = folder.path() / file_name;
  formats::write_file(path, bytes);
  try {
    return read(path);
  } catch (const InputError& error) {
    std::string message = error.what();
    for (std::size_t at = message.find(path.string()); at != std::string::npos;
         at = message.find(path.string())) {
      message.replace(at, path.string().size(), file_name);
    }
    throw InputError(project.string() + ": its " + what + " " + message);
  }
}

std::shared_ptr<const product::Product> bench_product(const std::filesystem::path& file,
                                                      const records::BenchProject& project,
                                                      const Progress& progress) {
  return unpacked(file, "product", project.file_name, project.bytes,
                  [&](const std::filesystem::path& path) {
                    auto product = std::make_shared<product::Product>(
                        load_product(ProductChoice(path, {.unit = project.unit}), progress));
                    add_findings(*product);
                    product->source = project.file_name;
                    return std::shared_ptr<const product::Product>(std::move(product));
                  });
}

study::AssessmentSet shown_on_bench(LiveSession& session, const records::BenchProject& project,
                                    const LiveTask& task, const Progress& progress) {
  if (!project.pose) {
    session.holds(part_of(progress, 0.0, 0.3));
    return session.take_hold(project.hold, task, part_of(progress, 0.3, 1.0));
  }
  const LivePose pose{project.pose->posture, project.pose->product_from_hand};
  const grasp::Grip grip = project.pose->grip.value_or(grasp::Grip::kMediumWrap);
  switch (project.settle) {
    case records::BenchSettle::kClose:
      return session.close_here(pose, project.pose->grip, task, progress);
    case records::BenchSettle::kRest:
      return session.rest_here(pose, grip, task, progress);
    case records::BenchSettle::kAsPlaced:
      break;
  }
  return session.evaluate_here(pose, grip, task, progress);
}

}  // namespace

bool is_bench_project(const std::filesystem::path& file) {
  return file.string().ends_with(records::kBenchProjectEnding);
}

AssessOutcome assess_bench_project(const BenchAssessRequest& request, const Progress& progress) {
  const records::BenchProject project = records::read_bench_project(request.file);
  if (request.grip_force && project.pose && project.settle == records::BenchSettle::kAsPlaced) {
    throw UsageError(request.file.string() +
                     ": hand and product are taken as they were placed, so the grip force is what "
                     "comes of it and can't be given; let the grasp come to rest in the workbench");
  }
  HandChoice choice;
  try {
    if (!project.person.empty()) choice.person = parse_person_of_size(project.person);
  } catch (const UsageError& error) {
    throw InputError(request.file.string() + ": \"hand\": " + error.what());
  }
  choice.is_left = project.is_left;
  if (!project.hand_file.empty()) {
    choice.value =
        unpacked(request.file, "hand", project.hand_file, project.hand_bytes,
                 [](const std::filesystem::path& path) { return load_hand(path.string()); });
  }
  const AssessRequest& report = request.report;
  if (!report.out.empty()) report::check_report_folder(report.out);

  LiveTask task;
  task.rest.grip_force = request.grip_force ? request.grip_force : project.grip_force;
  task.friction = request.friction;
  task.rest.check();
  task.friction.check();
  progress.update(0.0, "reading the product");
  auto product = bench_product(request.file, project, progress);
  for (const std::string& text : product->notes) {
    note_to(report.note, project.file_name + ": " + text);
  }
  progress.update(0.0, "preparing the hand");
  LiveSession session(prepare_live_hand(choice), std::move(product));

  AssessOutcome outcome;
  outcome.asked = 1;
  outcome.set = shown_on_bench(session, project, task_of_person(task, choice.person),
                               part_of(progress, kBenchOpened, kBenchAssessed));
  outcome.set.command_line = report.command_line;
  study::Assessment& assessment = outcome.set.assessments.front().assessment;
  assessment.options.seed = report.seed;
  if (assessment.contact.status == contact::ContactStatus::kNotConverged) {
    note_to(report.note, project.file_name + ": " + assessment.contact.message);
    outcome.has_converged = false;
  }
  finish_assessment(report, progress, outcome);
  return outcome;
}

}  // namespace palmar::workflow
