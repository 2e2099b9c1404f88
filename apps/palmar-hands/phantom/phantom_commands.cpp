// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_commands.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "hand/side_argument.h"
#include "hands/person_workflow/phantom/phantom_mri.h"
#include "phantom/phantom_output.h"
#include "phantom/phantom_photos_command.h"
#include "phantom/phantom_scan_command.h"
#include "phantom/phantom_sheet_command.h"

namespace palmar::cli {
namespace {

using Json = nlohmann::ordered_json;

struct PhantomArguments {
  person_workflow::PhantomMriRequest request;
  std::string side = "right", offset = "0,0,0";
  std::vector<std::string> postures;
  double oblique_deg = 0.0;
  bool no_fixture = false, no_markers = false, is_free = false;
};

int run_mri(const PhantomArguments& arguments, const Context& context) {
  person_workflow::PhantomMriRequest request = arguments.request;
  request.person.seed = context.common.seed;
  request.person.has_fixture = !arguments.no_fixture;
  if (arguments.is_free) {
    request.person.dispersion = phantom::kFreePerson;
    // What a field of view of 200 mm shows.
    request.person.dispersion.shortest = phantom::PersonDispersion{}.shortest;
    request.person.dispersion.longest = phantom::PersonDispersion{}.longest;
  }
  if (arguments.no_markers) request.person.markers = 0;
  request.person.side = parse_side(arguments.side);
  request.grid.oblique = arguments.oblique_deg * std::numbers::pi / 180.0;
  request.grid.offset = workflow::parse_vector("--offset-mm", arguments.offset);
  request.check();
  request.postures = chosen_postures(arguments.postures);
  request.note = [&context](const std::string& text) { note(context.common, text); };
  const person_workflow::PhantomMriOutcome outcome =
      person_workflow::make_phantom_mri(request, make_progress(context.common));
  finish_progress();
  Json scans = Json::array();
  std::string text;
  for (const person_workflow::PhantomMriOutcome::Series& one : outcome.series) {
    const imaging::VolumeGrid& grid = one.grid;
    scans.push_back({{"posture", name_of(one.posture)},
                     {"series", one.folder},
                     {"size", grid.size},
                     {"spacing_mm", {grid.spacing[0], grid.spacing[1], grid.spacing[2]}}});
    text += fmt::format("{:<17} {} x {} x {} voxels of {:g} x {:g} x {:g} mm  {}\n",
                        name_of(one.posture), grid.size[0], grid.size[1], grid.size[2],
                        grid.spacing[0], grid.spacing[1], grid.spacing[2], one.folder);
  }
  print_made_scans(context, outcome.person, scans, text);
  return 0;
}

}  // namespace

void add_phantom_commands(CLI::App& app, Context& context) {
  CLI::App* phantom = app.add_subcommand("phantom", "Synthetic persons with known truth");
  phantom->require_subcommand(1);
  phantom->fallthrough();
  const auto o = std::make_shared<PhantomArguments>();
  CLI::App* verb = add_verb(*phantom, "mri",
                            "MR series (DICOM) of a synthetic person's hand in eight postures, "
                            "with the truth beside them; --seed chooses the person",
                            "palmar phantom mri --seed 3 --out subject3");
  verb->add_option("--out", o->request.out, "Folder; mri/POSTURE and truth/ go into it")
      ->required();
  verb->add_option("--posture", o->postures,
                   "Which, with commas: reference, thumb_flexion, thumb_extension, "
                   "thumb_abduction, thumb_adduction, finger_flexion, finger_abduction, grasp; "
                   "default: all")
      ->delimiter(',');
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--pixel-mm", o->request.grid.pixel, "Edge of a pixel")->capture_default_str();
  verb->add_option("--slice-mm", o->request.grid.slice, "From slice to slice")
      ->capture_default_str();
  verb->add_option("--slices", o->request.grid.slices, "Number of slices")->capture_default_str();
  verb->add_option("--field-mm", o->request.grid.field, "Largest edge of a slice")
      ->capture_default_str();
  verb->add_option("--snr", o->request.scanner.snr,
                   "Signal of marrow over the noise's deviation; 0: no noise")
      ->capture_default_str();
  verb->add_option("--bias", o->request.scanner.bias,
                   "Share by which brightness falls across the image; 0: even")
      ->capture_default_str();
  verb->add_option("--fat-shift-mm", o->request.scanner.fat_shift,
                   "Chemical shift: how far fat and marrow lie off along the rows")
      ->capture_default_str();
  verb->add_option("--acquired", o->request.scanner.acquired,
                   "Share of the resolution that is acquired; below 1 edges ring (Gibbs)")
      ->capture_default_str();
  verb->add_option("--marrow-texture", o->request.scanner.marrow_texture,
                   "Unevenness of marrow, as a share")
      ->capture_default_str();
  verb->add_option(
          "--mask", o->request.scanner.mask,
          "Signals below this many deviations of the noise are 0, as some scanners mask air")
      ->capture_default_str();
  verb->add_option("--oblique-deg", o->oblique_deg, "Turn of the slices out of the coronal plane")
      ->capture_default_str();
  verb->add_option("--offset-mm", o->offset,
                   "Shift x,y,z of the image along its own axes: the hand isn't in the middle")
      ->capture_default_str();
  verb->add_option("--markers", o->request.person.markers, "Capsules stuck round the thumb ball")
      ->capture_default_str();
  verb->add_flag("--no-markers", o->no_markers, "None");
  verb->add_flag("--no-fixture", o->no_fixture, "No paper clay below the wrist");
  verb->add_flag("--both-hands", o->request.both_hands,
                 "The other hand is beside it, on the patient's left");
  verb->add_flag("--free", o->is_free, kFreeHelp);
  verb->add_option("--start-hand", o->request.base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->callback([&context, o] { context.run = [&context, o] { return run_mri(*o, context); }; });
  add_phantom_scan(*phantom, context);
  add_phantom_photos_command(*phantom, context);
  add_phantom_sheet(*phantom, context);
  phantom->footer("Example: palmar phantom mri --seed 3 --out subject3");
}

}  // namespace palmar::cli
