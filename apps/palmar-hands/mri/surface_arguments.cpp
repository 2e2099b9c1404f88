// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "mri/surface_arguments.h"

namespace palmar::cli {

void SurfaceArguments::add_to(CLI::App& verb) {
  verb.add_option("--air-threshold", options_.air_threshold,
                  "Intensity, in the image's own numbers, that separates skin from air; 0: found "
                  "from the histogram")
      ->capture_default_str();
  verb.add_option(
          "--bone-threshold", options_.bone_threshold,
          "Intensity, in the image's own numbers, that separates cortical bone from marrow; 0: "
          "half way between theirs. A higher one finds small bones whose thin rim is grey")
      ->capture_default_str();
  verb.add_flag("--keep-bias", keeps_bias_, "Don't correct the brightness across the image");
  verb.add_option("--bone-edge-mm", options_.edge_length, "Mean edge of the meshes")
      ->capture_default_str();
  verb.add_option("--marker-mm", options_.marker_diameter,
                  "Diameter of markers stuck on the skin; 0: there are none")
      ->capture_default_str();
  verb.add_option("--side", side_, "Which hand it is; default: from the anatomy")
      ->check(CLI::IsMember({"right", "left"}));
}

capture::SurfaceOptions SurfaceArguments::options() const {
  capture::SurfaceOptions options = options_;
  options.corrects_bias = !keeps_bias_;
  options.side = chosen_side();
  options.check();
  return options;
}

std::optional<hand::Side> SurfaceArguments::chosen_side() const {
  if (side_.empty()) return std::nullopt;
  return side_ == "left" ? hand::Side::kLeft : hand::Side::kRight;
}

}  // namespace palmar::cli
