// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hands/capture/photo/photo_view.h"
#include "palmar/core/progress.h"
#include "palmar/geometry/mesh/textured_mesh.h"

namespace palmar::phantom {

/// The rig of the thesis and what can go wrong with it. Cameras stand round a board with a pattern,
/// at two heights by turns, and look at the hand that stands on its middle; the rig goes round in
/// steps.
struct PhotographsOptions {
  std::uint64_t seed = 1;
  int cameras = 6;
  int positions = 6;
  double step = 15.0;  ///< deg from position to position
  int width = 1080, height = 1440;
  double focal = 1.25;             ///< of the height; about, each camera has its own lens
  double distance = 455.0;         ///< from the middle of the hand, mm
  double low = 20.0, high = 46.0;  ///< heights of the cameras, deg
  double middle = 95.0;            ///< they look at, above the board, mm

  double texture = 0.07;   ///< unevenness of the skin, share of its colour
  double noise = 4.0;      ///< of the sensor, sRGB steps of 255
  double blur = 0.6;       ///< of lens and sensor, pixels
  double exposure = 0.05;  ///< deviation of the exposures, share
  double aperture = 0.8;   ///< diameter of the lens, mm: what isn't in focus is blurred
  double focus = 0.0;      ///< focus behind the middle of the hand, mm; negative: in front

  double gloss = 0.0;  ///< share of the light that oily skin mirrors
  /// Deviations of the lens' terms that PhotoLens lacks, see bent().
  double decentring = 0.0, sixth = 0.0;
  double vignetting = 0.0;    ///< share of the light that is lost in the corners
  double tone = 0.0;          ///< contrast that the camera adds in the middle of the scale, 0 to 1
  bool light_on_rig = false;  ///< lamps go round with the cameras
  bool clutter = false;       ///< warm things behind the hand instead of a blue cloth
  bool one_ring = false;      ///< all cameras at the lower height
  double motion = 0.0;        ///< of the hand between positions: RMS length, mm
  double motion_turn = 0.0;   ///< and RMS angle, deg
  void check() const;         ///< throws UsageError: field, value, allowed range
};

/// Terms of a lens that PhotoLens lacks: decentring p1, p2 and k3 r^6 (Brown 1966).
struct LensTerms {
  double p1 = 0.0, p2 = 0.0, k3 = 0.0;
};
/// Those of a camera, drawn from the seed.
LensTerms lens_terms(const PhotographsOptions& options, int camera);
/// Where the light of a pixel comes from that without these terms would come from (x, y, 1):
///   x (1 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2),   y (1 + k3 r^6) + p1 (r^2 + 2 y^2) + 2 p2 x y
Eigen::Vector2d bent(const LensTerms& terms, const Eigen::Vector2d& direction);

/// A printed board: a square picture, its middle the origin of the world, its x along the rows and
/// y up the columns; print 0 to 255.
struct PrintedBoard {
  int pixels = 0;  ///< along an edge; 0: plain white
  std::vector<std::uint8_t> grey;
  double edge = 396.0;        ///< of the pattern, mm
  double sheet = 420.0;       ///< of the white sheet that it is on, mm
  double sheet_height = 0.0;  ///< of the sheet along y; 0: square
  /// Of the table that it lies on, with a grain along x; nothing: a blue cloth.
  std::optional<geometry::Srgb> table = std::nullopt;
  double grain = 0.6;      ///< contrast of its grain
  double corner = 0.0;     ///< radius of the sheet's corners, mm
  double thickness = 0.0;  ///< with a table: of the sheet, a card, on it, mm; it throws no shadow
  std::optional<geometry::Srgb> paper = std::nullopt;  ///< colour of the sheet; nothing: white
};

/// Where and how one photograph is taken.
struct PhotoShot {
  int camera = 0, position = 0;
  capture::PhotoCamera pose;
  double gain = 1.0;  ///< of its exposure
};

struct PhotoShoot {
  std::vector<PhotoShot> shots;                   ///< position by position
  std::vector<geometry::Rigid3> board_from_hand;  ///< per position: how the hand moved; the first
                                                  ///< not
};

/// Cameras, lenses and motions, drawn from the seed.
PhotoShoot plan_photographs(const PhotographsOptions& options);

/// Shots with the board tilted in front of each camera, to calibrate its lens: `count` per camera,
/// as if the camera went round the board (position counts them).
std::vector<PhotoShot> plan_calibration(const PhotographsOptions& options, int count);

/// Takes photographs of a hand that stands on the board. Rays through four points of each pixel;
/// two soft lamps and light from all round, shadows, Lambert's law (and Phong's for gloss); skin
/// is uneven by noise of 0.6 to 9 mm that is fixed to it.
class PhotographsStage {
 public:
  /// `hand`: in the board's frame; keeps copies. An empty one: the board alone.
  PhotographsStage(const geometry::ColouredMesh& hand, const PrintedBoard& board,
                   const PhotographsOptions& options);
  ~PhotographsStage();
  /// `number` distinguishes photographs' noise. The same for any number of threads.
  geometry::RgbImage take(const PhotoShot& shot, const geometry::Rigid3& board_from_hand,
                          int number) const;

  struct Impl;

 private:
  std::unique_ptr<const Impl> impl_;
};

}  // namespace palmar::phantom
