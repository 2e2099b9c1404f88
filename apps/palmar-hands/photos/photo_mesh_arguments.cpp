// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "photos/photo_mesh_arguments.h"

#include <fmt/format.h>

namespace palmar::cli {

PhotoMeshArguments::PhotoMeshArguments() {
  const Vec3 size = options_.model.box.sizes();
  box_ = fmt::format("{:g},{:g},{:g}", size.x(), size.y(), size.z());
}

void PhotoMeshArguments::add_to(CLI::App& verb) {
  verb.add_option(
      "--lenses", options_.lenses,
      "Lenses: a file of palmar photos calibrate, or a folder of photographs of the tilted board; "
      "without, they are found from the photographs of the hand, which is less accurate");
  verb.add_option("--space-mm", box_,
                  "Width, depth, height of the space above the board's middle that holds the hand")
      ->capture_default_str();
  verb.add_option("--cut-mm", options_.model.cut,
                  "Height above the board at which the mesh ends, mm")
      ->capture_default_str();
  verb.add_option("--pixel-mm", options_.model.pixel, "Size of a pixel on the hand for stereo, mm")
      ->capture_default_str();
  verb.add_flag("--no-motion", no_motion_,
                "The hand certainly didn't move: don't correct its motion");
}

person_workflow::PhotoMeshOptions PhotoMeshArguments::options() const {
  person_workflow::PhotoMeshOptions options = options_;
  const Vec3 size = workflow::parse_vector("--space-mm", box_);
  options.model.box = Box3(Vec3(-0.5 * size.x(), -0.5 * size.y(), 0.0),
                           Vec3(0.5 * size.x(), 0.5 * size.y(), size.z()));
  options.looks_for_motion = !no_motion_;
  options.setting_names = option_named;
  options.check();
  return options;
}

}  // namespace palmar::cli
