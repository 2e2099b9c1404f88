// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/cad/model/cad_model.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/types.h"
#include "palmar/product/product_faces.h"

namespace palmar::cad {

struct TessellationOptions {
  /// mm; largest gap between a triangle's edge and the surface. Unset: a 2000th of the model's
  /// longest side, a 20th of the smallest fillet or rounding, within 0.01 to 0.2 mm; and coarser if
  /// the triangles would be more than allowed (reported).
  std::optional<double> chordal_error = {};
  double angle = 0.25;  ///< rad; most between neighbouring chords of a curve
  int max_triangles = 2'000'000;
  void check() const;  ///< throws UsageError: field, value, allowed range
};

struct Tessellation {
  geometry::TriangleMesh mesh;  ///< mm, outwards; closed 2-manifold for a closed solid
  product::ProductFaces faces;
  double chordal_error = 0.0;      ///< mm; what was used
  std::string chordal_reason;      ///< "a 2000th of its size"; "as given"
  std::vector<std::string> notes;  ///< faces that can't be meshed, by number
};

/// Triangles of a model: neighbouring faces share the vertices of their common edge. Every face of
/// the model stands in `faces`, with its kind, radius, area, neighbours across its edges and
/// whether it is a fillet. Throws InputError if more triangles are needed than allowed (reported
/// before memory is gone: the number is estimated from areas and curvatures), or if none come out.
Tessellation tessellate(const CadModel& model, const TessellationOptions& options = {},
                        const Progress& progress = {});

/// Faces and edges alone, without points and triangles.
product::ProductFaces describe_faces(const CadModel& model);

}  // namespace palmar::cad
