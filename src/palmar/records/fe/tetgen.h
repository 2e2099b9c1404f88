// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "palmar/core/error.h"
#include "palmar/formats/process/program_missing.h"
#include "palmar/records/fe/tet_mesh.h"

namespace palmar::records {

/// Fills a tissue block with tetrahedra by TetGen, a program of its own (AGPL: it is called, never
/// linked). Writes tissue.poly and the mesher's files to `folder`. Facets of skin and bone stay as
/// they are, so skin nodes are those of the hand; tetrahedra are at most `largest_volume` [mm^3].
///
/// Throws UsageError as check_largest_tet(); ProgramMissing if `tetgen` isn't on PATH (tissue.poly
/// is there then); NumericalError if it finds no mesh: facets that cut each other, such as bones
/// that overlap.
BlockMesh mesh_by_tetgen(const hand::TissueBlock& block, const std::filesystem::path& folder,
                         double largest_volume);

/// Throws UsageError unless the largest volume of a tetrahedron [mm^3] is above 0.
void check_largest_tet(double largest_volume);

}  // namespace palmar::records
