// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/person_workflow/steps/photo_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "hands/person_workflow/steps/photo_cameras.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/formats/sha256.h"

namespace palmar::person_workflow {
namespace {

namespace fs = std::filesystem;

/// Digest of all that a mesh depends on.
std::string digest_of(const person_records::PhotoSet& set,
                      const std::optional<person_records::PhotoLenses>& lenses,
                      const PhotoMeshOptions& options) {
  const capture::PhotoModelOptions& model = options.model;
  const Vec3 box = model.box.sizes();
  formats::Sha256 digest;
  digest.add(fmt::format("{} {} {:g} {:g};", build_description(), set.board.squares,
                         set.board.square, set.board.marker));
  digest.add(fmt::format("{:g},{:g},{:g} {:g} {:g} {};", box.x(), box.y(), box.z(), model.cut,
                         model.pixel, !options.looks_for_motion));
  digest.add(lenses ? person_records::format_lenses(*lenses) : std::string("no lenses"));
  for (const person_records::PhotoFile& file : set.photographs) {
    const std::string bytes = formats::read_file(file.path);
    digest.add(fmt::format("{} {} {} {}:", file.path.filename().string(), file.camera,
                           file.position, bytes.size()));
    digest.add(bytes);
  }
  return digest.hex();
}

/// The report of an earlier run that made the same mesh, if that is still there.
std::optional<PhotoMeshReport> kept_report(const fs::path& mesh, const std::string& key) {
  const fs::path report = report_beside(mesh);
  std::error_code ignored;
  if (!fs::exists(mesh, ignored) || !fs::exists(report, ignored)) return {};
  return read_photo_mesh_report(formats::read_file(report), key,
                                formats::sha256_hex(formats::read_file(mesh)));
}

}  // namespace

void PhotoMeshOptions::check() const { model.check(); }

PhotoMeshPlan plan_photo_mesh(const std::string& folder, const fs::path& mesh,
                              const std::optional<person_records::PhotoLenses>& lenses,
                              const PhotoMeshOptions& options) {
  PhotoMeshPlan plan;
  plan.folder = folder;
  plan.mesh = mesh;
  plan.set = person_records::read_photo_set(folder);
  plan.key = digest_of(plan.set, lenses, options);
  plan.kept = kept_report(mesh, plan.key);
  // Measured: 36 photographs of 1.5 MP take about 60 s of two cores.
  constexpr double kSecondsPerPhotograph = 2.7;  // of one core
  if (!plan.kept) {
    plan.seconds = 8.0 + kSecondsPerPhotograph * static_cast<double>(plan.set.photographs.size()) /
                             std::max(1, thread_count());
  }
  return plan;
}

PhotoMeshReport make_planned_mesh(const PhotoMeshPlan& plan,
                                  const std::optional<person_records::PhotoLenses>& lenses,
                                  const PhotoMeshOptions& options, const Progress& progress) {
  if (plan.kept) return *plan.kept;
  const auto began = std::chrono::steady_clock::now();
  capture::PhotoModelOptions how = options.model;
  how.board_half = 0.5 * plan.set.board.edge();
  PosedPhotographs work =
      pose_photographs(plan.folder, plan.set, lenses, how, options, part_of(progress, 0.0, 0.3));
  const capture::PhotoModel model =
      capture::make_photo_model(work.photographs, how, part_of(progress, 0.3, 1.0));
  for (const std::string& text : model.warnings) {
    work.warnings.push_back(with_setting_names(text, options.setting_names));
  }
  constexpr double kHonest = 0.8;
  if (model.measured_share < kHonest) {
    work.warnings.push_back(fmt::format(
        "only {:.0f} % of the surface was measured; the rest is a guess (property measured = 0)",
        100.0 * model.measured_share));
  }
  formats::PlyByteProperty views{"views", {}}, measured{"measured", {}};
  for (std::size_t v = 0; v < model.views.size(); ++v) {
    views.value.push_back(static_cast<std::uint8_t>(std::min(255, model.views[v])));
    measured.value.push_back(static_cast<std::uint8_t>(model.measured[v]));
  }
  const std::string bytes = formats::format_ply(model.skin, {views, measured});
  formats::write_file(plan.mesh, bytes);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  PhotoMeshReport report =
      photo_mesh_report(work, model, seconds, plan.key, formats::sha256_hex(bytes));
  formats::write_file(report_beside(plan.mesh), report.json);
  return report;
}

fs::path report_beside(const fs::path& mesh) { return fs::path(mesh).replace_extension(".json"); }

}  // namespace palmar::person_workflow
