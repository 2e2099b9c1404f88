// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "photos/photo_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <numbers>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/core/version.h"
#include "palmar/formats/file.h"
#include "palmar/formats/mesh/ply.h"
#include "palmar/formats/sha256.h"
#include "palmar/records/json_values.h"
#include "photos/photo_cameras.h"
#include "photos/photo_lenses.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

Json report_of(const PosedPhotographs& work, const PhotoModel& model, double seconds) {
  constexpr double kInDegrees = 180.0 / std::numbers::pi;
  const HandMotion& motion = work.motion;
  Json photographs = Json::array();
  std::size_t k = 0;
  for (std::size_t i = 0; i < work.set.photographs.size(); ++i) {
    const PhotoFile& file = work.set.photographs[i];
    Json one = {{"file", file.path.filename().string()},
                {"camera", file.camera},
                {"position", file.position},
                {"corners", work.seen[i].corners.size()},
                {"sharpness", work.seen[i].sharpness},
                {"is_used", work.pose[i].has_value()}};
    if (work.pose[i]) {
      const Rigid3& pose = work.pose[i]->camera_from_world;
      const PhotoUse& use = model.photographs[k++];
      one["board_residual_px"] = work.pose[i]->rms;
      one["rotation_wxyz"] = {pose.rotation.w(), pose.rotation.x(), pose.rotation.y(),
                              pose.rotation.z()};
      one["translation_mm"] = vector3(pose.translation);
      one["mask_share"] = use.mask_share;
      one["around_share"] = use.around_share;
      one["glare_share"] = use.glare_share;
      one["depth_share"] = use.depth_share;
      one["agreeing_share"] = use.kept_share;
      one["gain"] = use.gain;
    }
    photographs.push_back(std::move(one));
  }
  Json moves = Json::array();
  for (const Rigid3& one : motion.board_from_hand) {
    moves.push_back({{"rotation_wxyz",
                      {one.rotation.w(), one.rotation.x(), one.rotation.y(), one.rotation.z()}},
                     {"translation_mm", vector3(one.translation)}});
  }
  return {{"lenses_were_given", work.lenses_were_given},
          {"lenses", Json::parse(format_lenses(work.lenses)).at("cameras")},
          {"motion",
           {{"points", motion.tracks},
            {"median_residual_px", motion.after},
            {"median_residual_without_px", motion.before},
            {"is_corrected", motion.is_applied},
            {"largest_shift_mm", motion.largest_shift},
            {"largest_turn_deg", motion.largest_turn * kInDegrees},
            {"board_from_hand", std::move(moves)}}},
          {"reduction", model.reduction},
          {"hull_volume_mm3", model.hull_volume},
          {"points", model.points},
          {"vertices", model.skin.mesh.vertices.size()},
          {"triangles", model.skin.mesh.triangles.size()},
          {"measured_share", model.measured_share},
          {"has_background", model.has_background},
          {"gloss_share", model.light.gloss},
          {"light_change_share", model.light.change},
          {"seconds", seconds},
          {"warnings", work.warnings},
          {"photographs", std::move(photographs)}};
}

/// Digest of all that a mesh depends on.
std::string key_of(const PhotoSet& set, const std::optional<PhotoLenses>& lenses,
                   const PhotoMeshArguments& arguments) {
  const PhotoModelOptions& model = arguments.model;
  Sha256 digest;
  digest.add(fmt::format("{} {} {:g} {:g};", build_description(), set.board.squares,
                         set.board.square, set.board.marker));
  digest.add(
      fmt::format("{} {:g} {:g} {};", arguments.box, model.cut, model.pixel, arguments.no_motion));
  digest.add(lenses ? format_lenses(*lenses) : std::string("no lenses"));
  for (const PhotoFile& file : set.photographs) {
    const std::string bytes = read_file(file.path);
    digest.add(fmt::format("{} {} {} {}:", file.path.filename().string(), file.camera,
                           file.position, bytes.size()));
    digest.add(bytes);
  }
  return digest.hex();
}

/// The report of an earlier run that made the same mesh, if that is still there.
std::optional<Json> kept_report(const fs::path& mesh, const fs::path& report,
                                const std::string& key) {
  std::error_code ignored;
  if (!fs::exists(mesh, ignored) || !fs::exists(report, ignored)) return {};
  try {
    Json json = Json::parse(read_file(report));
    if (json.at("key") != key || json.at("mesh_sha256") != sha256_hex(read_file(mesh))) return {};
    return json;
  } catch (const Json::exception&) {
    return {};
  }
}

}  // namespace

void PhotoMeshArguments::add_to(CLI::App& verb) {
  verb.add_option("--lenses", lenses,
                  "Lenses: a file of palmar photos calibrate, or a folder of photographs of the "
                  "tilted board; without, they are found from the photographs of the hand, which "
                  "tell less");
  verb.add_option("--box-mm", box,
                  "Width, depth, height of the space above the board's middle that holds the hand")
      ->capture_default_str();
  verb.add_option("--cut-mm", model.cut, "The mesh ends so far above the board")
      ->capture_default_str();
  verb.add_option("--pixel-mm", model.pixel, "What a pixel covers on the hand, for stereo")
      ->capture_default_str();
  verb.add_flag("--no-motion", no_motion, "The hand surely did not move: don't look for it");
}

void PhotoMeshArguments::check() {
  const Vec3 size = parse_vector("--box-mm", box);
  model.box = Box3(Vec3(-0.5 * size.x(), -0.5 * size.y(), 0.0),
                   Vec3(0.5 * size.x(), 0.5 * size.y(), size.z()));
  model.check();
}

PhotoMeshPlan plan_photo_mesh(const std::string& folder, const fs::path& mesh,
                              const std::optional<PhotoLenses>& lenses,
                              const PhotoMeshArguments& arguments) {
  PhotoMeshPlan plan;
  plan.folder = folder;
  plan.mesh = mesh;
  plan.set = read_photo_set(folder);
  plan.key = key_of(plan.set, lenses, arguments);
  plan.kept = kept_report(mesh, report_beside(mesh), plan.key);
  // Measured: 36 photographs of 1.5 MP take about 60 s of two cores.
  constexpr double kSecondsPerPhotograph = 2.7;  // of one core
  if (!plan.kept) {
    plan.seconds = 8.0 + kSecondsPerPhotograph * static_cast<double>(plan.set.photographs.size()) /
                             std::max(1, thread_count());
  }
  return plan;
}

Json make_photo_mesh(const PhotoMeshPlan& plan, const std::optional<PhotoLenses>& lenses,
                     const PhotoMeshArguments& arguments, const Progress& progress) {
  if (plan.kept) return *plan.kept;
  const auto began = std::chrono::steady_clock::now();
  PhotoModelOptions options = arguments.model;
  options.board_half = 0.5 * plan.set.board.edge();
  PosedPhotographs work = pose_photographs(plan.folder, plan.set, lenses, options,
                                           !arguments.no_motion, part_of(progress, 0.0, 0.3));
  const PhotoModel model = make_photo_model(work.photographs, options, part_of(progress, 0.3, 1.0));
  work.warnings.insert(work.warnings.end(), model.warnings.begin(), model.warnings.end());
  constexpr double kHonest = 0.8;
  if (model.measured_share < kHonest) {
    work.warnings.push_back(fmt::format(
        "only {:.0f} % of the surface was measured; the rest is a guess (property measured = 0)",
        100.0 * model.measured_share));
  }
  PlyByteProperty views{"views", {}}, measured{"measured", {}};
  for (std::size_t v = 0; v < model.views.size(); ++v) {
    views.value.push_back(static_cast<std::uint8_t>(std::min(255, model.views[v])));
    measured.value.push_back(static_cast<std::uint8_t>(model.measured[v]));
  }
  const std::string bytes = format_ply(model.skin, {views, measured});
  write_file(plan.mesh, bytes);
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  Json report = report_of(work, model, seconds);
  report["key"] = plan.key;
  report["mesh_sha256"] = sha256_hex(bytes);
  write_file(report_beside(plan.mesh), report.dump(1) + "\n");
  return report;
}

fs::path report_beside(const fs::path& mesh) { return fs::path(mesh).replace_extension(".json"); }

std::string photo_mesh_text(const Json& report) {
  const Json& motion = report.at("motion");
  std::size_t used = 0;
  double residual = 0.0;
  for (const Json& one : report.at("photographs")) {
    if (!one.at("is_used").get<bool>()) continue;
    ++used;
    residual += one.at("board_residual_px").get<double>();
  }
  const int points = motion.at("points").get<int>();
  const double after = motion.at("median_residual_px").get<double>();
  std::string moved = "not looked for";
  if (motion.at("is_corrected").get<bool>()) {
    moved = fmt::format(
        "corrected, up to {:.2f} mm and {:.2f} deg ({} points, {:.2f} -> {:.2f} px)",
        motion.at("largest_shift_mm").get<double>(), motion.at("largest_turn_deg").get<double>(),
        points, motion.at("median_residual_without_px").get<double>(), after);
  } else if (points > 0) {
    moved = fmt::format("none found ({} points, {:.2f} px)", points, after);
  }
  return fmt::format(
      "photographs  {} of {} used, board {:.2f} px\n"
      "motion       {}\n"
      "surface      {} points, {} triangles, {:.1f} % of the area measured\n",
      used, report.at("photographs").size(), residual / static_cast<double>(used), moved,
      report.at("points").get<std::size_t>(), report.at("triangles").get<std::size_t>(),
      100.0 * report.at("measured_share").get<double>());
}

}  // namespace palmar::cli
