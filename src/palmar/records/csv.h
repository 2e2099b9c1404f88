// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "palmar/study/assessment/assessment.h"

namespace palmar::records {

/// A table of text cells; units stand in the header ("force_n").
struct CsvTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the header
};

/// The table as RFC 4180 has it, lines ended by LF; cells with comma, quote or line break are
/// quoted, bytes that are no UTF-8 replaced by U+FFFD. Throws Error if a row is longer or shorter
/// than the header.
std::string format_csv(const CsvTable& table);

/// One row per product and region in contact, then one per product named "total", which alone has
/// the grip force: force, area, pressures, centre of pressure, penetration, and the product's
/// source, which keeps products of one name apart.
CsvTable region_table(const study::AssessmentSet& set);

/// One row per face under pressure of products that have faces: title and number, force, area under
/// pressure, pressures.
CsvTable face_table(const study::AssessmentSet& set);

/// One row per sensor cell of products that have sensors between hand and product; where something
/// was measured, that beside it.
CsvTable sensor_table(const study::AssessmentSet& set);

/// One row per product and index that could be computed: its key, name, group, value, unit and
/// which direction is better.
CsvTable index_table(const study::AssessmentSet& set);

}  // namespace palmar::records
