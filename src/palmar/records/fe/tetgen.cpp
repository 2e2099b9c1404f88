// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/records/fe/tetgen.h"

#include <fmt/format.h>

#include "palmar/formats/file.h"
#include "palmar/formats/process/external_program.h"

namespace palmar::records {

void check_largest_tet(double largest_volume) {
  if (largest_volume > 0.0) return;
  throw UsageError(fmt::format(
      "finite elements: largest tetrahedron {} mm3; more than 0 is required", largest_volume));
}

BlockMesh mesh_by_tetgen(const hand::TissueBlock& block, const std::filesystem::path& folder,
                         double largest_volume) {
  check_largest_tet(largest_volume);
  formats::create_folder(folder);
  const std::filesystem::path surface = folder / "tissue.poly";
  formats::write_file(surface, tetgen_poly(block));
  const auto tetgen = formats::find_program("tetgen");
  if (!tetgen) {
    throw formats::ProgramMissing(
        "the mesher tetgen is not installed (Debian: apt-get install tetgen); " + surface.string() +
        " holds the surface");
  }
  // p: fill a surface, Y: keep its facets, q: ratio of radius to edge, a: largest volume.
  const int code = formats::run_program(
      *tetgen, {fmt::format("-pYq1.5a{:.6g}", largest_volume), surface.filename().string()}, folder,
      "tetgen.log");
  const std::filesystem::path stem = folder / "tissue.1";
  if (code != 0 || !std::filesystem::exists(stem.string() + ".ele")) {
    throw NumericalError(fmt::format("tetgen found no mesh for {} (exit code {}); see {}",
                                     surface.string(), code, (folder / "tetgen.log").string()));
  }
  return read_tetgen(stem.string());
}

}  // namespace palmar::records
