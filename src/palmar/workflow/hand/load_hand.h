// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "palmar/grasp/joint_strength.h"
#include "palmar/hand/hand.h"

namespace palmar::workflow {

/// Folder with the template hand: $PALMAR_SHARE, or ../share/palmar beside the running program.
std::string share_folder();

/// The hand called `name`: "template", or a *.hand.glb file. Throws InputError naming the file.
std::shared_ptr<const hand::Hand> load_hand(const std::string& name);
/// The same with the tissue of a file (docs/using/tissue.md) over its own; "": as it is.
std::shared_ptr<const hand::Hand> load_hand(const std::string& name,
                                            const std::string& tissue_file);

/// A person by sex and size: the hand of that percentile, every driving dimension at it, of the
/// ANSUR II women or men.
struct PersonOfSize {
  grasp::Sex sex = grasp::Sex::kFemale;
  double percentile = 50.0;  ///< above 0 to below 100
  void check() const;        ///< throws UsageError: setting, value, what is allowed
};
/// "woman of the 5th percentile (ANSUR II women)"
std::string name_of(const PersonOfSize& person);

/// Which hand a task is done with.
struct HandChoice {
  std::string name = "template";  ///< "template" or a *.hand.glb file
  std::string tissue;             ///< file with tissue (TOML) over the hand's own; "": as it is
  std::shared_ptr<const hand::Hand> value;  ///< a hand that is in memory already, in place of
                                            ///< `name`
  std::optional<PersonOfSize> person = std::nullopt;  ///< to whose size the hand is scaled
  bool is_left = false;                               ///< a right hand is mirrored
};
std::shared_ptr<const hand::Hand> load_hand(const HandChoice& choice);  ///< throws InputError

}  // namespace palmar::workflow
