// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Readers of the module records, by the names of their targets.
#include <string>
#include <string_view>

#include "fuzzed_file.h"
#include "palmar/records/bench/bench_project.h"
#include "palmar/records/hand/hand_file.h"
#include "palmar/records/hold/hold_file.h"
#include "palmar/records/measured_curves.h"
#include "palmar/records/population/dimension_table_file.h"
#include "palmar/records/population/population_file.h"
#include "palmar/records/product/face_mesh_file.h"
#include "palmar/records/project_file.h"
#include "palmar/records/sensors/sensor_layout_file.h"
#include "palmar/records/study/study_file.h"
#include "palmar/records/study/study_plan_json.h"
#include "palmar/records/tissue_file.h"

namespace palmar::fuzz {

void hand(std::string_view bytes) { records::parse_hand(std::string(bytes), kName); }
void study_plan(std::string_view bytes) { records::parse_plan(std::string(bytes), kName); }
void population(std::string_view bytes) { records::parse_population(std::string(bytes), kName); }
void dimension_table(std::string_view bytes) { records::parse_dimension_table(bytes, kName); }
void study(std::string_view bytes) { records::read_study_file(fuzzed_file(bytes, ".toml")); }
void tissue(std::string_view bytes) { records::read_tissue(fuzzed_file(bytes, ".toml"), {}); }
void hold(std::string_view bytes) { records::read_hold(fuzzed_file(bytes, ".toml")); }
void project(std::string_view bytes) { records::read_project(fuzzed_file(bytes, ".toml")); }
void sensors(std::string_view bytes) { records::read_sensor_layout(fuzzed_file(bytes, ".toml")); }
void bench_project(std::string_view bytes) {
  records::read_bench_project(fuzzed_file(bytes, ".palmar-project"));
}
void curves(std::string_view bytes) { records::read_measured_curves(fuzzed_file(bytes, ".csv")); }
void face_mesh(std::string_view bytes) { records::read_face_mesh(fuzzed_file(bytes, ".bin")); }

}  // namespace palmar::fuzz
