// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "phantom/phantom_scan_command.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "hand/side_argument.h"
#include "hands/person_workflow/phantom/phantom_scan.h"
#include "palmar/core/error.h"
#include "palmar/product/product.h"
#include "phantom/phantom_output.h"
#include "product/colour_argument.h"

namespace palmar::cli {
namespace {

struct PhantomScanArguments {
  person_workflow::PhantomScanRequest request;
  std::string side = "right", unit = "mm", ring, ring_colour = "#c7c7cc";
  std::string skin = "#cc9980", crease = "green", dot = "blue";
  std::vector<std::string> postures;
  bool is_free = false, no_creases = false, no_dots = false, ideal = false;

  PhantomScanArguments() {
    for (const hand::ScanPosture posture : request.postures)
      postures.emplace_back(name_of(posture));
  }
};

phantom::PaintedHandOptions painted_options(const PhantomScanArguments& arguments,
                                            std::uint64_t seed) {
  phantom::PaintedHandOptions options = arguments.request.person;
  if (arguments.is_free) {
    options.dispersion = phantom::kFreePerson;
    options.paint.is_tinted = true;
  }
  options.seed = seed;
  options.side = parse_side(arguments.side);
  options.paint.skin = parse_colour("--skin-colour", arguments.skin);
  options.paint.crease = parse_colour("--crease-colour", arguments.crease);
  options.paint.dot = parse_colour("--dot-colour", arguments.dot);
  options.paint.has_creases = !arguments.no_creases;
  options.paint.has_dots = !arguments.no_dots;
  if (arguments.ring.empty()) return options;
  options.ring = hand::finger_named(arguments.ring);
  if (!options.ring) {
    throw UsageError("--ring: \"" + arguments.ring +
                     "\" is no finger; thumb, index, middle, ring or little is");
  }
  options.paint.ring_colour = parse_colour("--ring-colour", arguments.ring_colour);
  return options;
}

int run_phantom_scan(const PhantomScanArguments& arguments, const Context& context) {
  person_workflow::PhantomScanRequest request = arguments.request;
  request.person = painted_options(arguments, context.common.seed);
  request.unit = geometry::length_unit(arguments.unit);
  if (arguments.ideal) {
    request.defects = {.noise = 0.0, .roughness = 0.0, .hidden = 0.0, .colour_noise = 0.0};
  }
  request.postures = chosen_postures(arguments.postures);
  const person_workflow::PhantomScanOutcome outcome =
      person_workflow::make_phantom_scan(request, make_progress(context.common));
  finish_progress();
  nlohmann::ordered_json scans = nlohmann::ordered_json::array();
  std::string text;
  for (const person_workflow::PhantomScanOutcome::Scan& one : outcome.scans) {
    scans.push_back(
        {{"posture", name_of(one.posture)}, {"file", one.file}, {"triangles", one.triangles}});
    text += fmt::format("{:<17} {} triangles  {}\n", name_of(one.posture), one.triangles, one.file);
  }
  print_made_scans(context, outcome.person, scans, text);
  return 0;
}

}  // namespace

void add_phantom_scan(CLI::App& phantom, Context& context) {
  const auto o = std::make_shared<PhantomScanArguments>();
  CLI::App* verb =
      add_verb(phantom, "scan",
               "Coloured surface scans of a synthetic person's painted hand in several "
               "postures, with the truth beside them; --seed chooses the person",
               "palmar phantom scan --seed 3 --out subject3");
  verb->add_option("--out", o->request.out, "Folder; scan/POSTURE and truth/ go into it")
      ->required();
  verb->add_option("--side", o->side, "right or left")->capture_default_str();
  verb->add_option("--format", o->request.format, "ply: colours at the vertices; obj: a texture")
      ->capture_default_str();
  verb->add_option("--texture-px", o->request.texture_side, "Side of that texture")
      ->capture_default_str();
  verb->add_option("--unit", o->unit, "Unit of the files: mm, cm, m or inch")
      ->capture_default_str();
  verb->add_option("--posture", o->postures,
                   "Which, with commas: reference, finger_flexion, finger_abduction (these by "
                   "default), the thumb's limits thumb_flexion, thumb_extension, thumb_abduction, "
                   "thumb_adduction, grasp")
      ->delimiter(',');
  verb->add_option("--skin-colour", o->skin, "#rrggbb")->capture_default_str();
  verb->add_option("--crease-colour", o->crease,
                   "Ink of the lines: green, blue, red, black, purple, orange or #rrggbb")
      ->capture_default_str();
  verb->add_option("--dot-colour", o->dot, "Ink of the dots")->capture_default_str();
  verb->add_option("--ink", o->request.person.paint.coverage,
                   "Share of the ink's colour where it is drawn")
      ->capture_default_str();
  verb->add_option("--noise-mm", o->request.defects.noise, "Waviness of the scan")
      ->capture_default_str();
  verb->add_option("--roughness-mm", o->request.defects.roughness, "Noise of every vertex")
      ->capture_default_str();
  verb->add_option("--hidden", o->request.defects.hidden,
                   "Share of directions in which skin must see the open to be scanned")
      ->capture_default_str();
  verb->add_option("--forearm-mm", o->request.defects.forearm, "Forearm that is scanned")
      ->capture_default_str();
  verb->add_option("--ring", o->ring, "Finger that wears one: thumb, index, middle, ring, little");
  verb->add_option("--ring-colour", o->ring_colour, "Colour of its metal, #rrggbb")
      ->capture_default_str();
  verb->add_flag("--no-creases", o->no_creases, "No lines are drawn");
  verb->add_flag("--no-dots", o->no_dots, "No dots are drawn");
  verb->add_flag("--ideal", o->ideal, "No noise, no holes");
  verb->add_flag("--mirrored", o->request.mirrored,
                 "Mirror the scans, as a wrong export does; the truth stays");
  verb->add_flag("--free", o->is_free, kFreeHelp);
  verb->add_option("--start-hand", o->request.base,
                   "Whose skin's outline the person starts from: \"template\" or a .hand.glb file")
      ->capture_default_str();
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_phantom_scan(*o, context); }; });
}

}  // namespace palmar::cli
