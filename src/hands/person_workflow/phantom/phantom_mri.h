// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/person_workflow/phantom/phantom_postures.h"
#include "hands/phantom/mri/mri_subject.h"
#include "hands/phantom/mri/scan_grid.h"
#include "palmar/core/progress.h"
#include "palmar/workflow/note/note.h"

namespace palmar::person_workflow {

/// MR series (DICOM) of a synthetic person's hand, with the truth beside them
/// (docs/method/phantom.md).
struct PhantomMriRequest {
  std::string out;                          ///< folder; mri/POSTURE and truth/ go into it
  std::vector<hand::ScanPosture> postures;  ///< which; none: all eight
  phantom::MriSubjectOptions person;        ///< its seed chooses the person
  phantom::ScanGridOptions grid;            ///< how the operator places the slices
  phantom::ScannerOptions scanner;          ///< its seed follows from the person's
  bool both_hands = false;        ///< the other hand lies beside it, on the patient's left
  std::string base = "template";  ///< whose skin's outline the person starts from: "template" or
                                  ///< a *.hand.glb file
  workflow::NoteSink note;        ///< gets what an image doesn't show; may be empty

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct PhantomMriOutcome {
  struct Series {
    hand::ScanPosture posture{};
    std::string folder;
    imaging::VolumeGrid grid;
  };
  PhantomPerson person;
  std::vector<Series> series;
};

/// Makes the person, images of every posture and the truth; about 10 s per posture at the usual
/// resolution. What an earlier run left in a posture's folder goes. Throws UsageError, InputError
/// for `base`, OutputError, Cancelled.
PhantomMriOutcome make_phantom_mri(const PhantomMriRequest& request, const Progress& progress = {});

}  // namespace palmar::person_workflow
