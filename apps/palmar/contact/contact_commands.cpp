// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "cli.h"
#include "contact/contact_fit_command.h"
#include "palmar/core/error.h"
#include "palmar/workflow/press.h"
#include "palmar/workflow/words/press_words.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct PressArguments {
  std::string specimen = "plane", indenter, depths, forces, out, cover;
  workflow::ContactModelWords model;
  std::string tissue_level = "nominal", tissue;
  double tilt_deg = 0.0;
  double cell = contact::PressOptions{}.cell_area;
  double coating_poisson = contact::Coating{}.poisson;
  std::optional<double> spacing, shear_modulus_kpa, layer, poisson, coating, coating_modulus_kpa;
};

std::optional<contact::Coating> cover_of(const PressArguments& arguments) {
  if (!arguments.cover.empty()) {
    if (arguments.coating || arguments.coating_modulus_kpa) {
      throw UsageError("--coating says what --coating-mm and --coating-modulus-kpa say");
    }
    return workflow::parse_cover(arguments.cover);
  }
  if (!arguments.coating && !arguments.coating_modulus_kpa) return std::nullopt;
  if (!arguments.coating || !arguments.coating_modulus_kpa) {
    throw UsageError("--coating-mm and --coating-modulus-kpa are needed together");
  }
  contact::Coating coating;
  coating.thickness = *arguments.coating;
  coating.shear_modulus = *arguments.coating_modulus_kpa / 1000.0;
  coating.poisson = arguments.coating_poisson;
  return coating;
}

contact::PressOptions parse_options(const PressArguments& arguments, std::string& hand_name) {
  if (arguments.depths.empty() == arguments.forces.empty()) {
    throw UsageError("either --depth-mm or --force-n is needed, and only one of them");
  }
  if (arguments.shear_modulus_kpa && !(*arguments.shear_modulus_kpa > 0.0)) {
    throw UsageError(fmt::format("--shear-modulus-kpa is {}; more than 0 kPa is required",
                                 *arguments.shear_modulus_kpa));
  }
  if (!(arguments.cell > 0.0 && arguments.cell <= 30.0)) {
    throw UsageError(
        fmt::format("--cell-mm is {}; more than 0 and at most 30 mm is required", arguments.cell));
  }
  contact::PressOptions options;
  options.specimen = workflow::parse_specimen(arguments.specimen, hand_name);
  options.indenter = workflow::parse_indenter(arguments.indenter);
  if (!arguments.depths.empty())
    options.depths = workflow::parse_list("--depth-mm", arguments.depths);
  if (!arguments.forces.empty())
    options.forces = workflow::parse_list("--force-n", arguments.forces);
  options.tilt = radians(arguments.tilt_deg);
  options.spacing = arguments.spacing.value_or(options.spacing);
  options.cell_area = arguments.cell * arguments.cell;
  options.layer_thickness = arguments.layer;
  options.poisson = arguments.poisson;
  options.coating = cover_of(arguments);
  options.tissue_level = workflow::parse_tissue_level(arguments.tissue_level);
  if (arguments.shear_modulus_kpa) options.shear_modulus = *arguments.shear_modulus_kpa / 1000.0;
  return options;
}

std::string press_text(const std::vector<contact::PressStep>& steps) {
  std::string text =
      "  depth     force      area       peak  peak cells       mean      shear\n"
      "     mm         N       mm2        MPa         MPa        MPa  modulus MPa\n";
  for (const contact::PressStep& s : steps) {
    text += fmt::format("{:7.3f} {:9.4f} {:9.2f} {:10.5f} {:11.5f} {:10.5f} {:12.5f}\n", s.depth,
                        s.force, s.area, s.peak_pressure, s.peak_pressure_cells, s.mean_pressure,
                        s.shear_modulus);
  }
  return text;
}

int run_press(const PressArguments& arguments, const CommonOptions& common) {
  workflow::PressRequest request;
  std::string hand_name;
  request.test = parse_options(arguments, hand_name);
  request.model = workflow::press_model(arguments.model, arguments.layer, !hand_name.empty());
  request.hand = {.name = hand_name, .tissue = arguments.tissue, .value = nullptr};
  request.out = arguments.out;
  request.note = [&common](const std::string& text) { note(common, text); };
  request.check();
  if (arguments.coating) {
    note(common,
         "--coating-mm, --coating-modulus-kpa and --coating-poisson are now one: --coating "
         "THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON]; the old names go with the next release");
  }
  if (!hand_name.empty() && arguments.spacing) {
    note(common, "--spacing-mm is left out: a hand has its own vertices");
  }
  const auto [test, setting, steps] = run_press(request);
  print(common.json ? records::press_json(test, setting, steps) + "\n" : press_text(steps));
  return 0;
}

}  // namespace

void add_contact_commands(CLI::App& app, Context& context) {
  CLI::App* contact = app.add_subcommand("contact", "Contact of skin with simple bodies");
  contact->require_subcommand(1);
  contact->fallthrough();
  add_contact_fit_verb(*contact, context);

  const auto o = std::make_shared<PressArguments>();
  o->cell = std::sqrt(contact::PressOptions{}.cell_area);
  CLI::App* verb =
      add_verb(*contact, "press", "The indentation test of a laboratory",
               "palmar contact press --specimen template:middle_distal --indenter plane "
               "--tilt-deg 30 --depth-mm 1,2,3");
  verb->add_option("--specimen", o->specimen,
                   "plane, ellipsoid:RX,RY (radii of curvature, mm) or HAND:REGION")
      ->capture_default_str();
  verb->add_option("--indenter", o->indenter,
                   "sphere:R, punch:A, punches:A,DISTANCE (two, moving together), cylinder:R (mm) "
                   "or plane")
      ->required();
  verb->add_option("--depth-mm", o->depths, "Depths from first touch, a,b,c in mm");
  verb->add_option("--force-n", o->forces, "Forces to reach, a,b,c in N, instead of depths");
  verb->add_option("--tilt-deg", o->tilt_deg, "Tilt of the indenter, deg")->capture_default_str();
  verb->add_option("--spacing-mm", o->spacing,
                   fmt::format("Vertex spacing of a plane or ellipsoid, mm; default {}",
                               contact::PressOptions{}.spacing));
  verb->add_option("--shear-modulus-kpa", o->shear_modulus_kpa,
                   "One shear modulus instead of the tissue's own G(d), kPa");
  verb->add_option("--preset", o->model.preset,
                   "Equations: palmar, or xie2014 (as printed in the thesis)")
      ->capture_default_str();
  verb->add_option("--kernel", o->model.kernel, "patch or point (Xie 2014); default: the preset's");
  verb->add_option(
      "--tissue-model", o->model.tissue_model,
      "halfspace, layered (a flat layer over bone: the hand's own, or --layer-mm), or bone (the "
      "tissue between the hand's skin and bones); default: the preset's");
  verb->add_option("--tissue", o->tissue,
                   "Tissue file (TOML) for the hand; a plane or ellipsoid takes the middle "
                   "fingertip's");
  verb->add_option("--tissue-level", o->tissue_level, "Stiffness of the tissue: low, nominal, high")
      ->capture_default_str();
  verb->add_option("--layer-mm", o->layer,
                   "Thickness of the layer over bone of a plane or ellipsoid, mm");
  verb->add_option("--poisson", o->poisson,
                   "Poisson's ratio of a plane or ellipsoid, 0 to 0.5; default 0.5");
  verb->add_option("--coating", o->cover,
                   "Elastic cover of the indenter: THICKNESS_MM,SHEAR_MODULUS_KPA[,POISSON]; "
                   "Poisson's ratio 0.5 if not given");
  // As it was written until the release before; not in the help.
  verb->add_option("--coating-mm", o->coating)->group("");
  verb->add_option("--coating-modulus-kpa", o->coating_modulus_kpa)->group("");
  verb->add_option("--coating-poisson", o->coating_poisson)->group("");
  verb->add_option("--cell-mm", o->cell, "Side of a square sensor cell, mm")->capture_default_str();
  verb->add_option("--out", o->out, "File to write: .json, .csv, or .svg (the curve)");
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_press(*o, context.common); }; });
}

}  // namespace palmar::cli
