// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <thread>

#include "cli.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/records/product/cad_file.h"
#include "palmar/records/study/study_store.h"
#include "palmar/workflow/hand/tissue_on_bone.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;

/// One line of the examination: what was looked at, whether it is well, and what to do if not.
struct Finding {
  std::string what;
  bool is_well = false;
  std::string detail;
};

Finding examine(const std::string& what, const std::function<std::string()>& look) {
  try {
    return {what, true, look()};
  } catch (const std::exception& error) {
    return {what, false, error.what()};
  }
}

std::string template_state() {
  const auto hand = workflow::load_hand("template");
  return fmt::format("{} vertices, {} bones", hand->skin.vertex_count(), hand->bones.size());
}

std::string asset_state() {
  const std::string path = workflow::share_folder() + "/generic-hand-right.glb";
  return fmt::format("{} ({} bytes)", path, formats::read_file(path).size());
}

std::string compliance_state() {
  const std::string path = workflow::template_compliance_file();
  return fmt::format("{} ({:.0f} MB)", path, static_cast<double>(fs::file_size(path)) / 1e6);
}

std::string distance_state() {
  const geometry::MeshDistance sphere(geometry::make_icosphere(30.0, 4));
  const double distance = sphere.at(Vec3(0, 0, 10)).distance;  // -20 mm but for the chords
  if (std::abs(distance + 20.0) > 0.1) {
    throw NumericalError(
        fmt::format("a test sphere's distance is {} mm; -20 mm is right", distance));
  }
  return "works (Embree)";
}

std::string temporary_state() {
  const fs::path folder = fs::temp_directory_path();
  const fs::path probe = folder / fmt::format("palmar-doctor-{}", getpid());
  formats::write_file(probe.string(), "probe");
  fs::remove(probe);
  return folder.string() + " is writable";
}

std::string slurm_state() {
  const auto sbatch = formats::find_program("sbatch");
  return sbatch ? sbatch->string() + " (optional)"
                : "not installed; only `palmar study submit` needs it (optional)";
}

std::string memory_state() {
  const double available = static_cast<double>(sysconf(_SC_AVPHYS_PAGES)) *
                           static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
  if (available < 500.0) {
    throw CheckFailed(fmt::format("{:.0f} MB are free; 500 MB are needed", available));
  }
  return fmt::format("{:.0f} MB free", available);
}

int run_doctor(const CommonOptions& common) {
  const std::vector<Finding> findings = {
      examine("template hand", template_state),
      examine("template on bone", compliance_state),
      examine("generic hand asset", asset_state),
      examine("nearest points", distance_state),
      examine("temporary folder", temporary_state),
      examine("memory", memory_state),
      examine("CAD (palmar-cad)", [] { return "OpenCASCADE " + records::cad_kernel_version(); }),
      examine("study stores", [] { return "SQLite " + records::sqlite_version(); }),
      examine("Slurm", slurm_state),
      examine("threads", [] {
        return fmt::format("{} of {} cores", thread_count(), std::thread::hardware_concurrency());
      })};
  int missing = 0;
  std::string text = common.json ? "{\"build\": \"" + build_description() + "\", \"findings\": ["
                                 : build_description() + "\n";
  for (const Finding& finding : findings) {
    missing += finding.is_well ? 0 : 1;
    if (common.json) {
      text += fmt::format("{}{{\"what\": \"{}\", \"is_well\": {}}}",
                          &finding == &findings[0] ? "" : ", ", finding.what, finding.is_well);
    } else {
      text += fmt::format("{:<8} {:<20} {}\n", finding.is_well ? "ok" : "MISSING", finding.what,
                          finding.detail);
    }
  }
  print(text + (common.json ? "]}\n" : ""));
  if (missing > 0) {
    throw CheckFailed(
        fmt::format("{} of {} things are missing or broken (see above); building Palmar "
                    "with ./demo or ./check makes the template hand",
                    missing, findings.size()));
  }
  return 0;
}

}  // namespace

void add_doctor_command(CLI::App& app, Context& context) {
  CLI::App* verb = add_verb(
      app, "doctor", "Show what Palmar needs on this machine and what is missing", "palmar doctor");
  verb->callback([&context] { context.run = [&context] { return run_doctor(context.common); }; });
}

}  // namespace palmar::cli
