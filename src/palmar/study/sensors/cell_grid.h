// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "palmar/core/enum_index.h"
#include "palmar/hand/anatomy.h"

namespace palmar::study {

/// Square cells in rows and columns that gather forces.
class CellGrid {
 public:
  CellGrid(int rows, int columns, double pitch)
      : rows_(rows), columns_(columns), pitch_(pitch), share_(rows * columns) {}

  /// Spreads a force over a square of `area` [mm^2] about (along, across), mm from the corner of
  /// row 1 and column 1. `girth` > 0: across comes round after so many mm. Returns the part of the
  /// force that falls beside the cells.
  double spread(double along, double across, double area, double force, hand::Region region,
                double girth = 0.0) {
    const double half = 0.5 * std::sqrt(area);
    double beside = force;
    for (const double turn : {0.0, -girth, girth}) {
      if (turn != 0.0 && girth <= 0.0) continue;
      const double centre = across + turn;
      for (int row = first(along - half); row <= last(along + half, rows_); ++row) {
        const double high = overlap(along, half, row);
        if (high <= 0.0) continue;
        for (int column = first(centre - half); column <= last(centre + half, columns_); ++column) {
          // A cell ends where the sheet has come round.
          const double wide = overlap(centre, half, column, girth > 0.0 ? girth : 1e300);
          if (wide <= 0.0) continue;
          const double part = force * high * wide / (4.0 * half * half);
          share_[row * columns_ + column][index_of(region)] += part;
          beside -= part;
        }
      }
      if (girth <= 0.0) break;
    }
    return std::max(beside, 0.0);
  }

  /// Force on a cell (from 0) by the region that presses it, N.
  const std::array<double, hand::kRegionCount>& share(int row, int column) const {
    return share_[row * columns_ + column];
  }
  int rows() const { return rows_; }
  int columns() const { return columns_; }

 private:
  int first(double from) const { return std::max(0, static_cast<int>(std::floor(from / pitch_))); }
  int last(double to, int count) const {
    return std::min(count - 1, static_cast<int>(std::floor(to / pitch_)));
  }
  double overlap(double centre, double half, int cell, double end = 1e300) const {
    return std::min({centre + half, (cell + 1) * pitch_, end}) -
           std::max(centre - half, cell * pitch_);
  }

  int rows_, columns_;
  double pitch_;
  std::vector<std::array<double, hand::kRegionCount>> share_;
};

}  // namespace palmar::study
