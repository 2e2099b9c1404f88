// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Closed forms on skin meshes: the contact solver that `assess` runs, on a flat skin of three
// spacings, vertices where they happen to lie.
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <span>
#include <string>

#include "palmar/validation/validation_cases.h"

namespace palmar::validation {
namespace {

constexpr double kCircle = std::numbers::pi;  // area over radius squared
constexpr double kModulus = 0.05;             // MPa
constexpr double kHalfWidth = 17.0;           // mm; of the flat skin
constexpr double kDeep = 20.0;                // mm; the skin's far side

/// A flat skin, z = 0, outside +z, of equilateral triangles; closed by a pyramid below. Its lattice
/// is shifted, so that no shape pressed on the origin lies on a vertex or between two.
std::shared_ptr<const hand::Hand> flat_hand(double spacing) {
  auto hand = std::make_shared<hand::Hand>();
  hand->name = "flat skin";
  const double height = spacing * std::sqrt(3.0) / 2.0;
  const int columns = 1 + static_cast<int>(std::lround(2.0 * kHalfWidth / spacing));
  const int rows = 1 + static_cast<int>(std::lround(2.0 * kHalfWidth / height));
  geometry::TriangleMesh& skin = hand->skin;
  for (int r = 0; r < rows; ++r) {
    for (int c = 0; c < columns; ++c) {
      const double shift = r % 2 == 0 ? 0.0 : 0.5;
      skin.vertices.emplace_back((c + shift + 0.31) * spacing - kHalfWidth,
                                 (r + 0.17) * height - kHalfWidth, 0.0);
    }
  }
  const auto at = [&](int r, int c) { return r * columns + c; };
  for (int r = 0; r + 1 < rows; ++r) {
    for (int c = 0; c + 1 < columns; ++c) {
      const int a = at(r, c), b = at(r, c + 1), d = at(r + 1, c), e = at(r + 1, c + 1);
      if (r % 2 == 0) {
        skin.triangles.push_back({a, b, d});
        skin.triangles.push_back({b, e, d});
      } else {
        skin.triangles.push_back({a, b, e});
        skin.triangles.push_back({a, e, d});
      }
    }
  }
  const int apex = static_cast<int>(skin.vertices.size());
  skin.vertices.emplace_back(0.0, 0.0, -kDeep);
  const auto close = [&](int from, int to) { skin.triangles.push_back({to, from, apex}); };
  for (int c = 0; c + 1 < columns; ++c) {
    close(at(0, c), at(0, c + 1));
    close(at(rows - 1, c + 1), at(rows - 1, c));
  }
  for (int r = 0; r + 1 < rows; ++r) {
    close(at(r + 1, 0), at(r, 0));
    close(at(r, columns - 1), at(r + 1, columns - 1));
  }
  hand->region.assign(skin.vertices.size(), hand::Region::kCentralPalm);
  hand->segment.assign(skin.vertices.size(), hand::Segment::kPalm);
  hand->tissue = hand::default_tissue();
  return hand;
}

/// A body that a function describes: nearest point of the surface, and distance, negative inside.
class Body : public geometry::DistanceField {
 public:
  using Nearest = std::function<geometry::DistanceSample(const Vec3&)>;
  explicit Body(Nearest nearest) : nearest_(std::move(nearest)) {}
  void sample(std::span<const Vec3> points, double /*range*/,
              std::span<geometry::DistanceSample> samples) const override {
    for (std::size_t i = 0; i < points.size(); ++i) samples[i] = nearest_(points[i]);
  }
  Box3 bounding_box() const override { return {Vec3::Constant(-500.0), Vec3::Constant(500.0)}; }

 private:
  Nearest nearest_;
};

geometry::DistanceSample around(const Vec3& point, const Vec3& centre, double radius) {
  const Vec3 n = (point - centre).normalized();
  return {(point - centre).norm() - radius, centre + radius * n, n, -1};
}

Body sphere(double radius, double depth) {
  return Body([=](const Vec3& x) { return around(x, Vec3(0, 0, radius - depth), radius); });
}

Body two_spheres(double radius, double depth, double apart) {
  return Body([=](const Vec3& x) {
    const double side = x.x() < 0.0 ? -0.5 : 0.5;
    return around(x, Vec3(side * apart, 0, radius - depth), radius);
  });
}

/// A ring of round section about the y axis; its outermost line touches the skin along x.
Body ring(double section, double outer, double depth) {
  return Body([=](const Vec3& x) {
    const Vec3 q = x - Vec3(0, 0, outer - depth);
    const Vec3 out = Vec3(q.x(), 0.0, q.z()).normalized();
    geometry::DistanceSample found = around(q, (outer - section) * out, section);
    found.closest += Vec3(0, 0, outer - depth);
    return found;
  });
}

/// The flat end of a round bar with a sharp edge.
Body punch(double radius, double depth) {
  return Body([=](const Vec3& x) -> geometry::DistanceSample {
    const double rho = std::hypot(x.x(), x.y());
    const Vec3 out = rho > 0.0 ? Vec3(x.x() / rho, x.y() / rho, 0.0) : Vec3(Vec3::UnitX());
    const double below = -depth - x.z();  // outside the end if positive
    const double beside = rho - radius;
    if (below <= 0.0 && beside <= 0.0) {
      if (below > beside) return {below, {x.x(), x.y(), -depth}, -Vec3::UnitZ(), -1};
      return {beside, x - beside * out, out, -1};
    }
    const Vec3 near = std::min(rho, radius) * out + Vec3(0, 0, std::max(x.z(), -depth));
    return {(x - near).norm(), near, (x - near).normalized(), -1};
  });
}

constexpr std::array<double, 3> kSpacing = {2.5, 1.25, 0.6};  // mm
// What is allowed at these spacings; our choice, before the first run.
constexpr std::array<double, 3> kForceShare = {0.05, 0.03, 0.02};
constexpr std::array<double, 3> kAreaShare = {0.15, 0.10, 0.05};
constexpr std::array<double, 3> kPeakShare = {0.10, 0.05, 0.05};

struct ClosedForm {
  std::string name, source;
  double force = 0.0;  ///< N
  double area = 0.0;   ///< mm^2; 0: not compared
  double peak = 0.0;   ///< MPa; 0: not compared
};

using Skins = std::array<std::unique_ptr<contact::PreparedHand>, 3>;

void add_form(ValidationRows& rows, const Skins& skins, const Body& body, const ClosedForm& form) {
  contact::ContactOptions options;
  options.shear_modulus = kModulus;
  std::array<double, 3> error{};
  for (std::size_t i = 0; i < kSpacing.size(); ++i) {
    const contact::ContactResult contact = contact::solve_hand_contact(
        *skins[i], skins[i]->hand().skin.vertices, geometry::Rigid3(), body, options);
    const std::string at =
        " on a mesh of " + std::to_string(kSpacing[i]).substr(0, i == 1 ? 4 : 3) + " mm";
    error[i] = std::abs(contact.total.force / form.force - 1.0);
    rows.push_back(judge(form.name + ", force" + at, "N", contact.total.force,
                         near_value(form.force, kForceShare[i], form.source)));
    if (form.area > 0.0) {
      rows.push_back(judge(form.name + ", area" + at, "mm2", contact.total.area,
                           near_value(form.area, kAreaShare[i], form.source)));
    }
    if (form.peak > 0.0) {
      rows.push_back(judge(form.name + ", peak pressure" + at, "kPa",
                           1e3 * contact.total.peak_pressure,
                           near_value(1e3 * form.peak, kPeakShare[i], form.source)));
    }
  }
  // A mesh four times as fine leaves no more of the error, unless it was nothing to begin with.
  const double no_error = 0.005;
  rows.push_back(
      judge(form.name + ", error of the force at 0.6 mm over that at 2.5 mm, at least 0.5 %", "",
            error[2] / std::max(error[0], no_error), at_most(1.0, "convergence with the mesh")));
}

}  // namespace

ValidationRows validate_skin_meshes(ValidationBench& bench) {
  ValidationRows rows;
  Skins skins;
  for (std::size_t i = 0; i < kSpacing.size(); ++i) {
    bench.update(0.2 * static_cast<double>(i), "case skin, meshes");
    skins[i] =
        std::make_unique<contact::PreparedHand>(flat_hand(kSpacing[i]), contact::ContactModel{});
  }
  {
    // Shallow, as all shapes here: the solver's gaps are distances to the nearest point, Hertz' run
    // along the press. A first version, 20 mm and 1.5 mm deep, came out 3 % softer on every mesh.
    const double radius = 80.0, depth = 0.4;
    const double force = 16.0 / 3.0 * kModulus * std::sqrt(radius) * std::pow(depth, 1.5);
    const double area = kCircle * radius * depth;
    add_form(
        rows, skins, sphere(radius, depth),
        {"sphere of 80 mm, 0.4 mm deep", "Hertz; G = 50 kPa", force, area, 1.5 * force / area});
  }
  {
    // Johnson 1985, section 4.2, from a chosen ellipse.
    const double a = 5.0, b = 3.0, p0 = 0.01, ratio = p0 / (4.0 * kModulus);
    const double e2 = 1.0 - b * b / (a * a);
    const double K = std::comp_ellint_1(std::sqrt(e2)), E = std::comp_ellint_2(std::sqrt(e2));
    const double along = e2 * a * a / (2.0 * ratio * b * (K - E));
    const double across = e2 * a * a / (2.0 * ratio * b * (a * a / (b * b) * E - K));
    add_form(rows, skins, ring(across, along, ratio * b * K),
             {"ellipse of semi-axes 5 and 3 mm", "Hertz; G = 50 kPa",
              2.0 / 3.0 * kCircle * a * b * p0, kCircle * a * b, p0});
  }
  {
    // Each sphere meets skin that the other has lowered by its own field outside the contact
    // (Johnson 1985, eq. 3.42a), taken at its centre: w = p0 / (8 G a) ((2 a^2 - r^2) asin(a / r) +
    // a sqrt(r^2 - a^2)), p0 = 8 G a / (pi R), and a^2 = R (depth - w).
    const double radius = 62.5, depth = 0.1, apart = 8.0;
    double a2 = radius * depth;
    for (int i = 0; i < 50; ++i) {
      const double w = ((2.0 * a2 - apart * apart) * std::asin(std::sqrt(a2) / apart) +
                        std::sqrt(a2) * std::sqrt(apart * apart - a2)) /
                       (kCircle * radius);
      a2 = radius * (depth - w);
    }
    const double one = 16.0 / 3.0 * kModulus * a2 * std::sqrt(a2) / radius;
    add_form(rows, skins, two_spheres(radius, depth, apart),
             {"two spheres of 62.5 mm, 8 mm apart, 0.1 mm deep",
              "Hertz, each in the other's field; G = 50 kPa", 2.0 * one, 2.0 * kCircle * a2,
              1.5 * one / (kCircle * a2)});
  }
  for (const double depth : {0.05, 0.3}) {
    const double radius = 5.0;
    add_form(rows, skins, punch(radius, depth),
             {"sharp edge of a flat punch of 5 mm, " + std::string(depth < 0.1 ? "0.05" : "0.3") +
                  " mm deep",
              "F = 8 G a depth; G = 50 kPa", 8.0 * kModulus * radius * depth,
              kCircle * radius * radius});
  }
  set_history(rows, "f5d121d");
  return rows;
}

}  // namespace palmar::validation
