// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/product/product.h"
#include "palmar/records/product/cad_worker.h"
#include "palmar/records/product/face_mesh_file.h"

namespace palmar::records {

struct ImportCadOptions {
  std::optional<double> millimetres_per_unit = {};  ///< unset: as the file says
  std::optional<double> chordal_error = {};         ///< mm; unset: from size and smallest radius
  int max_triangles = 2'000'000;
};

/// A STEP or IGES file as mesh and faces; mm.
struct ImportedCad {
  FaceMesh mesh;
  std::string format;                 ///< "STEP AP214", "IGES"
  std::string unit;                   ///< as the file calls it; "" if it states none
  double millimetres_per_unit = 1.0;  ///< what lengths were multiplied by
  std::vector<std::string> bodies;    ///< names
  int solids = 0, open_shells = 0;
  double chordal_error = 0.0;  ///< mm
  std::string chordal_reason;  ///< why this one
  double volume = 0.0;         ///< mm^3, of the exact solids
  std::vector<std::string> notes;
};

/// Reads and tessellates a file in the child process (run_cad()), and checks what comes back.
/// Throws InputError naming the file, UsageError, Cancelled.
ImportedCad import_cad(const std::filesystem::path& path, const ImportCadOptions& options = {},
                       const CadLimits& limits = {}, const Progress& progress = {});

/// "7.6.3": of OpenCASCADE. Throws OutputError if the program palmar-cad isn't there or can't run.
std::string cad_kernel_version();

/// Reads a CAD file and writes it as STEP in mm (see write_step() of module cad) to `out`. Throws
/// as import_cad(), and OutputError.
void convert_to_step(const std::filesystem::path& path, const std::filesystem::path& out,
                     std::optional<double> millimetres_per_unit = {}, const CadLimits& limits = {},
                     const Progress& progress = {});

/// What the CAD kernel says of a file.
struct CadVerdict {
  bool is_valid = false, is_closed = false;
  int bodies = 0, solids = 0, faces = 0, edges = 0, free_edges = 0;
  double volume = 0.0;  ///< mm^3
  double area = 0.0;    ///< mm^2
  std::vector<std::string> findings;
  bool is_good() const { return is_valid && is_closed && volume > 0.0; }
};
CadVerdict check_cad_file(const std::filesystem::path& path,
                          std::optional<double> millimetres_per_unit = {},
                          const CadLimits& limits = {}, const Progress& progress = {});

}  // namespace palmar::records
