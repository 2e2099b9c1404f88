// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "hands/person_workflow/phantom/phantom_postures.h"
#include "hands/phantom/mri/scan_defects.h"
#include "hands/phantom/photo/painted_hand.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/length_unit.h"

namespace palmar::person_workflow {

/// Coloured surface scans of a synthetic person's painted hand, with the truth beside them
/// (docs/method/phantom.md).
struct PhantomScanRequest {
  std::string out;             ///< folder; scan/POSTURE and truth/ go into it
  std::string format = "ply";  ///< "ply": colours at the vertices; "obj": a texture
  int texture_side = 4096;     ///< of that texture, pixels: as scanning apps write it
  geometry::LengthUnit unit = geometry::LengthUnit::kMillimetre;  ///< of the files
  /// Which; none: all eight.
  std::vector<hand::ScanPosture> postures = {hand::ScanPosture::kReference,
                                             hand::ScanPosture::kFingerFlexion,
                                             hand::ScanPosture::kFingerAbduction};
  phantom::PaintedHandOptions person;  ///< its seed chooses the person; what is drawn, who wears a
                                       ///< ring
  phantom::ScanDefects defects;        ///< its seed follows from the person's
  bool mirrored = false;               ///< the scans are, as a wrong export does; the truth stays
  std::string base = "template";  ///< whose skin's outline the person starts from: "template" or a
                                  ///< *.hand.glb file

  void check() const;  ///< throws UsageError: setting, value, what is allowed
};

struct PhantomScanOutcome {
  struct Scan {
    hand::ScanPosture posture{};
    std::string file;
    std::size_t triangles = 0;
  };
  PhantomPerson person;
  std::vector<Scan> scans;
};

/// Makes the person, a scan per posture and the truth. Throws UsageError, InputError for `base`,
/// OutputError, Cancelled.
PhantomScanOutcome make_phantom_scan(const PhantomScanRequest& request,
                                     const Progress& progress = {});

}  // namespace palmar::person_workflow
