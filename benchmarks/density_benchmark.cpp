// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The template hand at mesh densities from 2 500 to 40 000 vertices round a cylinder of 48 mm, on
// one core: time to prepare, time of a contact from scratch and along a motion, memory. Must reach:
// contact time growing no faster than vertices^1.5, below 500 MB at 40 000 vertices. Arguments: the
// template's asset file and, if wanted, mean edge lengths in mm.
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/records/hand/hand_asset.h"

namespace {

using namespace palmar;

struct Row {
  double edge_length = 0.0;  // mm
  int vertices = 0;
  int loaded = 0;
  double prepare = 0.0;  // s
  double contact = 0.0;  // s, from scratch
  double motion = 0.0;   // s, from the last answer
  double memory = 0.0;   // MB
  double force = 0.0;    // N
};

/// Shortest of a few runs, s.
template <typename Body>
double seconds(int runs, const Body& body) {
  double best = std::numeric_limits<double>::infinity();
  for (int run = 0; run < runs; ++run) {
    const auto start = std::chrono::steady_clock::now();
    body();
    const std::chrono::duration<double> time = std::chrono::steady_clock::now() - start;
    best = std::min(best, time.count());
  }
  return best;
}

/// Starts the count of peak memory again where Linux allows it.
void forget_peak_memory() {
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

/// Most memory in use since then, MB; 0 if the system doesn't say.
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.rfind("VmHWM:", 0) == 0) return std::stod(line.substr(6)) / 1024.0;
  }
  return 0.0;
}

Row measure(const hand::HandAsset& asset, double edge_length, const grasp::Grasp& grasp,
            const geometry::DistanceField& product) {
  hand::TemplateOptions options;
  options.edge_length = edge_length;
  const auto hand = std::make_shared<const hand::Hand>(hand::build_template(asset, options));
  const std::vector<Vec3> posed = hand::pose_skin(*hand, grasp.posture);
  Row row;
  row.edge_length = edge_length;
  row.vertices = hand->skin.vertex_count();
  forget_peak_memory();
  std::unique_ptr<contact::PreparedHand> prepared;
  row.prepare = seconds(1, [&] { prepared = std::make_unique<contact::PreparedHand>(hand); });
  contact::ContactResult contact;
  const int runs = row.vertices > 20000 ? 3 : 8;
  row.contact = seconds(runs, [&] {
    contact = contact::solve_hand_contact(*prepared, posed, grasp.product_from_hand, product);
  });
  contact::ContactSolver solver(*prepared);
  solver.solve(posed, grasp.product_from_hand, product, contact);
  row.motion =
      seconds(runs, [&] { solver.solve(posed, grasp.product_from_hand, product, contact); });
  row.memory = peak_memory();
  row.force = contact.total.force;
  row.loaded = static_cast<int>(
      std::count_if(contact.force.begin(), contact.force.end(), [](double p) { return p > 0.0; }));
  return row;
}

/// e of time ~ vertices^e between two rows.
double exponent(const Row& coarse, const Row& fine, double Row::*time) {
  return std::log(fine.*time / (coarse.*time)) /
         std::log(static_cast<double>(fine.vertices) / coarse.vertices);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::cerr << "density_benchmark: the template's asset, right.glb, is required\n";
    return 2;
  }
  set_thread_count(1);
  std::vector<double> edges = {4.5, 3.2, 2.3, 1.6, 1.1};
  if (argc > 2) edges.clear();
  for (int i = 2; i < argc; ++i) edges.push_back(std::stod(argv[i]));
  const hand::HandAsset asset = records::read_hand_asset(argv[1]);
  product::Product product;
  product.mesh = geometry::make_cylinder(
      {.radius = 24.0, .length = 150.0, .segments = 96, .rings = 20, .is_capped = true});
  product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
  const grasp::Grasp grasp = grasp::close_power_grasp(hand::build_template(asset), product);

  std::printf(
      "edge_mm vertices loaded force_n prepare_s contact_ms motion_ms peak_mb "
      "exponent_prepare exponent_contact\n");
  std::vector<Row> rows;
  for (const double edge : edges) {
    rows.push_back(measure(asset, edge, grasp, *product.distance));
    const Row& row = rows.back();
    std::printf("%7.2f %8d %6d %7.1f %9.3f %10.2f %9.2f %7.0f", row.edge_length, row.vertices,
                row.loaded, row.force, row.prepare, 1e3 * row.contact, 1e3 * row.motion,
                row.memory);
    if (rows.size() > 1) {
      const Row& before = rows[rows.size() - 2];
      std::printf(" %16.2f %16.2f", exponent(before, row, &Row::prepare),
                  exponent(before, row, &Row::contact));
    }
    std::printf("\n");
    std::fflush(stdout);
  }
  if (rows.size() > 1) {
    std::printf(
        "over the sweep: prepare vertices^%.2f, contact vertices^%.2f, motion "
        "vertices^%.2f\n",
        exponent(rows.front(), rows.back(), &Row::prepare),
        exponent(rows.front(), rows.back(), &Row::contact),
        exponent(rows.front(), rows.back(), &Row::motion));
  }
  return 0;
}
