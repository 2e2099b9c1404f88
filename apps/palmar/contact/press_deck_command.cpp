// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "contact/press_deck_command.h"

#include <fmt/format.h>

#include "palmar/core/error.h"
#include "palmar/workflow/press_deck.h"
#include "palmar/workflow/words/press_words.h"
#include "text.h"

namespace palmar::cli {

void add_press_deck_options(CLI::App& verb, PressDeckArguments& arguments) {
  const std::string group = "Finite-element deck (--format inp)";
  verb.add_option("--region", arguments.region, "Region that is pressed, as middle_distal")
      ->group(group);
  verb.add_option("--indenter", arguments.indenter, "plane, sphere:R or cylinder:R (mm)")
      ->capture_default_str()
      ->group(group);
  verb.add_option("--tilt-deg", arguments.tilt_deg, "Tilt of the indenter, deg")
      ->capture_default_str()
      ->group(group);
  verb.add_option("--depth-mm", arguments.depths, "Depths from first touch, a,b,c in mm")
      ->capture_default_str()
      ->group(group);
  verb.add_option("--shear-modulus-kpa", arguments.shear_modulus_kpa,
                  "Shear modulus of the tissue, kPa")
      ->capture_default_str()
      ->group(group);
  verb.add_option("--poisson", arguments.poisson, "Poisson's ratio of the tissue, below 0.5")
      ->capture_default_str()
      ->group(group);
  verb.add_option("--largest-tet-mm3", arguments.largest_tet, "Largest tetrahedron, mm3")
      ->capture_default_str()
      ->group(group);
  verb.add_option("--cut-mm", arguments.cut,
                  "Where the finger is cut off, mm distal of the region's proximal joint; default: "
                  "the middle of the phalanx proximal to it")
      ->group(group);
  verb.add_flag("--large-strain", arguments.is_large_strain,
                "Neo-Hookean tissue at large strain instead of linear")
      ->group(group);
}

int run_press_deck(const PressDeckArguments& arguments, const std::string& hand_name,
                   const std::string& out, const CommonOptions& common) {
  const auto region = hand::region_named(arguments.region);
  if (!region) {
    throw UsageError("--region: \"" + arguments.region +
                     "\" is no region; one like middle_distal is required with --format inp");
  }
  workflow::PressDeckRequest request;
  request.hand.name = hand_name;
  request.region = *region;
  request.indenter = workflow::parse_indenter(arguments.indenter);
  request.tilt = radians(arguments.tilt_deg);
  request.depths = workflow::parse_list("--depth-mm", arguments.depths);
  request.shear_modulus = arguments.shear_modulus_kpa / 1000.0;
  request.poisson = arguments.poisson;
  if (arguments.is_large_strain) request.material = records::DeckMaterial::kNeoHooke;
  request.largest_tet = arguments.largest_tet;
  request.cut_offset = arguments.cut;
  request.indenter_words = fmt::format("{} at {} deg", arguments.indenter, arguments.tilt_deg);
  request.out = out;
  const auto [file, deck] = workflow::write_press_deck(request);
  note(common, fmt::format("wrote {} ({} nodes, {} tetrahedra); solve it with `ccx -i {}`",
                           file.string(), deck.block.mesh.nodes.size(), deck.block.mesh.tets.size(),
                           (file.parent_path() / file.stem()).string()));
  return 0;
}

}  // namespace palmar::cli
