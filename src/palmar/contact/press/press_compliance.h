// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "palmar/contact/press/press_lattice.h"
#include "palmar/contact/response/layered_response.h"

namespace palmar::contact {

/// How far flat skin and the cover of the indenter give way together: two compliances in series,
///
///     u = (R_skin / G_skin + R_cover / G_cover) p,
///
/// each that of a half-space or of a bonded layer (layered_response.h).
class PressCompliance {
 public:
  PressCompliance(const PressOptions& options, double shear_modulus);

  /// R, mm/N: an entry is the mean of the responses of both cells' discs, so that R is symmetric.
  Eigen::MatrixXd matrix(const std::vector<PressCell>& cells) const;

  /// Displacement at points that no cell stands for, under forces [N] on the cells, mm.
  std::vector<double> displacement(const std::vector<Vec2>& points,
                                   const std::vector<PressCell>& cells,
                                   const Eigen::VectorXd& force) const;

  /// E* of both bodies, MPa: 1 / E* is the sum of (1 - nu) / 2 G. What happens at the edge of a
  /// contact depends on nothing else, however thin the layers.
  double contact_modulus() const;

  /// Thickness of the thinner layer, mm; infinite without one.
  double thinnest() const;

  /// True if a force may lift the surface elsewhere, so that skin outside the indenter can touch.
  bool may_lift() const { return skin_.kernel != nullptr || cover_.has_value(); }

 private:
  struct Body {
    const LayerKernel* kernel = nullptr;  ///< null: a half-space
    double thickness = 0.0;               ///< mm
    double shear_modulus = 0.0;           ///< MPa
  };
  /// Response of this body to a disc of one size.
  class Source;
  Source source(double radius) const;

  Body skin_;
  std::optional<Body> cover_;
  double poisson_ = 0.5;  ///< of a half-space
  Kernel kernel_ = Kernel::kPatch;
};

}  // namespace palmar::contact
