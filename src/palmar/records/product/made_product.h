// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "palmar/product/product.h"
#include "palmar/records/product/cad_worker.h"
#include "palmar/records/product/face_mesh_file.h"

namespace palmar::records {

/// A product made from parameters as a study describes it: a kind of product/parametric_kinds.h and
/// the values that were given; the others have their defaults.
struct MadeProduct {
  std::string kind;                                   ///< "cylinder", "bottle", ...
  std::vector<std::pair<std::string, double>> given;  ///< "diameter_mm", 35
};

/// "made: cylinder diameter_mm=35 length_mm=130": what StudyProduct::file says of it.
std::string words_of(const MadeProduct& product);
bool is_made(const std::string& words);
/// Throws InputError on other words or a value that is no number, UsageError on a kind, parameter
/// or value that can't be (complete_values()).
MadeProduct made_from(const std::string& words);
/// "cylinder diameter 35 mm": the kind and what was given, for people.
std::string title_of(const MadeProduct& product);

/// Along the grip to the thumb's side if the kind states it (ParametricKind::thumb_side): how it is
/// held unless something else is asked for. Product frame, unit.
std::optional<Vec3> thumb_side_of(const MadeProduct& product);

/// Whether the solid has an exact distance (product/primitives.h): sphere, ellipsoid, and cylinder
/// and prism with sharp ends. The others are made by the CAD program (run_cad()).
bool is_analytic(const MadeProduct& product);

struct SolidOptions {
  double size = 1.0;            ///< factor of all lengths
  double chordal_error = 0.01;  ///< mm; largest gap between mesh and solid, before sizing
};

/// The product with all its lengths times `size`, with faces as its CAD model has them. A solid
/// that was made before in this process isn't made again. Throws UsageError: as made_from();
/// lengths outside their limits after sizing; and what run_cad() throws.
product::Product make_solid(const MadeProduct& product, const SolidOptions& options = {});

struct MakeCadOptions {
  bool step = true;
  bool mesh = true;
  std::optional<double> chordal_error = std::nullopt;  ///< mm; unset: as tessellation.h chooses
  CadLimits limits = {};
};

/// The CAD solid of any kind, the analytic ones too.
struct MadeCad {
  std::string step;            ///< bytes of a STEP file, if asked for
  FaceMesh mesh;               ///< mm, if asked for
  double volume = 0.0;         ///< mm^3, of the exact solid
  double chordal_error = 0.0;  ///< mm, of the mesh
  std::vector<std::string> notes;
};
/// Throws as make_solid().
MadeCad make_cad(const MadeProduct& product, const MakeCadOptions& options = {},
                 const Progress& progress = {});

}  // namespace palmar::records
