// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "hands/board/picture_matches.h"

#include <opencv2/features2d.hpp>

#include "palmar/core/parallel.h"

namespace palmar::board {
namespace {

/// For every descriptor of a its nearest of b, if that is distinct; else -1.
std::vector<int> nearest(const cv::Mat& a, const cv::Mat& b, double ratio) {
  std::vector<int> best(a.rows, -1);
  if (b.rows < 2) return best;
  // |x - y|^2 = |x|^2 + |y|^2 - 2 x y, all at once.
  cv::Mat products;
  cv::gemm(a, b, -2.0, cv::noArray(), 0.0, products, cv::GEMM_2_T);
  std::vector<float> square(b.rows);
  for (int j = 0; j < b.rows; ++j) square[j] = static_cast<float>(b.row(j).dot(b.row(j)));
  for (int i = 0; i < a.rows; ++i) {
    const float* const row = products.ptr<float>(i);
    int first = -1;
    float d1 = 3e38F, d2 = 3e38F;
    for (int j = 0; j < b.rows; ++j) {
      const float d = row[j] + square[j];
      if (d < d1) {
        d2 = d1;
        d1 = d;
        first = j;
      } else if (d < d2) {
        d2 = d;
      }
    }
    const auto own = static_cast<float>(a.row(i).dot(a.row(i)));
    const auto limit = static_cast<float>(ratio * ratio);
    if (d1 + own < limit * (d2 + own)) best[i] = first;
  }
  return best;
}

}  // namespace

PictureMatches match_pictures(const std::vector<MaskedPicture>& pictures,
                              const std::vector<std::array<int, 2>>& pairs, double ratio,
                              int most_points, const Progress& progress) {
  cv::setNumThreads(1);
  PictureMatches result;
  result.point.resize(pictures.size());
  std::vector<cv::Mat> descriptors(pictures.size());
  progress.update(0.0, "finding distinct points");
  parallel_for(static_cast<int>(pictures.size()), [&](int i) {
    const MaskedPicture& picture = pictures[i];
    const cv::Mat grey(picture.height, picture.width, CV_8UC1,
                       const_cast<std::uint8_t*>(picture.grey.data()));
    const cv::Mat inside(picture.height, picture.width, CV_8UC1,
                         const_cast<std::uint8_t*>(picture.inside.data()));
    // Skin has little contrast: a low threshold.
    constexpr double kContrast = 0.012, kEdge = 10.0;
    const auto sift = cv::SIFT::create(most_points, 3, kContrast, kEdge, 1.2);
    std::vector<cv::KeyPoint> points;
    sift->detectAndCompute(grey, inside, points, descriptors[i]);
    for (const cv::KeyPoint& point : points) result.point[i].push_back({point.pt.x, point.pt.y});
  });
  result.pairs.resize(pairs.size());
  progress.update(0.4, "matching them");
  parallel_for(static_cast<int>(pairs.size()), [&](int i) {
    progress.throw_if_cancelled();
    PictureMatches::Pair& pair = result.pairs[i];
    pair.first = pairs[i][0];
    pair.second = pairs[i][1];
    const cv::Mat& a = descriptors[pair.first];
    const cv::Mat& b = descriptors[pair.second];
    if (a.empty() || b.empty()) return;
    const std::vector<int> there = nearest(a, b, ratio), back = nearest(b, a, ratio);
    for (std::size_t k = 0; k < there.size(); ++k) {
      if (there[k] >= 0 && back[there[k]] == static_cast<int>(k)) {
        pair.match.push_back({static_cast<int>(k), there[k]});
      }
    }
  });
  return result;
}

}  // namespace palmar::board
