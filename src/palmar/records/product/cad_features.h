// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/types.h"
#include "palmar/records/product/cad_worker.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/records/product/made_product.h"

namespace palmar::records {

/// Where a solid comes from: a STEP or IGES file, or a kind made from parameters.
struct CadSource {
  std::filesystem::path file;
  std::optional<double> millimetres_per_unit;  ///< of the file; unset: as it says
  std::optional<MadeProduct> made;             ///< instead of a file
};

/// As the CAD program is told of it: one JSON object. Throws InputError on what is no CAD file.
std::string source_text(const CadSource& source);

/// One change of a feature; see cad/edits/feature_edits.h for what it does and feature_choice.h for
/// words.
struct CadFeature {
  std::string feature;  ///< "fillet", "offset", "taper", "groove"
  std::string where;    ///< edges of a fillet, faces of an offset or a taper, in words
  double value = 0.0;   ///< mm: radius, distance outwards, depth; deg: taper
  // Of a groove:
  std::vector<Vec3> points{};       ///< mm, along its line
  std::optional<double> ring_at{};  ///< mm along the axis, instead of points
  bool is_closed = false;           ///< the line runs back to its first point
  double section_radius = 8.0;      ///< mm
  double rim_radius = 0.0;          ///< mm
};

struct CadFeatureRequest {
  CadSource source;
  std::optional<CadSource> reference;  ///< what the change is measured from; unset: the source
  std::vector<CadFeature> features{};
  std::string keep_out{};  ///< faces of the reference that must stay where they are, in words
  bool mesh = true;        ///< wants the mesh
  bool step = false;       ///< wants a STEP file
  std::optional<double> chordal_error{};  ///< mm, of the mesh; unset: as tessellation.h chooses
};

/// What words choose.
struct ChosenEdges {
  std::string text;     ///< "edges 1, 3 and fillet 7"
  double radius = 0.0;  ///< mm; mean of the fillets now, 0 if all are sharp
};

/// A closed, valid solid of positive volume.
struct ChangedCad {
  FaceMesh mesh;     ///< mm
  std::string step;  ///< bytes of a STEP file that was read back and is the same, if asked for
  double volume = 0.0, volume_before = 0.0;  ///< mm^3; before: of the reference
  double largest_change = 0.0;       ///< mm; between the surfaces before and after, both ways
  double keep_out_change = 0.0;      ///< mm; of the faces that must stay
  double chordal_error = 0.0;        ///< mm, of the mesh
  std::vector<ChosenEdges> fillets;  ///< of every fillet asked for, before the change
  std::vector<std::string> notes;
};

/// Changes features in the child process (run_cad()). Throws NumericalError naming the feature and
/// its value if it can't be made, UsageError on an unknown edge or face, InputError on a bad file,
/// Cancelled.
ChangedCad change_features(const CadFeatureRequest& request, const CadLimits& limits = {},
                           const Progress& progress = {});

/// Which edges the fillets among `features` mean and what they are now; nothing is changed. Faces
/// of the other features and of `keep_out` are checked. Throws UsageError, InputError, Cancelled.
std::vector<ChosenEdges> describe_features(const CadFeatureRequest& request,
                                           const CadLimits& limits = {},
                                           const Progress& progress = {});

}  // namespace palmar::records
