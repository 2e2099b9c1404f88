// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/capture/mri/bones/image_registration.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string_view>

#include "hands/imaging/gaussian_filter.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/statistics/correlation.h"
#include "palmar/statistics/median.h"

namespace palmar::capture {
namespace {

// Unknowns: turn, shift, gain, its three slopes, offset.
constexpr int kUnknowns = 11;
using Vec11 = Eigen::Matrix<double, kUnknowns, 1>;
using Vec6 = Eigen::Matrix<double, 6, 1>;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Mat11 = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Tone = Eigen::Matrix<double, 5, 1>;  // gain, its slopes, offset

constexpr double kFineBlur = 0.6;    // mm; finer detail is noise and the grid's own pattern
constexpr double kCoarseBlur = 1.5;  // mm; half a bone's shell and marrow: a start may be 3 mm off
constexpr double kSmallVolume = 150.0;  // mm^3
constexpr double kSmallLayer = 2.0;     // mm
constexpr double kPerVoxel = 0.6;       // of the voxels' mean edge, if that is more

/// Weights of the four voxels about a place between the middle two (Keys 1981, a = -1/2), and
/// their derivatives.
void keys_weights(double t, std::array<double, 4>& w, std::array<double, 4>& d) {
  const double t2 = t * t, t3 = t2 * t;
  w = {0.5 * (-t3 + 2.0 * t2 - t), 0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
       0.5 * (-3.0 * t3 + 4.0 * t2 + t), 0.5 * (t3 - t2)};
  d = {0.5 * (-3.0 * t2 + 4.0 * t - 1.0), 0.5 * (9.0 * t2 - 10.0 * t),
       0.5 * (-9.0 * t2 + 8.0 * t + 1.0), 0.5 * (3.0 * t2 - 2.0 * t)};
}

struct Intensity {
  double value = 0.0;
  Vec3 gradient = Vec3::Zero();  ///< patient frame, 1/mm
};

/// Between voxels by cubic convolution; nothing within a voxel of the image's border.
class CubicImage {
 public:
  explicit CubicImage(const imaging::Volume& image)
      : image_(image),
        voxel_from_patient_(image.grid.spacing.cwiseInverse().asDiagonal() *
                            image.grid.axes.transpose()) {}

  std::optional<Intensity> operator()(const Vec3& patient) const {
    const imaging::VolumeGrid& grid = image_.grid;
    const Vec3 voxel = voxel_from_patient_ * (patient - grid.origin);
    std::array<int, 3> low{};
    std::array<std::array<double, 4>, 3> w, d;
    for (std::size_t a = 0; a < 3; ++a) {
      const double place = voxel[static_cast<Eigen::Index>(a)];
      if (!(place >= 1.0 && place < grid.size[a] - 2.0)) return {};
      low[a] = static_cast<int>(place);
      keys_weights(place - low[a], w[a], d[a]);
    }
    Intensity result;
    Vec3 slope = Vec3::Zero();
    for (int k = 0; k < 4; ++k) {
      double plane = 0.0, plane_i = 0.0, plane_j = 0.0;
      for (int j = 0; j < 4; ++j) {
        const float* row =
            image_.value.data() + grid.at(low[0] - 1, low[1] + j - 1, low[2] + k - 1);
        double line = 0.0, line_i = 0.0;
        for (std::size_t i = 0; i < 4; ++i) {
          line += w[0][i] * static_cast<double>(row[i]);
          line_i += d[0][i] * static_cast<double>(row[i]);
        }
        plane += w[1][j] * line;
        plane_i += w[1][j] * line_i;
        plane_j += d[1][j] * line;
      }
      result.value += w[2][k] * plane;
      slope += Vec3(w[2][k] * plane_i, w[2][k] * plane_j, d[2][k] * plane);
    }
    result.gradient = voxel_from_patient_.transpose() * slope;
    return result;
  }

 private:
  const imaging::Volume& image_;
  Eigen::Matrix3d voxel_from_patient_;
};

/// As much as `least` for fine voxels, and in proportion for coarse ones.
ImageLevels::Level blurred(const imaging::Volume& image, double least) {
  const double edge = std::cbrt(image.grid.spacing.prod());
  const double blur = least * std::max(1.0, kPerVoxel * edge / kFineBlur);
  return {imaging::gaussian_filtered(image, blur), blur};
}

/// Sums of the weighted rows' products: A x = b for the step and the tone.
struct Equations {
  Mat11 A = Mat11::Zero();
  Vec11 b = Vec11::Zero();
  Mat6 held = Mat6::Zero();  ///< the motion's rows by one image with those by the other
  double variance = 0.0;     ///< weighted mean square of the residuals
};

/// Of turn (in units of 1 / radius) and shift; `alike`: so many samples share their noise.
std::array<double, 2> standard_errors(const Equations& sums, double alike) {
  Mat11 A = sums.A;
  A.topLeftCorner<6, 6>() = sums.held;
  const Eigen::SelfAdjointEigenSolver<Mat11> solver(A);
  constexpr double kNothing = std::numeric_limits<double>::infinity();
  if (solver.info() != Eigen::Success || !(solver.eigenvalues()[0] > 0.0)) {
    return {kNothing, kNothing};
  }
  const Mat11 covariance = alike * sums.variance * A.ldlt().solve(Mat11::Identity());
  return {std::sqrt(covariance.topLeftCorner<3, 3>().trace()),
          std::sqrt(covariance.block<3, 3>(3, 3).trace())};
}

}  // namespace

ImageLevels blurred_levels(const imaging::Volume& image) {
  return {blurred(image, kFineBlur), blurred(image, kCoarseBlur)};
}

void ImageFitOptions::check() const {
  const auto require = [](bool holds, std::string_view field, double value, const char* allowed) {
    if (!holds) {
      throw UsageError(fmt::format("image fit: {} is {:g}; {} is required", field, value, allowed));
    }
  };
  require(layer >= 0.0 && layer <= 5.0, "layer", layer, "0 to 5 mm");
  require(max_samples >= 50, "max_samples", max_samples, "50 or more");
  require(max_iterations >= 1, "max_iterations", max_iterations, "1 or more");
  require(tolerance > 0.0 && tolerance <= 1.0, "tolerance", tolerance,
          "more than 0 and up to 1 mm");
}

/// Where a bone lies in the other image, and what the intensities say there.
struct BoneImage::Place {
  geometry::Rigid3 motion;
  Tone tone = Tone::Zero();
  double limit = std::numeric_limits<double>::infinity();  ///< residuals beyond it have no weight
  double turn_error = std::numeric_limits<double>::infinity();
  double shift_error = std::numeric_limits<double>::infinity();
  bool has_converged = false;
};

/// One sample: J(M x) at the place, and how the residual changes with the unknowns; that of tone
/// `a` is intensity + slope.tail<5>() . a.
struct BoneImage::Row {
  Vec11 slope;       ///< by the mean of both images' gradients
  Vec6 here, there;  ///< by the bone's own image and by the other one
  double intensity;

  double residual(const Tone& tone) const { return intensity + slope.tail<5>().dot(tone); }
};

BoneImage::BoneImage(const geometry::TriangleMesh& bone, const ImageLevels& image,
                     const ImageFitOptions& options)
    : options_(options) {
  options.check();
  const imaging::VolumeGrid& grid = image.fine.image.grid;
  std::array<int, 3> low = grid.size, high = {-1, -1, -1};
  for (const Vec3& v : bone.vertices) {
    const Vec3 voxel = grid.to_voxel(v);
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      const double reach = options.layer / grid.spacing[i];
      low[a] = std::max(0, std::min(low[a], static_cast<int>(std::ceil(voxel[i] - reach))));
      high[a] = std::min(grid.size[a] - 1,
                         std::max(high[a], static_cast<int>(std::floor(voxel[i] + reach))));
    }
  }
  std::vector<Vec3> points;
  for (int k = low[2]; k <= high[2]; ++k) {
    for (int j = low[1]; j <= high[1]; ++j) {
      for (int i = low[0]; i <= high[0]; ++i) {
        points.push_back(grid.to_patient(Vec3(i, j, k)));
      }
    }
  }
  const CubicImage fine(image.fine.image), coarse(image.coarse.image);
  const geometry::MeshDistance surface(bone);
  std::vector<geometry::DistanceSample> found(points.size());
  surface.sample(points, options.layer + 1.0, found);
  for (std::size_t n = 0; n < points.size(); ++n) {
    if (found[n].distance > options.layer) continue;
    const std::optional<Intensity> a = fine(points[n]), b = coarse(points[n]);
    if (a && b) samples_.push_back({points[n], a->value, b->value, a->gradient, b->gradient});
  }
  constexpr std::size_t kLeast = 30;
  if (samples_.size() < kLeast) {
    throw InputError(fmt::format("image of a bone: {} voxels are in it; {} or more are required",
                                 samples_.size(), kLeast));
  }
  share_ = grid.spacing.prod();
  if (const auto most = static_cast<std::size_t>(options.max_samples); samples_.size() > most) {
    // Evenly thinned along the voxels' order.
    std::vector<Sample> kept;
    for (std::size_t n = 0; n < most; ++n) kept.push_back(samples_[n * samples_.size() / most]);
    share_ *= static_cast<double>(samples_.size()) / static_cast<double>(most);
    samples_ = std::move(kept);
  }
  const auto count = static_cast<double>(samples_.size());
  for (const Sample& s : samples_) centre_ += s.point / count;
  double square = 0.0;
  for (const Sample& s : samples_) square += (s.point - centre_).squaredNorm() / count;
  radius_ = std::sqrt(square);
}

double BoneImage::coarse_correlation(const ImageLevels& other,
                                     const geometry::Rigid3& motion) const {
  constexpr std::size_t kLooks = 400;
  const std::size_t step = std::max<std::size_t>(1, samples_.size() / kLooks);
  const imaging::Volume& image = other.coarse.image;
  std::vector<double> mine, theirs;
  for (std::size_t s = 0; s < samples_.size(); s += step) {
    mine.push_back(samples_[s].coarse);
    theirs.push_back(static_cast<double>(
        imaging::value_at(image, image.grid.to_voxel(motion * samples_[s].point))));
  }
  return statistics::pearson(mine, theirs).r;
}

std::vector<BoneImage::Row> BoneImage::rows_at(const ImageLevels::Level& level, bool is_fine,
                                               const Place& place) const {
  const CubicImage image(level.image);
  const Vec3 middle = place.motion * centre_;
  std::vector<Row> rows;
  rows.reserve(samples_.size());
  for (const Sample& s : samples_) {
    const Vec3 moved = place.motion * s.point;
    const std::optional<Intensity> other = image(moved);
    if (!other) continue;
    const auto slope_by = [&](const Vec3& gradient) {
      Vec6 slope;
      slope << (moved - middle).cross(gradient) / radius_, gradient;
      return slope;
    };
    const double t = is_fine ? s.fine : s.coarse;
    const Vec3& gradient = is_fine ? s.fine_gradient : s.coarse_gradient;
    Row row;
    row.there = slope_by(other->gradient);
    // Before the gain is known the other image speaks alone.
    row.here = place.tone[0] > 0.0 ? slope_by(place.tone[0] * (place.motion.rotation * gradient))
                                   : row.there;
    row.slope << 0.5 * (row.here + row.there), -t, -t * (s.point - centre_) / radius_, -1.0;
    row.intensity = other->value;
    rows.push_back(row);
  }
  return rows;
}

// A loop of its own, not solve_least_squares(): samples and their weights are other ones after each
// step, so there is no sum of squares that steps could be held against.
void BoneImage::refine(const ImageLevels::Level& level, bool is_fine, Place& place) const {
  // Noise is alike within the blur: of N samples so many times fewer count.
  const double alike =
      std::max(1.0, std::pow(4.0 * std::numbers::pi * level.blur * level.blur, 1.5) / share_);
  place.has_converged = false;
  for (int iteration = 0; iteration < options_.max_iterations; ++iteration) {
    const std::vector<Row> rows = rows_at(level, is_fine, place);
    if (rows.size() < 3 * kUnknowns) return;
    // Tone at this place, first by all samples alike, then by their weights.
    Equations sums;
    place.limit = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < 3; ++pass) {
      sums = {};
      double total = 0.0;
      for (const Row& row : rows) {
        const double residual = row.residual(place.tone);
        const double ratio = residual / place.limit;
        const double weight = std::abs(ratio) < 1.0 ? std::pow(1.0 - ratio * ratio, 2) : 0.0;
        sums.A.noalias() += weight * row.slope * row.slope.transpose();
        sums.held.noalias() +=
            0.5 * weight * (row.here * row.there.transpose() + row.there * row.here.transpose());
        sums.b -= weight * row.intensity * row.slope;
        sums.variance += weight * residual * residual;
        total += weight;
      }
      sums.variance /= std::max(total, 1.0);
      // The field changes little over one bone.
      constexpr double kHeldSlope = 1e-3;  // of what holds the gain
      for (int k = 7; k < 10; ++k) sums.A(k, k) += kHeldSlope * sums.A(6, 6);
      const Eigen::Matrix<double, 5, 5> A = sums.A.bottomRightCorner<5, 5>();
      const Tone tone = A.ldlt().solve(sums.b.tail<5>());
      if (!tone.allFinite()) return;
      place.tone = tone;
      std::vector<double> sizes;
      sizes.reserve(rows.size());
      for (const Row& row : rows) sizes.push_back(std::abs(row.residual(tone)));
      constexpr double kPerMedian = 1.4826;  // standard deviation of a normal distribution
      place.limit =
          4.685 * kPerMedian * statistics::median(std::move(sizes)) + 1e-9 * std::abs(tone[0]);
    }
    // Held a little where the intensities don't hold it.
    sums.A.topLeftCorner<6, 6>().diagonal().array() += 1e-6 * sums.A.topLeftCorner<6, 6>().trace();
    Vec11 step = sums.A.ldlt().solve(sums.b);
    if (!step.allFinite()) return;
    const std::array<double, 2> errors = standard_errors(sums, alike);
    place.turn_error = errors[0] / radius_;
    place.shift_error = errors[1];
    // Gradients hold over about the blur.
    const double reach = 2.0 * step.head<3>().norm() + step.segment<3>(3).norm();
    step *= std::min(1.0, 1.5 * level.blur / std::max(reach, 1e-300));
    const Vec3 turn = step.head<3>() / radius_;
    const double angle = turn.norm();
    const Quat q = angle > 0.0 ? Quat(Eigen::AngleAxisd(angle, turn / angle)) : Quat::Identity();
    const Vec3 middle = place.motion * centre_;
    place.motion = geometry::Rigid3{q, middle - q * middle + step.segment<3>(3)} * place.motion;
    if (reach < options_.tolerance) {
      place.has_converged = true;
      return;
    }
  }
}

ImageFit BoneImage::finished(const ImageLevels& other, Place place) const {
  refine(other.fine, true, place);
  ImageFit fit;
  fit.fixed_from_moving = place.motion;
  fit.turn_error = place.turn_error;
  fit.shift_error = place.shift_error;
  fit.has_converged = place.has_converged;
  const std::vector<Row> rows = rows_at(other.fine, true, place);
  fit.overlap = static_cast<double>(rows.size()) / static_cast<double>(samples_.size());
  if (rows.size() < 3 * kUnknowns || !(place.tone[0] > 0.0)) return fit;
  std::vector<double> mine, theirs;
  for (const Row& row : rows) {
    if (std::abs(row.residual(place.tone)) > place.limit) continue;
    mine.push_back(-row.slope[6]);
    theirs.push_back(row.intensity);
  }
  if (mine.size() >= 3) fit.correlation = statistics::pearson(mine, theirs).r;
  return fit;
}

ImageFit BoneImage::fit(const ImageLevels& other, const geometry::Rigid3& start) const {
  Place place;
  place.motion = start;
  refine(other.coarse, false, place);
  return finished(other, place);
}

ImageFit BoneImage::find(const ImageLevels& other, std::span<const geometry::Rigid3> starts) const {
  if (starts.empty()) throw UsageError("image of a bone: no start to search from");
  constexpr std::size_t kFollowed = 12, kFinished = 3;
  std::vector<std::pair<double, std::size_t>> rank;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    rank.emplace_back(-coarse_correlation(other, starts[k]), k);
  }
  std::sort(rank.begin(), rank.end());
  std::vector<std::pair<double, geometry::Rigid3>> followed;
  for (std::size_t k = 0; k < std::min(kFollowed, rank.size()); ++k) {
    Place place;
    place.motion = starts[rank[k].second];
    refine(other.coarse, false, place);
    // Several starts end at one place.
    const bool is_new = std::none_of(followed.begin(), followed.end(), [&](const auto& before) {
      const geometry::Rigid3 between = before.second.inverse() * place.motion;
      return (between * centre_ - centre_).norm() < 0.3 &&               // mm
             between.rotation.angularDistance(Quat::Identity()) < 0.05;  // rad
    });
    if (is_new) followed.emplace_back(-coarse_correlation(other, place.motion), place.motion);
  }
  std::stable_sort(followed.begin(), followed.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  ImageFit best;
  best.correlation = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < std::min(kFinished, followed.size()); ++k) {
    Place place;
    place.motion = followed[k].second;
    const ImageFit one = finished(other, place);
    if (one.correlation > best.correlation) best = one;
  }
  return best;
}

BoneImages images_of_bones(const ScanSurfaces& surfaces, const ImageLevels& image,
                           const ImageFitOptions& options) {
  std::vector<std::optional<BoneImage>> made(surfaces.bones.size());
  parallel_for(static_cast<int>(made.size()), [&](int b) {
    const ScannedBone& bone = surfaces.bones[b];
    if (bone.name.empty()) return;
    try {
      ImageFitOptions fitting = options;
      if (geometry::signed_volume(bone.mesh) < kSmallVolume) {
        fitting.layer = std::max(fitting.layer, kSmallLayer);
      }
      made[b].emplace(bone.mesh, image, fitting);
    } catch (const InputError&) {
      // Too small to be compared; its surface counts.
    }
  });
  BoneImages images;
  for (std::size_t b = 0; b < made.size(); ++b) {
    if (made[b]) images.emplace(surfaces.bones[b].name, std::move(*made[b]));
  }
  return images;
}

}  // namespace palmar::capture
