// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/grasp/grasp.h"
#include "palmar/product/product.h"
#include "palmar/study/sensors/sensor_layout.h"

namespace palmar::study {

/// One cell of a sensor.
struct SensorCell {
  std::string patch;           ///< "mat", the region of a glove's patch, a free sensor's name
  int row = 1, column = 1;     ///< from 1
  double area = 0.0;           ///< mm^2
  double force = 0.0;          ///< N
  double mean_pressure = 0.0;  ///< force over the cell's area, MPa
  std::optional<hand::Region> region;  ///< of the hand that presses it most; unset where none does
};

/// What a sensor between hand and product would show.
struct SensorReading {
  SensorLayout layout;
  std::vector<SensorCell> cells;  ///< patch by patch, row by row, column by column
  int rows = 0, columns = 0;      ///< of a mat, as laid
  double force = 0.0;             ///< of all cells, N
  double force_beside = 0.0;      ///< on skin that presses beside the cells, N
  double peak_pressure = 0.0;     ///< highest cell, MPa
  double area = 0.0;              ///< of the cells that are pressed, mm^2
};

/// Lays a sensor between hand and product and adds up each cell's force. A vertex' force is spread
/// evenly over a square of the area that it presses on (on a glove: of its area at rest), along the
/// cells' rows; the part of it that lies over a cell is the cell's. So the cells' forces and the
/// force beside them add up to that of the contact.
///
/// A mat follows the convex outline of the product's section across the axis, row by row (it
/// bridges hollows, as a sheet does); what touches the product's ends (surface within 37 degrees of
/// being square to the axis) or farther than two cells from that outline presses beside it. A
/// glove's patches lie about the middle of their regions: unrolled round the bone on phalanges,
/// flat on the palm, in the open hand. Free sensors are discs; a force is spread over a disc, too,
/// and distances go straight.
///
/// Throws UsageError as SensorLayout::check(), or if the hand's skin isn't that of the contact.
SensorReading sensor_reading(const hand::Hand& hand, const product::Product& product,
                             const grasp::Grasp& grasp, const contact::ContactResult& contact,
                             const SensorLayout& layout);

}  // namespace palmar::study
