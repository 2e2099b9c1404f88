// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "cli.h"
#include "grasp_options.h"
#include "palmar/contact/press.h"
#include "palmar/core/error.h"
#include "palmar/io/file.h"
#include "palmar/io/press_json.h"
#include "text.h"

namespace palmar::cli {
namespace {

struct PressArguments {
  std::string specimen = "plane", indenter, depths, forces, out, kernel = "patch";
  double tilt_deg = 0.0;
  double spacing = PressOptions{}.spacing;
  double cell = PressOptions{}.cell_area;
  std::optional<double> shear_modulus_kpa, layer;
};

/// "name:rest" in two; rest is empty without a colon.
std::pair<std::string, std::string> split_kind(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string::npos) return {text, ""};
  return {text.substr(0, colon), text.substr(colon + 1)};
}

double one_radius(const std::string& kind, const std::string& text) {
  const std::vector<double> values =
      text.empty() ? std::vector<double>() : parse_list("--indenter", text);
  if (values.size() != 1) {
    throw UsageError("--indenter: " + kind + " needs one radius in mm, as in " + kind + ":5");
  }
  return values.front();
}

/// plane | ellipsoid:RX,RY | HAND:REGION; sets `hand` for the last.
PressSpecimen parse_specimen(const std::string& text, std::string& hand) {
  PressSpecimen specimen;
  const auto [kind, rest] = split_kind(text);
  if (text == "plane") return specimen;
  if (kind == "ellipsoid") {
    const std::vector<double> radii =
        rest.empty() ? std::vector<double>() : parse_list("--specimen", rest);
    if (radii.size() != 2) {
      throw UsageError("--specimen: \"" + text +
                       "\"; ellipsoid:RX,RY with two radii in mm is needed");
    }
    specimen.kind = PressSpecimen::Kind::kEllipsoid;
    specimen.radius_x = radii[0];
    specimen.radius_y = radii[1];
    return specimen;
  }
  const std::size_t colon = text.rfind(':');
  const auto region =
      colon == std::string::npos ? std::nullopt : region_named(text.substr(colon + 1));
  if (!region) {
    throw UsageError(
        "--specimen: \"" + text +
        "\" is not known; plane, ellipsoid:RX,RY or HAND:REGION (template:middle_distal) "
        "is allowed");
  }
  specimen.kind = PressSpecimen::Kind::kHandRegion;
  specimen.region = *region;
  hand = text.substr(0, colon);
  return specimen;
}

PressIndenter parse_indenter(const std::string& text) {
  PressIndenter indenter;
  const auto [kind, rest] = split_kind(text);
  if (text == "plane") {
    indenter.kind = PressIndenter::Kind::kPlane;
  } else if (kind == "sphere" || kind == "punch" || kind == "cylinder") {
    indenter.kind = kind == "sphere"  ? PressIndenter::Kind::kSphere
                    : kind == "punch" ? PressIndenter::Kind::kPunch
                                      : PressIndenter::Kind::kCylinder;
    indenter.radius = one_radius(kind, rest);
  } else {
    throw UsageError("--indenter: \"" + text +
                     "\" is not known; sphere:R, punch:A, cylinder:R (mm) or plane is allowed");
  }
  return indenter;
}

std::string press_text(const std::vector<PressStep>& steps) {
  std::string text =
      "  depth     force      area       peak  peak cells       mean\n"
      "     mm         N       mm2        MPa         MPa        MPa\n";
  for (const PressStep& s : steps) {
    text += fmt::format("{:7.3f} {:9.4f} {:9.2f} {:10.5f} {:11.5f} {:10.5f}\n", s.depth, s.force,
                        s.area, s.peak_pressure, s.peak_pressure_cells, s.mean_pressure);
  }
  return text;
}

int run_press(const PressArguments& arguments, const CommonOptions& common) {
  std::string hand_name;
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
  PressOptions options;
  options.specimen = parse_specimen(arguments.specimen, hand_name);
  options.indenter = parse_indenter(arguments.indenter);
  if (!arguments.depths.empty()) options.depths = parse_list("--depth-mm", arguments.depths);
  if (!arguments.forces.empty()) options.forces = parse_list("--force-n", arguments.forces);
  options.tilt = radians(arguments.tilt_deg);
  options.spacing = arguments.spacing;
  options.cell_area = arguments.cell * arguments.cell;
  options.kernel = parse_kernel(arguments.kernel);
  options.layer_thickness = arguments.layer;
  if (arguments.shear_modulus_kpa) options.shear_modulus = *arguments.shear_modulus_kpa / 1000.0;
  options.check();

  std::optional<PreparedHand> hand;
  if (!hand_name.empty()) hand.emplace(load_hand(hand_name), ContactModel{.kernel = options.kernel});
  const std::vector<PressStep> steps = press(options, hand ? &*hand : nullptr);
  if (!arguments.out.empty()) write_file(arguments.out, press_json(steps) + "\n");
  print(common.json ? press_json(steps) + "\n" : press_text(steps));
  return 0;
}

}  // namespace

void add_contact_commands(CLI::App& app, Context& context) {
  CLI::App* contact = app.add_subcommand("contact", "Contact of skin with simple bodies");
  contact->require_subcommand(1);
  contact->fallthrough();

  const auto o = std::make_shared<PressArguments>();
  o->cell = std::sqrt(PressOptions{}.cell_area);
  CLI::App* verb =
      add_verb(*contact, "press", "The indentation test of a laboratory",
               "palmar contact press --specimen template:middle_distal --indenter plane "
               "--tilt-deg 30 --depth-mm 1,2,3");
  verb->add_option("--specimen", o->specimen,
                   "plane, ellipsoid:RX,RY (radii of curvature, mm) or HAND:REGION")
      ->capture_default_str();
  verb->add_option("--indenter", o->indenter, "sphere:R, punch:A, cylinder:R (mm) or plane")
      ->required();
  verb->add_option("--depth-mm", o->depths, "Depths from first touch, a,b,c in mm");
  verb->add_option("--force-n", o->forces, "Forces to reach, a,b,c in N, instead of depths");
  verb->add_option("--tilt-deg", o->tilt_deg, "Tilt of the indenter, deg")->capture_default_str();
  verb->add_option("--spacing-mm", o->spacing, "Vertex spacing of a plane or ellipsoid, mm")
      ->capture_default_str();
  verb->add_option("--shear-modulus-kpa", o->shear_modulus_kpa,
                   "Instead of the tissue's own G(d), kPa");
  verb->add_option("--kernel", o->kernel, "patch or point (Xie 2014)")->capture_default_str();
  verb->add_option("--layer-mm", o->layer, "Thickness of the layer over bone (not available yet)");
  verb->add_option("--cell-mm", o->cell, "Side of a square sensor cell, mm")->capture_default_str();
  verb->add_option("--out", o->out, "JSON file to write");
  verb->callback(
      [&context, o] { context.run = [&context, o] { return run_press(*o, context.common); }; });
}

}  // namespace palmar::cli
