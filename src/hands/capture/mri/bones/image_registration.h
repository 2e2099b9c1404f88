// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "hands/capture/mri/scan_surfaces.h"
#include "hands/imaging/volume.h"
#include "palmar/geometry/rigid3.h"
#include "palmar/geometry/types.h"

namespace palmar::capture {

/// An image ready to be compared with another one: blurred a little and strongly. As it comes from
/// the scanner; a coil's field needn't be taken out.
struct ImageLevels {
  struct Level {
    imaging::Volume image;
    double blur = 0.0;  ///< standard deviation of the Gaussian, mm
  };
  Level fine, coarse;
};
ImageLevels blurred_levels(const imaging::Volume& image);

struct ImageFitOptions {
  double layer = 0.5;       ///< mm outside of the bone's surface that count as well
  int max_samples = 6000;   ///< voxels that are compared at most
  int max_iterations = 30;  ///< on each level
  double tolerance = 2e-3;  ///< mm; a step that moves no sample farther ends a level
  void check() const;       ///< throws UsageError: field, value, allowed range
};

/// How a bone of one image was placed on another image.
struct ImageFit {
  geometry::Rigid3 fixed_from_moving;
  /// Of the two images' intensities over the samples that have a weight, [-1, 1]: what lies wrong
  /// in the bone's own surface doesn't lower it.
  double correlation = 0.0;
  double overlap = 0.0;  ///< share of the samples that lie within the other image
  /// Standard errors by the normal equations, noise of neighbours taken for correlated as far as
  /// the blur makes it: of the turn (root of the summed variances about three axes), rad, and of
  /// the shift of the samples' middle, mm. Gradients of one image are multiplied by those of the
  /// other there, so that noise doesn't pass for something that holds the bone. Infinite if nothing
  /// holds it.
  double turn_error = 0.0, shift_error = 0.0;
  bool has_converged = false;
};

/// What one image shows of a bone: intensities T_i at its voxels x_i inside of the bone's surface
/// and a thin layer round it. Laid on another image J of the same person by the motion M that makes
///
///     sum_i w_i (J(M x_i) - (a + b . (x_i - c)) T_i - o)^2
///
/// least, with the motion's gain a, its slope b over the bone [1/mm], and an offset o, solved
/// along: they stand for what the coil's field and the scanner's scaling change. Gauss-Newton
/// (Lucas, Kanade 1981) with the mean of both images' gradients (Benhimane, Malis 2004), gain and
/// offset as in Evangelidis, Psarakis 2008; w_i are Tukey's biweights at 4.685 times the residuals'
/// median deviation, as soft tissue outside moves otherwise. From the strong blur to the weak one;
/// cubic convolution between voxels (Keys 1981). No edge has to be found in the other image, so a
/// bone that can't be cut out there is still found.
///
/// Starts within about 3 mm and 10 degrees reach the right place; farther ones need
/// find(). What isn't held by the intensities (a turn about the axis of a round shaft)
/// stays as it starts, and turn_error says so. Deterministic.
class BoneImage {
 public:
  /// Throws InputError for a surface that holds no voxel of the image.
  BoneImage(const geometry::TriangleMesh& bone, const ImageLevels& image,
            const ImageFitOptions& options = {});

  /// From one start.
  ImageFit fit(const ImageLevels& other, const geometry::Rigid3& start) const;
  /// From the best of many starts: those of highest correlation under the strong blur are followed.
  /// Throws UsageError without starts.
  ImageFit find(const ImageLevels& other, std::span<const geometry::Rigid3> starts) const;

  const Vec3& centre() const { return centre_; }  ///< of the samples, mm

 private:
  struct Sample {
    Vec3 point;
    double fine, coarse;
    Vec3 fine_gradient, coarse_gradient;  ///< 1/mm
  };
  struct Place;
  struct Row;
  std::vector<Row> rows_at(const ImageLevels::Level& level, bool is_fine, const Place& place) const;
  void refine(const ImageLevels::Level& level, bool is_fine, Place& place) const;
  double coarse_correlation(const ImageLevels& other, const geometry::Rigid3& motion) const;
  ImageFit finished(const ImageLevels& other, Place place) const;

  ImageFitOptions options_;
  std::vector<Sample> samples_;
  Vec3 centre_ = Vec3::Zero();
  double radius_ = 1.0;  ///< root mean square distance of the samples from their centre, mm
  double share_ = 1.0;   ///< volume that a sample stands for, mm^3
};

/// By the bones' names.
using BoneImages = std::map<std::string, BoneImage>;
/// Of all bones that have a name and hold enough voxels. A bone of less than 150 mm^3 (a distal
/// phalanx of which a part was cut out) can't determine its turn by itself: the tissue round it, 2
/// mm, counts as well, most of which goes with it.
BoneImages images_of_bones(const ScanSurfaces& surfaces, const ImageLevels& image,
                           const ImageFitOptions& options = {});

}  // namespace palmar::capture
