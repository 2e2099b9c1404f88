// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/contact.h"

namespace palmar {

/// The compliance of a hand's skin for a model that needs it (TissueModel::kBone), else nothing.
/// Read from the folder `palmar` in the user's cache ($XDG_CACHE_HOME, else ~/.cache) if it is
/// there; else made (13 s) and put there. A cache that can't be written is no error.
std::shared_ptr<const SkinCompliance> tissue_on_bone(const Hand& hand, const ContactModel& model);

}  // namespace palmar
