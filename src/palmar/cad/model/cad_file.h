// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/cad/model/cad_model.h"
#include "palmar/core/progress.h"

namespace palmar::cad {

struct ReadCadOptions {
  /// mm; what one unit of the file is if the user knows better than the file.
  std::optional<double> millimetres_per_unit = {};
  /// Assemblies may repeat parts of parts: a small file can stand for any number of bodies.
  int max_bodies = 2000;
  int max_faces = 200'000;
  void check() const;  ///< throws UsageError
};

/// What a CAD file held.
struct CadFile {
  CadModel model;      ///< mm, bodies where the assembly has them
  std::string format;  ///< "STEP AP214", "IGES 5.3"
  std::string unit;    ///< as the file calls it: "millimetre", "inch"; "" if it states none
  double millimetres_per_unit = 1.0;  ///< by which lengths were multiplied
  int solids = 0;
  int open_shells = 0;             ///< bodies that enclose nothing
  std::vector<std::string> notes;  ///< what was left out, joined, repaired or doubted, with counts
};

/// Reads STEP (AP203, AP214, AP242; ISO 10303-21) or IGES (5.3). Assemblies become bodies, every
/// instance one, named "assembly / part" and numbered if a name comes again; names and colours of
/// bodies and faces are kept. Loose curves and points are left out (reported); surfaces too if
/// there are solids; without solids they are sewn, and closed shells become solids (reported).
///
/// Throws InputError naming the file: not such a file, cut off, no shapes, nothing but curves or
/// points, more bodies or faces than allowed. May take any time and memory, or crash, on hostile
/// files: runs in a process of its own (records/product/cad_worker.h).
CadFile read_step(const std::filesystem::path& path, const ReadCadOptions& options = {},
                  const Progress& progress = {});
CadFile read_iges(const std::filesystem::path& path, const ReadCadOptions& options = {},
                  const Progress& progress = {});
/// Either, by what the file begins with; else by its suffix.
CadFile read_cad(const std::filesystem::path& path, const ReadCadOptions& options = {},
                 const Progress& progress = {});

/// Writes STEP AP214 in mm with names and colours of bodies and faces. The same model gives the
/// same bytes: no date, no user, no host. Read back, bodies, faces and edges have the same numbers.
/// Throws OutputError.
void write_step(const std::filesystem::path& path, const CadModel& model);

}  // namespace palmar::cad
