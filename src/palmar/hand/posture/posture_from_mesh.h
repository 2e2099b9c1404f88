// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/core/progress.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/hand/hand.h"
#include "palmar/hand/posture/posture_fit.h"

namespace palmar::hand {

struct MeshFitOptions {
  bool fits_scale = false;   ///< also one overall size of the hand
  double reach = 10.0;       ///< mm; skin farther from the mesh than this has no partner there
  double poor_median = 3.0;  ///< mm; a worse fit is called poor
  int max_iterations = 60;   ///< of the last stage
  void check() const;        ///< throws UsageError: field, value, allowed range
};

/// A posture found by registering a hand to a mesh.
struct MeshFit {
  PostureFitStatus status = PostureFitStatus::kPoor;
  std::string message;
  Posture posture;
  geometry::Rigid3 mesh_from_hand;  ///< mm
  double scale = 1.0;               ///< size of the mesh's hand over this one's; 1 unless asked for
  bool is_vertex_to_vertex = false;  ///< the mesh is this hand's skin, vertex for vertex
  // Distance of skin vertices to the mesh, of those with a partner, mm.
  double mean = 0.0, median = 0.0, percentile_95 = 0.0;
  double partner_share = 0.0;     ///< of the skin's area (without the forearm)
  std::vector<Dof> not_observed;  ///< the mesh doesn't show these angles
  std::vector<Dof> at_limit;
  int iterations = 0;
};

/// Finds posture and place of a hand in a mesh of a posed hand (mm, any frame, oriented outwards;
/// it may have holes and noise, another triangulation, a forearm, or be another person's hand).
///
/// If the mesh has as many vertices as the hand's skin and they fit one to one (within 1 mm), that
/// is the answer (PostureFitter). Else articulated iterative closest points: every round pairs
/// points of the posed skin with the nearest ones of the mesh, and points of the mesh with the
/// nearest of the skin, both only where the normals agree within 78 degrees and not on an open
/// border, then minimises over 6 + 23 (+ 1) unknowns within the range of motion
///
///     sum_i w_i (n_i . (s R m_i(theta) + t - c_i))^2 ,  w = (1 + (r/c)^2)^-2 ,
///
/// c_i, n_i the partner on the mesh and its normal; c shrinks from 20 to 3 mm. It starts from the
/// named postures along the principal axes of the mesh, both ways round, aligned by the middle and
/// by the fingers' end (a forearm moves the middle), goes on with the best few, and looks once at
/// every finger bent otherwise. Skin without partner, the forearm of the mesh included, has no say.
///
/// A fit that leaves doubt is tried on the mirrored mesh, too. Finding none is a status.
/// Deterministic. Throws UsageError, Cancelled; InputError for a mesh without area.
///
/// Source: Chen, Medioni 1992 (point to plane); Pellegrini et al. 2008 (articulated).
MeshFit fit_posture_to_mesh(const Hand& hand, const geometry::TriangleMesh& mesh,
                            const MeshFitOptions& options = {}, const Progress& progress = {});

}  // namespace palmar::hand
