// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/board/charuco.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/aruco/charuco.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "palmar/core/error.h"

namespace palmar::board {
namespace {

/// Corners closer to the border of the picture than this may be cut markers' guesses.
constexpr float kBorder = 4.0F;  // pixels

}  // namespace

struct CharucoFinder::Impl {
  cv::Ptr<cv::aruco::CharucoBoard> board;
  cv::Point2f shift{0.0F, 0.0F};  ///< what OpenCV's own corners are too far to the right and down

  /// Ids and pixels as OpenCV has them.
  void find_coarse(const cv::Mat& image, std::vector<int>& ids,
                   std::vector<cv::Point2f>& pixels) const {
    const auto parameters = cv::aruco::DetectorParameters::create();
    // Markers that lie flat in the distance are small and dim.
    parameters->adaptiveThreshWinSizeMax = 35;
    parameters->minMarkerPerimeterRate = 0.02;
    std::vector<std::vector<cv::Point2f>> markers, rejected;
    std::vector<int> marker_ids;
    cv::aruco::detectMarkers(image, board->dictionary, markers, marker_ids, parameters, rejected);
    if (marker_ids.empty()) return;
    cv::aruco::interpolateCornersCharuco(markers, marker_ids, image, board, pixels, ids);
  }

  void find(const cv::Mat& image, std::vector<int>& ids, std::vector<cv::Point2f>& pixels) const {
    find_coarse(image, ids, pixels);
    if (!ids.empty()) refine(image, pixels);
  }

  /// Saddle points where the corners are, to a hundredth of a pixel: in windows that hold nothing
  /// of the markers, however the board is tilted.
  void refine(const cv::Mat& image, std::vector<cv::Point2f>& pixels) const {
    const std::vector<cv::Point2f> found = pixels;
    // Edges sharper than a pixel hide where between two pixels they are.
    constexpr double kBlur = 1.0;  // pixels
    cv::Mat smooth;
    cv::GaussianBlur(image, smooth, cv::Size(0, 0), kBlur);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      double nearest = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < pixels.size(); ++j) {
        if (j != i) nearest = std::min(nearest, cv::norm(found[i] - found[j]));
      }
      constexpr double kShare = 0.12;  // of a square: where its marker begins
      const int half = static_cast<int>(std::clamp(kShare * nearest, 2.0, 9.0));
      std::vector<cv::Point2f> one = {found[i] - shift};
      cv::cornerSubPix(
          smooth, one, cv::Size(half, half), cv::Size(-1, -1),
          cv::TermCriteria(cv::TermCriteria::EPS + cv::TermCriteria::MAX_ITER, 50, 1e-3));
      // Far from where it began lies something else.
      if (cv::norm(one[0] - found[i] + shift) < half)
        pixels[i] = one[0];
      else
        pixels[i] = found[i] - shift;
    }
  }
};

CharucoFinder::CharucoFinder(const capture::BoardPattern& pattern) : impl_(new Impl) {
  pattern.check();
  const auto dictionary = cv::aruco::getPredefinedDictionary(cv::aruco::DICT_5X5_250);
  impl_->board = cv::aruco::CharucoBoard::create(pattern.squares, pattern.squares,
                                                 static_cast<float>(pattern.square),
                                                 static_cast<float>(pattern.marker), dictionary);
  constexpr int kPixels = 48;  // per square
  const capture::BoardPicture picture = draw(kPixels);
  cv::Mat drawn(picture.pixels, picture.pixels, CV_8UC1,
                const_cast<std::uint8_t*>(picture.grey.data())),
      framed;
  cv::copyMakeBorder(drawn, framed, kPixels, kPixels, kPixels, kPixels, cv::BORDER_CONSTANT, 255);
  std::vector<int> ids;
  std::vector<cv::Point2f> pixels;
  impl_->find_coarse(framed, ids, pixels);
  if (static_cast<int>(ids.size()) != pattern.corner_count()) {
    throw NumericalError(fmt::format(
        "the board as drawn shows {} of its {} corners; this version of OpenCV doesn't know it",
        ids.size(), pattern.corner_count()));
  }
  world_.resize(ids.size());
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < ids.size(); ++i) {
    // Between two pixels: the edge before pixel n lies at n - 1/2.
    const Eigen::Vector2d at(pixels[i].x - kPixels + 0.5, pixels[i].y - kPixels + 0.5);
    const auto column = static_cast<int>(std::lround(at.x() / kPixels));
    const auto row = static_cast<int>(std::lround(at.y() / kPixels));
    world_.at(ids[i]) = pattern.corner(column, row);
    sum += at - Eigen::Vector2d(column, row) * kPixels;
  }
  offset_ = sum / static_cast<double>(ids.size());
  impl_->shift = cv::Point2f(static_cast<float>(offset_.x()), static_cast<float>(offset_.y()));
}

CharucoFinder::~CharucoFinder() = default;

capture::BoardPicture CharucoFinder::draw(int pixels_per_square) const {
  const cv::Size size = impl_->board->getChessboardSize() * pixels_per_square;
  cv::Mat image;
  impl_->board->draw(size, image, 0, 1);
  capture::BoardPicture picture;
  picture.pixels = image.cols;
  for (int y = 0; y < image.rows; ++y) {
    picture.grey.insert(picture.grey.end(), image.ptr(y), image.ptr(y) + image.cols);
  }
  return picture;
}

std::vector<capture::BoardCorner> CharucoFinder::find(const std::vector<std::uint8_t>& grey,
                                                      int width, int height) const {
  const cv::Mat image(height, width, CV_8UC1, const_cast<std::uint8_t*>(grey.data()));
  std::vector<int> ids;
  std::vector<cv::Point2f> pixels;
  impl_->find(image, ids, pixels);
  std::vector<capture::BoardCorner> corners;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const cv::Point2f& p = pixels[i];
    if (!(p.x > kBorder && p.y > kBorder && p.x < static_cast<float>(width) - kBorder &&
          p.y < static_cast<float>(height) - kBorder)) {
      continue;
    }
    corners.push_back({ids[i], world_.at(ids[i]), Eigen::Vector2d(p.x, p.y)});
  }
  std::sort(
      corners.begin(), corners.end(),
      [](const capture::BoardCorner& a, const capture::BoardCorner& b) { return a.id < b.id; });
  return corners;
}

}  // namespace palmar::board
