// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "cli.h"

namespace palmar::cli {

/// Adds `hand pose`: a posture by name, from joint angles, from markers or from a mesh, to a file
/// of angles, a mesh or a picture.
void add_hand_pose(CLI::App& hand, Context& context);

}  // namespace palmar::cli
