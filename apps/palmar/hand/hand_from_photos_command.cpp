// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hand/hand_from_photos_command.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

#include "hand/hand_output.h"
#include "hand/scan_hand.h"
#include "hand/side_argument.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "photos/photo_lenses.h"
#include "photos/photo_mesh.h"

namespace palmar::cli {
namespace {

namespace fs = std::filesystem;

struct FromPhotosArguments {
  std::vector<std::string> paths, posture;
  PhotoMeshArguments mesh;
  ScanHandArguments hand;
};

bool names_calibration(const fs::path& path) {
  std::string name = path.filename().string();
  std::transform(name.begin(), name.end(), name.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.starts_with("calib") || name.starts_with("lens");
}

/// Folders of photographs: those given; of one that holds folders instead of photographs, these.
/// One called calibration is where lenses come from if nothing else is said.
std::vector<std::string> folders_in(const std::vector<std::string>& paths, std::string& lenses) {
  std::vector<std::string> folders;
  for (const std::string& path : paths) {
    // "reference/" names what "reference" does.
    fs::path folder = fs::path(path).lexically_normal();
    if (!folder.has_filename()) folder = folder.parent_path();
    if (!fs::is_directory(folder)) {
      throw InputError(path + ": a folder of photographs is expected");
    }
    std::vector<fs::path> inner;
    if (!holds_photographs(folder)) {
      for (const auto& entry : fs::directory_iterator(folder)) {
        if (entry.is_directory() && holds_photographs(entry.path())) inner.push_back(entry.path());
      }
      std::sort(inner.begin(), inner.end());
    }
    if (inner.empty()) inner.push_back(folder);
    for (const fs::path& one : inner) {
      if (inner.size() > 1 && names_calibration(one)) {
        if (lenses.empty()) lenses = one.string();
      } else {
        folders.push_back(one.string());
      }
    }
  }
  return folders;
}

/// A set of photographs as the hand's notes tell of it.
std::vector<std::string> notes_of(const std::string& folder, const nlohmann::ordered_json& report) {
  std::vector<std::string> notes = {fmt::format(
      "{}: {} photographs, {:.0f} % of the surface measured", folder,
      report.at("photographs").size(), 100.0 * report.at("measured_share").get<double>())};
  for (const auto& warning : report.at("warnings")) {
    notes.push_back(folder + ": " + warning.get<std::string>());
  }
  return notes;
}

int run_from_photos(FromPhotosArguments arguments, const Context& context) {
  const std::string& out = arguments.hand.out;
  check_hand_output(out);
  if (!arguments.hand.side.empty()) parse_side(arguments.hand.side);
  const SkinMarkOptions inks = arguments.hand.inks();
  arguments.mesh.check();
  load_hand(arguments.hand.model);
  const std::vector<std::string> paths = folders_in(arguments.paths, arguments.mesh.lenses);
  const auto folders = files_by_posture(paths, arguments.posture, "folder");
  const std::string work =
      arguments.hand.work.empty() ? beside_hand(out, ".photos") : arguments.hand.work;
  const WorkFolder work_folder(work);
  arguments.hand.check_outputs(work);
  const Progress progress = make_progress(context.common);

  std::optional<PhotoLenses> lenses;
  constexpr double kLenses = 0.05, kMeshes = 0.8;  // shares of the whole that these end at
  if (!arguments.mesh.lenses.empty()) {
    lenses = lenses_of(arguments.mesh.lenses, part_of(progress, 0.0, kLenses, "lenses"));
    write_file(fs::path(work) / "lenses.json", format_lenses(*lenses));
  }
  std::map<ScanPosture, PhotoMeshPlan> plans;
  double seconds = 0.0, kept = 0.0;
  for (const auto& [posture, folder] : folders) {
    PhotoMeshPlan& plan = plans[posture];
    plan = plan_photo_mesh(folder, fs::path(work) / (std::string(name_of(posture)) + ".ply"),
                           lenses, arguments.mesh);
    seconds += plan.seconds;
    kept += plan.kept ? 1.0 : 0.0;
    note(context.common,
         fmt::format("{}: {} photographs in {}{}", name_of(posture), plan.set.photographs.size(),
                     folder, plan.kept ? ", whose mesh is there already" : ""));
  }
  constexpr double kSecondsPerScan = 20.0;  // of one core, to make the hand
  note(context.common, fmt::format("this takes about {:.0f} s",
                                   seconds + kSecondsPerScan * static_cast<double>(plans.size()) /
                                                 std::max(1, thread_count())));

  std::map<ScanPosture, ShownScan> shown;
  std::vector<std::string> notes;
  double begin = kLenses;
  const double to_make = static_cast<double>(plans.size()) - kept;
  const double end_of_meshes = to_make > 0.0 ? kMeshes : 2.0 * kLenses;
  for (const auto& [posture, plan] : plans) {
    const double end =
        plan.kept || to_make == 0.0 ? begin : begin + (end_of_meshes - kLenses) / to_make;
    const auto report = make_photo_mesh(
        plan, lenses, arguments.mesh, part_of(progress, begin, end, std::string(name_of(posture))));
    begin = end;
    const std::vector<std::string> told = notes_of(plan.folder, report);
    notes.insert(notes.end(), told.begin(), told.end());
    const std::string file = plan.mesh.string();
    ReadSurface read = read_scan_surface(file, LengthUnit::kMillimetre);
    notes.insert(notes.end(), read.notes.begin(), read.notes.end());
    SkinMarks marks = find_skin_marks(read.surface, file, inks);
    for (const std::string& text : marks.notes) notes.push_back(file + ": " + text);
    shown[posture] = {file, std::move(read.surface), std::move(marks)};
  }
  make_hand_of_surfaces(arguments.hand, work, shown, notes, context,
                        part_of(progress, end_of_meshes, 1.0));
  return 0;
}

}  // namespace

void add_from_photos(CLI::App& hand, Context& context) {
  const auto a = std::make_shared<FromPhotosArguments>();
  CLI::App* verb =
      add_verb(hand, "from-photos",
               "A person's hand from photographs of it on the printed board (palmar photos board), "
               "a folder per posture",
               "palmar hand from-photos anna/reference anna/flexed --lenses anna/calibration "
               "--out anna.hand.glb");
  verb->add_option("FOLDER", a->paths,
                   "Photographs (.png, .jpg) of one posture, or a folder of such folders. The name "
                   "tells the posture: reference (or natural), finger_flexion, finger_abduction; "
                   "the reference is needed, a single folder is taken for it")
      ->required();
  verb->add_option("--posture", a->posture,
                   "What a folder shows: FOLDER=POSTURE; again for others");
  a->mesh.add_to(*verb);
  a->hand.add_to(*verb);
  verb->add_option("--work", a->hand.work,
                   "Folder for the report and for the meshes, which another run takes up; default: "
                   "beside the hand, *.photos");
  verb->callback(
      [&context, a] { context.run = [&context, a] { return run_from_photos(*a, context); }; });
}

}  // namespace palmar::cli
