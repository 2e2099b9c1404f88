// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>

#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/imaging/distance_transform.h"
#include "palmar/io/file.h"
#include "palmar/io/json_values.h"
#include "palmar/io/photo_set.h"
#include "palmar/io/photo_worker.h"
#include "palmar/io/ply.h"
#include "palmar/io/texture_file.h"
#include "palmar/photo/hand_motion.h"
#include "palmar/photo/photo_model.h"
#include "photos_commands.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr double kDegree = std::numbers::pi / 180.0;

struct PhotosMeshArguments {
  std::string folder, out, lenses;
  std::string box = "220,220,260";
  bool no_motion = false;
  PhotoModelOptions model;
};

/// What became of a set of photographs before any surface was made.
struct PosedPhotographs {
  PhotoSet set;
  std::vector<BoardSighting> seen;             ///< per file of the set
  std::vector<std::optional<BoardPose>> pose;  ///< per file
  PhotoLenses lenses;
  std::vector<std::size_t> used;        ///< files with a pose
  std::vector<Photograph> photographs;  ///< of those
  std::vector<std::string> warnings;
  bool lenses_were_given = false;
};

/// Lenses of a file, or from the photographs themselves, camera by camera.
void find_lenses(PosedPhotographs& work, const std::string& folder, const std::string& file) {
  std::map<std::string, std::vector<std::size_t>> by_camera;
  for (std::size_t i = 0; i < work.set.photographs.size(); ++i) {
    by_camera[work.set.photographs[i].camera].push_back(i);
  }
  if (!file.empty()) {
    work.lenses = read_lenses(file);
    work.lenses_were_given = true;
    for (const auto& [camera, photographs] : by_camera) {
      const auto found = work.lenses.find(camera);
      if (found == work.lenses.end()) {
        throw InputError(fmt::format("{}: no lens of camera \"{}\" ({})", file, camera,
                                     work.set.photographs[photographs.front()].path.string()));
      }
      for (const std::size_t i : photographs) {
        const PhotoLens& lens = found->second.lens;
        if (work.seen[i].width != lens.width || work.seen[i].height != lens.height) {
          throw InputError(fmt::format("{}: {} x {} pixels; its camera's lens in {} is for {} x {}",
                                       work.set.photographs[i].path.string(), work.seen[i].width,
                                       work.seen[i].height, file, lens.width, lens.height));
        }
      }
    }
    return;
  }
  for (const auto& [camera, photographs] : by_camera) {
    std::vector<std::vector<BoardCorner>> corners;
    const BoardSighting& first = work.seen[photographs.front()];
    for (const std::size_t i : photographs) {
      if (work.seen[i].width != first.width || work.seen[i].height != first.height) {
        throw InputError(
            fmt::format("{}: {} x {} pixels; other photographs of camera {} have {} x {}",
                        work.set.photographs[i].path.string(), work.seen[i].width,
                        work.seen[i].height, camera, first.width, first.height));
      }
      corners.push_back(work.seen[i].corners);
    }
    work.lenses[camera] =
        calibrate_lens(first.width, first.height, corners, folder + ": camera " + camera);
    constexpr double kLoose = 3.0;  // pixels
    const LensCalibration& lens = work.lenses[camera];
    if (lens.centre_deviation > kLoose || lens.focal_deviation > kLoose) {
      work.warnings.push_back(fmt::format(
          "camera {}: these photographs tell its focal length to {:.0f} px and its centre to "
          "{:.0f} "
          "px only; `palmar photos calibrate` with the board tilted does better (--lenses)",
          camera, lens.focal_deviation, lens.centre_deviation));
    }
  }
}

/// Names of photographs, the first few.
std::string some_names(const PhotoSet& set, const std::vector<std::size_t>& which) {
  std::string text;
  constexpr std::size_t kMost = 4;
  for (std::size_t i = 0; i < std::min(kMost, which.size()); ++i) {
    text += (i > 0 ? ", " : "") + set.photographs[which[i]].path.filename().string();
  }
  return text + (which.size() > kMost ? ", ..." : "");
}

void find_poses(PosedPhotographs& work, const std::string& folder) {
  std::vector<std::size_t> lost, blurred;
  std::vector<double> sharpness;
  for (std::size_t i = 0; i < work.set.photographs.size(); ++i) {
    const PhotoLens& lens = work.lenses.at(work.set.photographs[i].camera).lens;
    std::optional<BoardPose> pose = find_board_pose(lens, work.seen[i].corners);
    constexpr double kWorst = 2.0;  // pixels
    if (pose && pose->rms > kWorst) pose.reset();
    if (pose) {
      work.used.push_back(i);
      sharpness.push_back(work.seen[i].sharpness);
    } else {
      lost.push_back(i);
    }
    work.pose.push_back(pose);
  }
  const std::size_t count = work.set.photographs.size();
  if (2 * lost.size() > count) {
    throw InputError(fmt::format(
        "{}: the board isn't seen in {} of {} photographs ({}): it is covered, blurred, or another "
        "than {} x {} squares with 5 x 5 markers",
        folder, lost.size(), count, some_names(work.set, lost), work.set.board.squares,
        work.set.board.squares));
  }
  if (!lost.empty()) {
    work.warnings.push_back(
        fmt::format("the board isn't seen in {} of {} photographs, which are "
                    "left out: {}",
                    lost.size(), count, some_names(work.set, lost)));
  }
  std::vector<double> sorted = sharpness;
  std::sort(sorted.begin(), sorted.end());
  constexpr double kBlurred = 0.12, kMuchBlurred = 0.05;
  const double typical = sorted[sorted.size() / 2];
  if (typical < kMuchBlurred) {
    throw InputError(
        fmt::format("{}: the photographs are blurred: edges of the print are spread over "
                    "about {:.0f} pixels",
                    folder, 1.0 / std::max(typical, 0.01)));
  }
  for (std::size_t k = 0; k < work.used.size(); ++k) {
    if (sharpness[k] < std::min(kBlurred, 0.6 * typical)) blurred.push_back(work.used[k]);
  }
  if (!blurred.empty()) {
    work.warnings.push_back(fmt::format("{} photographs are blurred: {}", blurred.size(),
                                        some_names(work.set, blurred)));
  }
}

void read_photographs(PosedPhotographs& work, const Progress& progress) {
  work.photographs.resize(work.used.size());
  progress.update(0.0, "reading photographs");
  parallel_for(static_cast<int>(work.used.size()), [&](int n) {
    progress.throw_if_cancelled();
    const auto k = static_cast<std::size_t>(n);
    const std::size_t i = work.used[k];
    const PhotoFile& file = work.set.photographs[i];
    Photograph& photograph = work.photographs[k];
    photograph.name = file.path.filename().string();
    photograph.image = read_texture(read_file(file.path), file.path.string());
    photograph.camera = {work.lenses.at(file.camera).lens, work.pose[i]->camera_from_world};
    photograph.position = file.position;
  });
}

/// How the hand moved from position to position, from points of its skin.
HandMotion find_motion(const std::vector<Photograph>& photographs, const PhotoModelOptions& options,
                       const Progress& progress) {
  const Vec3 middle = options.box.center();
  const int reduction = reduction_for(photographs, middle, options.pixel);
  std::vector<MatchPicture> pictures(photographs.size());
  std::vector<PhotoCamera> cameras(photographs.size());
  std::vector<int> positions;
  PhotoMaskOptions mask_options = options.mask;
  mask_options.grow = 0.0;
  progress.update(0.0, "looking for motion of the hand");
  parallel_for(static_cast<int>(photographs.size()), [&](int i) {
    progress.throw_if_cancelled();
    const auto p = static_cast<std::size_t>(i);
    const PhotoView view = make_view(photographs[p], reduction);
    PhotoMask mask = mask_hand(view, options.box, options.board_half, mask_options);
    cameras[p] = view.camera;
    VolumeGrid grid;
    grid.size = {view.width(), view.height(), 1};
    constexpr double kRim = 3.0;  // pixels; outlines belong to another point in every picture
    MatchPicture& picture = pictures[p];
    picture = {view.width(), view.height(), {}, eroded(grid, mask.inside, kRim)};
    for (const float grey : view.grey) picture.grey.push_back(static_cast<std::uint8_t>(grey));
  });
  for (const Photograph& photograph : photographs) positions.push_back(photograph.position);
  std::vector<std::array<int, 2>> pairs;
  constexpr double kWidest = 36.0;  // deg; beyond, points of the skin don't look alike
  for (std::size_t a = 0; a < photographs.size(); ++a) {
    for (std::size_t b = a + 1; b < photographs.size(); ++b) {
      const Vec3 one = (cameras[a].centre() - middle).normalized();
      const Vec3 other = (cameras[b].centre() - middle).normalized();
      if (one.dot(other) > std::cos(kWidest * kDegree)) {
        pairs.push_back({static_cast<int>(a), static_cast<int>(b)});
      }
    }
  }
  const PointMatches matches = match_points(pictures, pairs, part_of(progress, 0.2, 0.8));
  return fit_hand_motion(cameras, positions, matches);
}

Json report_of(const PosedPhotographs& work, const HandMotion& motion, const PhotoModel& model,
               double seconds) {
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
            {"largest_turn_deg", motion.largest_turn / kDegree},
            {"board_from_hand", std::move(moves)}}},
          {"reduction", model.reduction},
          {"hull_volume_mm3", model.hull_volume},
          {"points", model.points},
          {"vertices", model.skin.mesh.vertices.size()},
          {"triangles", model.skin.mesh.triangles.size()},
          {"measured_share", model.measured_share},
          {"has_background", model.has_background},
          {"seconds", seconds},
          {"warnings", work.warnings},
          {"photographs", std::move(photographs)}};
}

void note_motion(PosedPhotographs& work, const HandMotion& motion) {
  constexpr double kFarShift = 2.0, kFarTurn = 1.0;  // mm, deg
  constexpr int kFewTracks = 60;
  if (motion.tracks < kFewTracks) {
    work.warnings.push_back(fmt::format(
        "only {} points of the skin could be followed from position to position: whether the hand "
        "moved can't be told",
        motion.tracks));
  } else if (motion.largest_shift > kFarShift || motion.largest_turn > kFarTurn * kDegree) {
    work.warnings.push_back(fmt::format(
        "the hand moved by up to {:.1f} mm and {:.1f} deg between positions; this was corrected, a "
        "repeat with the wrist supported is better",
        motion.largest_shift, motion.largest_turn / kDegree));
  }
}

int run_mesh(PhotosMeshArguments arguments, const Context& context) {
  const auto began = std::chrono::steady_clock::now();
  const fs::path out(arguments.out);
  if (out.extension() != ".ply") {
    throw UsageError(arguments.out + ": the mesh is written as .ply, with colours");
  }
  const Vec3 size = parse_vector("--box-mm", arguments.box);
  arguments.model.box = Box3(Vec3(-0.5 * size.x(), -0.5 * size.y(), 0.0),
                             Vec3(0.5 * size.x(), 0.5 * size.y(), size.z()));
  arguments.model.check();
  PosedPhotographs work;
  work.set = read_photo_set(arguments.folder);
  arguments.model.board_half = 0.5 * work.set.board.edge();
  const Progress progress = make_progress(context.common);
  std::vector<fs::path> files;
  for (const PhotoFile& file : work.set.photographs) files.push_back(file.path);
  // Measured: 36 photographs of 1.5 MP take about 80 s of two cores.
  constexpr double kSecondsPerPhotograph = 4.5;  // of one core
  note(context.common,
       fmt::format("{} photographs; this takes about {:.0f} s", files.size(),
                   10.0 + kSecondsPerPhotograph * static_cast<double>(files.size()) /
                              std::max(1, thread_count())));
  work.seen = find_boards(work.set.board, files, part_of(progress, 0.0, 0.1));
  find_lenses(work, arguments.folder, arguments.lenses);
  find_poses(work, arguments.folder);
  read_photographs(work, part_of(progress, 0.1, 0.15));

  HandMotion motion;
  if (arguments.no_motion) {
  } else if (!work.set.is_described) {
    work.warnings.emplace_back(
        "which photographs were taken together isn't said (names like p3_c2.jpg, or photos.json), "
        "so motion of the hand between them isn't corrected");
  } else {
    motion = find_motion(work.photographs, arguments.model, part_of(progress, 0.15, 0.3));
    note_motion(work, motion);
  }
  if (motion.is_applied) {
    for (Photograph& photograph : work.photographs) {
      photograph.camera.camera_from_world =
          photograph.camera.camera_from_world *
          motion.board_from_hand[static_cast<std::size_t>(photograph.position)];
    }
  }
  const PhotoModel model =
      make_photo_model(work.photographs, arguments.model, part_of(progress, 0.3, 1.0));
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
  write_file(out, format_ply(model.skin, {views, measured}));
  const double seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  const Json report = report_of(work, motion, model, seconds);
  const fs::path report_path = fs::path(out).replace_extension(".json");
  write_file(report_path, report.dump(1) + "\n");
  finish_progress();
  for (const std::string& warning : work.warnings) note(context.common, "warning: " + warning);
  if (context.common.json) {
    print(report.dump(2) + "\n");
    return 0;
  }
  double residual = 0.0;
  for (const std::size_t i : work.used) residual += work.pose[i]->rms;
  print(fmt::format(
      "photographs  {} of {} used, board {:.2f} px\n"
      "motion       {}\n"
      "surface      {} points, {} triangles, {:.1f} % of the area measured\n"
      "mesh         {}\nreport       {}\n",
      work.used.size(), work.set.photographs.size(),
      residual / static_cast<double>(work.used.size()),
      motion.is_applied
          ? fmt::format(
                "corrected, up to {:.2f} mm and {:.2f} deg ({} points, {:.2f} -> {:.2f} px)",
                motion.largest_shift, motion.largest_turn / kDegree, motion.tracks, motion.before,
                motion.after)
          : (motion.tracks > 0
                 ? fmt::format("none found ({} points, {:.2f} px)", motion.tracks, motion.after)
                 : std::string("not looked for")),
      model.points, model.skin.mesh.triangles.size(), 100.0 * model.measured_share, out.string(),
      report_path.string()));
  return 0;
}

}  // namespace

void add_photos_mesh_command(CLI::App& photos, Context& context) {
  const auto o = std::make_shared<PhotosMeshArguments>();
  CLI::App* verb = add_verb(photos, "mesh",
                            "A coloured mesh in millimetres from photographs of a hand that stands "
                            "on the middle of the board, taken from all round at two heights",
                            "palmar photos mesh photos/ --lenses lenses.json --out hand.ply");
  verb->add_option("folder", o->folder,
                   "Photographs (.png, .jpg); names like p3_c2.jpg say position and camera")
      ->required();
  verb->add_option("--out", o->out, "The mesh, .ply; a report goes beside it")->required();
  verb->add_option("--lenses", o->lenses,
                   "Lenses of palmar photos calibrate; without, they are found from these "
                   "photographs, which tell less");
  verb->add_option("--box-mm", o->box,
                   "Width, depth, height of the space above the board's middle that holds the hand")
      ->capture_default_str();
  verb->add_option("--cut-mm", o->model.cut, "The mesh ends so far above the board")
      ->capture_default_str();
  verb->add_option("--pixel-mm", o->model.pixel, "What a pixel covers on the hand, for stereo")
      ->capture_default_str();
  verb->add_flag("--no-motion", o->no_motion, "The hand surely did not move: don't look for it");
  verb->callback([&context, o] { context.run = [&context, o] { return run_mesh(*o, context); }; });
}

}  // namespace palmar::cli
