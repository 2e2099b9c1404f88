// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/press/press_compliance.h"

#include <algorithm>
#include <limits>
#include <map>

#include "palmar/contact/response/response.h"

namespace palmar::contact {

class PressCompliance::Source {
 public:
  Source(const PressCompliance& body, double radius)
      : kernel_(body.kernel_),
        radius_(radius),
        half_space_share_(2.0 * (1.0 - body.poisson_) / body.skin_.shear_modulus),
        skin_share_(1.0 / body.skin_.shear_modulus) {
    if (body.skin_.kernel != nullptr)
      skin_.emplace(*body.skin_.kernel, radius, body.skin_.thickness);
    if (body.cover_) {
      cover_.emplace(*body.cover_->kernel, radius, body.cover_->thickness);
      cover_share_ = 1.0 / body.cover_->shear_modulus;
    }
  }

  double at(double r) const {
    double u = 0.0;
    if (skin_) {
      u = skin_share_ * skin_->at(r);
    } else {
      u = half_space_share_ *
          (kernel_ == Kernel::kPoint ? point_response(r) : disc_response(r, radius_));
    }
    if (cover_) u += cover_share_ * cover_->at(r);
    return u;
  }

 private:
  Kernel kernel_;
  double radius_, half_space_share_, skin_share_;
  double cover_share_ = 0.0;
  std::optional<LayerSource> skin_, cover_;
};

PressCompliance::PressCompliance(const PressOptions& options, double shear_modulus)
    : kernel_(options.kernel) {
  skin_.shear_modulus = shear_modulus;
  if (options.layer_thickness) {
    skin_.kernel = &layer_kernel(options.poisson.value_or(options.tissue.poisson_layered));
    skin_.thickness = *options.layer_thickness;
  } else {
    poisson_ = options.poisson.value_or(0.5);
  }
  if (options.coating) {
    cover_ = Body{&layer_kernel(options.coating->poisson), options.coating->thickness,
                  options.coating->shear_modulus};
  }
}

PressCompliance::Source PressCompliance::source(double radius) const { return {*this, radius}; }

double PressCompliance::contact_modulus() const {
  const double poisson = skin_.kernel != nullptr ? skin_.kernel->poisson() : poisson_;
  double compliance = (1.0 - poisson) / (2.0 * skin_.shear_modulus);
  if (cover_) compliance += (1.0 - cover_->kernel->poisson()) / (2.0 * cover_->shear_modulus);
  return 1.0 / compliance;
}

double PressCompliance::thinnest() const {
  double thickness = std::numeric_limits<double>::infinity();
  if (skin_.kernel != nullptr) thickness = skin_.thickness;
  if (cover_) thickness = std::min(thickness, cover_->thickness);
  return thickness;
}

Eigen::MatrixXd PressCompliance::matrix(const std::vector<PressCell>& cells) const {
  // Whole cells of one size share their source.
  std::map<double, std::size_t> place;
  std::vector<Source> sources;
  std::vector<std::size_t> of_cell;
  for (const PressCell& cell : cells) {
    const auto [entry, is_new] = place.try_emplace(cell.area, sources.size());
    if (is_new) sources.push_back(source(cell.disc_radius()));
    of_cell.push_back(entry->second);
  }
  const auto m = static_cast<Eigen::Index>(cells.size());
  Eigen::MatrixXd R(m, m);
  for (Eigen::Index j = 0; j < m; ++j) {
    const Source& own = sources[of_cell[j]];
    for (Eigen::Index i = j; i < m; ++i) {
      const double r = (cells[i].centre - cells[j].centre).norm();
      double u = own.at(r);
      if (of_cell[i] != of_cell[j]) u = 0.5 * (u + sources[of_cell[i]].at(r));
      R(i, j) = u;
      R(j, i) = u;
    }
  }
  return R;
}

std::vector<double> PressCompliance::displacement(const std::vector<Vec2>& points,
                                                  const std::vector<PressCell>& cells,
                                                  const Eigen::VectorXd& force) const {
  std::vector<double> u(points.size(), 0.0);
  for (std::size_t j = 0; j < cells.size(); ++j) {
    const double p = force[static_cast<Eigen::Index>(j)];
    if (!(p > 0.0)) continue;
    const Source loaded = source(cells[j].disc_radius());
    for (std::size_t i = 0; i < points.size(); ++i) {
      u[i] += p * loaded.at((points[i] - cells[j].centre).norm());
    }
  }
  return u;
}

}  // namespace palmar::contact
