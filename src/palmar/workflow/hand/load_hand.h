// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "palmar/hand/hand.h"

namespace palmar {

/// Folder with the template hand: $PALMAR_SHARE, or ../share/palmar beside the running program.
std::string share_folder();

/// The hand called `name`: "template", or a *.hand.glb file. Throws InputError naming the file.
std::shared_ptr<const Hand> load_hand(const std::string& name);
/// The same with the tissue of a file (docs/using/tissue.md) over its own; "": as it is.
std::shared_ptr<const Hand> load_hand(const std::string& name, const std::string& tissue_file);

}  // namespace palmar
