// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "hand/side_argument.h"
#include "palmar/core/error.h"
#include "palmar/core/progress_part.h"
#include "palmar/formats/file.h"
#include "palmar/formats/image/dicom.h"
#include "palmar/phantom/mri/mri_subject.h"
#include "palmar/phantom/mri/scan_grid.h"
#include "palmar/records/capture/mri_subject_file.h"
#include "phantom/phantom_commands.h"
#include "phantom/phantom_output.h"
#include "phantom/phantom_photos_command.h"
#include "phantom/phantom_scan_command.h"
#include "phantom/phantom_sheet_command.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

struct PhantomArguments {
  std::string base = "template", out, side = "right", offset = "0,0,0";
  std::vector<std::string> postures;
  ScanGridOptions grid;
  ScannerOptions scanner;
  double oblique_deg = 0.0;
  int markers = MriSubjectOptions{}.markers;
  bool no_fixture = false, no_markers = false, both_hands = false;
};

/// The other hand beside a hand: its mirror image, 15 mm away on the patient's left. Its skin is
/// added to `skin`.
void add_other_hand(SubjectPosture& state, std::vector<Vec3>& skin) {
  double edge = -std::numeric_limits<double>::infinity();
  for (const Vec3& vertex : state.skin.vertices) edge = std::max(edge, vertex.x());
  constexpr double kGap = 15.0;  // mm
  const double sum = 2.0 * edge + kGap;
  for (const Vec3& vertex : state.skin.vertices) {
    skin.emplace_back(sum - vertex.x(), vertex.y(), vertex.z());
  }
  const std::size_t parts = state.parts.size();
  for (std::size_t p = 0; p < parts; ++p) {
    ImagedPart other = state.parts[p];
    for (Vec3& vertex : other.mesh.vertices) vertex.x() = sum - vertex.x();
    for (Triangle& triangle : other.mesh.triangles) std::swap(triangle[1], triangle[2]);
    state.parts.push_back(std::move(other));
  }
}

/// Says where the image doesn't show the whole hand; the forearm is always cut.
void note_cut(const std::string& name, const std::vector<Vec3>& skin, const VolumeGrid& grid,
              const Context& context) {
  std::size_t outside = 0;
  for (const Vec3& vertex : skin) {
    const Vec3 at = grid.to_voxel(vertex);
    const bool is_in = at[0] >= 0.0 && at[0] <= grid.size[0] - 1.0 && at[1] >= 0.0 &&
                       at[2] >= 0.0 && at[2] <= grid.size[2] - 1.0;
    outside += is_in ? 0 : 1;
  }
  if (outside == 0) return;
  note(context.common, fmt::format("{}: {} of {} vertices of the skin lie outside of the image",
                                   name, outside, skin.size()));
}

int run_mri(PhantomArguments arguments, const Context& context) {
  MriSubjectOptions person;
  person.seed = context.common.seed;
  person.has_fixture = !arguments.no_fixture;
  person.markers = arguments.no_markers ? 0 : arguments.markers;
  person.side = parse_side(arguments.side);
  arguments.grid.oblique = arguments.oblique_deg * std::numbers::pi / 180.0;
  arguments.grid.offset = parse_vector("--offset-mm", arguments.offset);
  arguments.grid.check();
  arguments.scanner.check();
  person.check();
  const std::vector<ScanPosture> postures = chosen_postures(arguments.postures);

  const Progress progress = make_progress(context.common);
  progress.update(0.0, "making the person");
  MriSubject subject = make_mri_subject(*load_hand(arguments.base), person);
  const fs::path out(arguments.out);
  std::map<ScanPosture, std::string> series;
  Json scans = Json::array();
  std::string text;
  for (std::size_t p = 0; p < postures.size(); ++p) {
    const std::string name(name_of(postures[p]));
    const double length = 0.95 / static_cast<double>(postures.size());
    SubjectPosture& state = subject.postures.at(postures[p]);
    std::vector<Vec3> skin = state.skin.vertices;
    if (arguments.both_hands) add_other_hand(state, skin);
    const VolumeGrid grid = scan_grid(skin, arguments.grid);
    note_cut(name, skin, grid, context);
    ScannerOptions scanner = arguments.scanner;
    scanner.seed = person.seed * kScanPostureCount + static_cast<std::uint64_t>(postures[p]);
    const Volume image = image_of(state.parts, grid, scanner,
                                  part_of(progress, 0.05 + length * static_cast<double>(p),
                                          0.05 + length * static_cast<double>(p + 1), name));
    const fs::path folder = out / "mri" / name;
    // What an earlier run left would be a second series.
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    DicomHeader header;
    header.patient = "Phantom^" + std::to_string(person.seed);
    header.description = name;
    header.laterality = person.side == Side::kLeft ? "L" : "R";
    header.number = static_cast<int>(postures[p]) + 1;
    write_dicom_series(folder.string(), image, header);
    series[postures[p]] = "mri/" + name;
    scans.push_back({{"posture", name},
                     {"series", (out / "mri" / name).string()},
                     {"size", grid.size},
                     {"spacing_mm", {grid.spacing[0], grid.spacing[1], grid.spacing[2]}}});
    text += fmt::format("{:<17} {} x {} x {} voxels of {:g} x {:g} x {:g} mm  {}\n", name,
                        grid.size[0], grid.size[1], grid.size[2], grid.spacing[0], grid.spacing[1],
                        grid.spacing[2], folder.string());
  }
  progress.update(0.98, "writing the truth");
  const std::string truth = (out / "truth").string();
  write_mri_subject(truth, subject, series, person.seed);
  finish_progress();
  print_made_scans(context, subject.name, person.side, scans, text, truth + "/subject.json");
  return 0;
}

}  // namespace

void add_phantom_commands(CLI::App& app, Context& context) {
  CLI::App* phantom = app.add_subcommand("phantom", "Synthetic persons, whose truth is known");
  phantom->require_subcommand(1);
  phantom->fallthrough();
  const auto o = std::make_shared<PhantomArguments>();
  CLI::App* verb = add_verb(*phantom, "mri",
                            "MR series (DICOM) of a synthetic person's hand in eight postures, "
                            "with the truth beside them; --seed chooses the person",
                            "palmar phantom mri --seed 3 --out subject3");
  verb->add_option("--out", o->out, "Folder; mri/POSTURE and truth/ go into it")->required();
  verb->add_option("--postures", o->postures,
                   "Which, with commas: reference, thumb_flexion, thumb_extension, "
                   "thumb_abduction, thumb_adduction, finger_flexion, finger_abduction, grasp; "
                   "default: all")
      ->delimiter(',');
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--pixel-mm", o->grid.pixel, "Edge of a pixel")->capture_default_str();
  verb->add_option("--slice-mm", o->grid.slice, "From slice to slice")->capture_default_str();
  verb->add_option("--slices", o->grid.slices, "Number of slices")->capture_default_str();
  verb->add_option("--field-mm", o->grid.field, "Largest edge of a slice")->capture_default_str();
  verb->add_option("--snr", o->scanner.snr,
                   "Signal of marrow over the noise's deviation; 0: no noise")
      ->capture_default_str();
  verb->add_option("--bias", o->scanner.bias,
                   "Share by which brightness falls across the image; 0: even")
      ->capture_default_str();
  verb->add_option("--oblique-deg", o->oblique_deg, "Turn of the slices out of the coronal plane")
      ->capture_default_str();
  verb->add_option("--offset-mm", o->offset,
                   "Shift x,y,z of the image along its own axes: the hand isn't in the middle")
      ->capture_default_str();
  verb->add_option("--markers", o->markers, "Capsules stuck round the thumb ball")
      ->capture_default_str();
  verb->add_flag("--no-markers", o->no_markers, "None");
  verb->add_flag("--no-fixture", o->no_fixture, "No paper clay below the wrist");
  verb->add_flag("--both-hands", o->both_hands,
                 "The other hand lies beside it, on the patient's left");
  verb->add_option("--base", o->base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->callback([&context, o] { context.run = [&context, o] { return run_mri(*o, context); }; });
  add_phantom_scan(*phantom, context);
  add_phantom_photos_command(*phantom, context);
  add_phantom_sheet(*phantom, context);
  phantom->footer("Example: palmar phantom mri --seed 3 --out subject3");
}

}  // namespace palmar::cli
