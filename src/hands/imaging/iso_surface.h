// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "hands/imaging/volume.h"
#include "palmar/geometry/types.h"

namespace palmar::imaging {

/// Surface round everything in an image that is brighter than `level`: closed, 2-manifold, oriented
/// outwards (towards the dark), in the patient frame, mm. What the border of the image cuts is
/// closed by a flat cap on the outer faces of the outermost voxels.
///
/// Marching cubes (Lorensen, Cline 1987) with vertices on the edges between voxel centres, where
/// the linear interpolation equals `level`. The 256 cases are not a table from a book but are built
/// from one rule: on a cell's face with four crossings, each bright corner is cut off by itself.
/// The rule looks at nothing but the face, so two cells always agree about the face between them
/// and the surface has no holes (the ambiguity of Duerst 1988). A cell's loop of crossings is
/// triangulated without a diagonal between two points of one face, if need be round its centre; so
/// no edge can occur in two cells but as a part of their common face, and each edge has two
/// triangles.
///
/// The same for any number of threads. Empty if nothing is brighter. Throws UsageError if the image
/// has another number of values than voxels or the level is not finite.
geometry::TriangleMesh iso_surface(const Volume& image, double level);

}  // namespace palmar::imaging
