// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "contact/press_deck_command.h"

#include <fmt/format.h>

#include <filesystem>

#include "contact/press_specimen.h"
#include "palmar/contact/press/half_space_press.h"
#include "palmar/core/error.h"
#include "palmar/formats/file.h"
#include "palmar/hand/tissue_block.h"
#include "palmar/records/fe/inp_file.h"
#include "palmar/records/fe/tetgen.h"
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
  const auto region = region_named(arguments.region);
  if (!region) {
    throw UsageError("--region: \"" + arguments.region +
                     "\" is no region; one like middle_distal is required with --format inp");
  }
  PressOptions press;
  press.specimen = {.kind = PressSpecimen::Kind::kHandRegion, .region = *region};
  press.indenter = parse_indenter(arguments.indenter);
  press.tilt = radians(arguments.tilt_deg);
  press.depths = parse_list("--depth-mm", arguments.depths);
  const auto hand = load_hand(hand_name);

  PressDeck deck;
  deck.title = fmt::format("{} of hand {}, {} at {} deg", arguments.region, hand->name,
                           arguments.indenter, arguments.tilt_deg);
  deck.depths = press.depths;
  deck.shear_modulus = arguments.shear_modulus_kpa / 1000.0;
  deck.poisson = arguments.poisson;
  deck.material = arguments.is_large_strain ? DeckMaterial::kNeoHooke : DeckMaterial::kLinear;
  const Rigid3 frame = indenter_at_first_touch(press, PreparedHand(hand));
  deck.indenter = indenter_surface(press.indenter, frame);
  deck.direction = -(frame.rotation * Vec3::UnitZ());
  const std::filesystem::path folder(out);
  deck.block = mesh_by_tetgen(
      make_tissue_block(*hand, {.region = *region, .cut_offset = arguments.cut, .cut_normal = {}}),
      folder, arguments.largest_tet);
  const std::filesystem::path file = folder / "press.inp";
  write_file(file, inp_deck(deck));
  note(common, fmt::format("wrote {} ({} nodes, {} tetrahedra); solve it with `ccx -i {}`",
                           file.string(), deck.block.mesh.nodes.size(), deck.block.mesh.tets.size(),
                           (folder / "press").string()));
  return 0;
}

}  // namespace palmar::cli
