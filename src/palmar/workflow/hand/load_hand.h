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

/// Which hand a task is done with.
struct HandChoice {
  std::string name = "template";      ///< "template" or a *.hand.glb file
  std::string tissue;                 ///< file with tissue (TOML) over the hand's own; "": as it is
  std::shared_ptr<const Hand> value;  ///< a hand that is in memory already, in place of `name`
};
std::shared_ptr<const Hand> load_hand(const HandChoice& choice);  ///< throws InputError

}  // namespace palmar
