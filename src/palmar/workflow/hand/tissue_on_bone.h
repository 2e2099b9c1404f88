// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/contact/bone/skin_compliance.h"
#include "palmar/contact/contact.h"
#include "palmar/study/study_plan.h"
#include "palmar/workflow/hand/load_hand.h"
#include "palmar/workflow/note/note.h"

namespace palmar::workflow {

/// The compliance of a hand's skin for a model that needs it (TissueModel::kBone), else nothing.
/// The template's came with Palmar (template.compliance beside it); others are made in some 13 s
/// and kept in the user's cache ($XDG_CACHE_HOME/palmar or ~/.cache/palmar), under a hash of what
/// they depend on; a cache that can't be used is as if it weren't there. A left hand's is the
/// mirror image of the right one's. `note` hears when one has to be made, and of the template what
/// is the matter with its file.
std::shared_ptr<const contact::SkinCompliance> tissue_on_bone(const hand::Hand& hand,
                                                              const contact::ContactModel& model,
                                                              const NoteSink& note = {});

/// The same for the hand that a study's hands are scaled from, if any of its settings needs it.
std::shared_ptr<const contact::SkinCompliance> tissue_on_bone(const hand::Hand& base,
                                                              const study::StudyPlan& plan,
                                                              const NoteSink& note = {});

/// The file with the template's compliance; throws InputError that names it and the command that
/// makes it anew if it is missing, cut or of another hand than the template.
std::string template_compliance_file();

/// A hand ready for contact. One that is scaled to a person takes the compliance of the hand that
/// it was scaled from. Throws as PreparedHand.
contact::PreparedHand prepared_hand(const HandChoice& choice,
                                    const std::shared_ptr<const hand::Hand>& hand,
                                    const contact::ContactModel& model, const NoteSink& note = {});

}  // namespace palmar::workflow
