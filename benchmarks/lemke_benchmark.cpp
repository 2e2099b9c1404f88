// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// The contact problem of every region, block principal pivoting against Lemke's method on the same
// matrices: those of the template hand around a cylinder of 48 mm. Must reach: 30 times faster over
// all regions. The argument is the template's asset file.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <iomanip>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "palmar/contact/contact.h"
#include "palmar/contact/prepared/prepared_hand.h"
#include "palmar/contact/solve/lcp.h"
#include "palmar/contact/solve/lemke.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/distance/mesh_distance.h"
#include "palmar/geometry/mesh/primitive_meshes.h"
#include "palmar/grasp/find/find_grasp.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/hand/template/template_hand.h"
#include "palmar/records/hand/hand_asset.h"

namespace {

using namespace palmar;

struct Block {
  std::string region;
  contact::ContactProblem problem;
};

/// The contact problems of a solved grasp. Sub-active regions as Xie 2014 poses them (A3, A4): the
/// penetrating skin of a region with its neighbourhood; or the penetrating skin alone, which is
/// what solve_hand_contact() solves.
std::vector<Block> blocks_of(const contact::PreparedHand& prepared,
                             const contact::ContactResult& contact, bool with_neighbourhood) {
  const contact::PreparedHand::Impl& impl = prepared.impl();
  std::vector<int> penetrating;
  for (std::size_t v = 0; v < contact.distance.size(); ++v) {
    if (contact.distance[v] < 0.0) penetrating.push_back(static_cast<int>(v));
  }
  std::vector<Block> blocks;
  for (const contact::RegionContact& part : contact.regions) {
    if (part.region == hand::Region::kDorsum) continue;
    std::vector<int> columns;
    std::vector<double> distance;
    const double reach = with_neighbourhood ? impl.tissue(part.region).neighbourhood : 0.0;
    for (const contact::GrownVertex& g : contact::grow(impl.skin, penetrating, reach)) {
      if (impl.hand->region[g.vertex] != part.region) continue;
      columns.push_back(g.vertex);
      distance.push_back(contact.distance[g.vertex]);
    }
    Block& block = blocks.emplace_back();
    block.region = std::string(name_of(part.region));
    block.problem.response =
        contact::dense_response(impl.response, columns, impl.hand->region, false) /
        part.shear_modulus;
    block.problem.distance = Eigen::Map<const Eigen::VectorXd>(
        distance.data(), static_cast<Eigen::Index>(distance.size()));
  }
  return blocks;
}

/// Least processor time of several runs, ms: the one that was disturbed least.
double milliseconds(int runs, const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const std::clock_t start = std::clock();
    constexpr int kRepeats = 5;
    for (int k = 0; k < kRepeats; ++k) work();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - start) /
                                (kRepeats * static_cast<double>(CLOCKS_PER_SEC)));
  }
  return least;
}

void compare(const std::vector<Block>& blocks) {
  std::cout << std::fixed << "region            vertices  loaded   ours ms  pivots  Lemke ms  "
            << "pivots  ratio  largest difference N\n";
  double ours_all = 0.0;
  double lemke_all = 0.0;
  for (const Block& block : blocks) {
    const contact::ContactSolution ours = contact::solve_contact(block.problem);
    const contact::ContactSolution lemke = contact::solve_contact_lemke(block.problem);
    const double ours_ms = milliseconds(40, [&] { contact::solve_contact(block.problem); });
    const double lemke_ms = milliseconds(15, [&] { contact::solve_contact_lemke(block.problem); });
    ours_all += ours_ms;
    lemke_all += lemke_ms;
    std::cout << std::left << std::setw(18) << block.region << std::right << std::setw(8)
              << block.problem.distance.size() << std::setw(8) << (ours.force.array() > 0.0).count()
              << std::setprecision(4) << std::setw(10) << ours_ms << std::setw(8) << ours.pivots
              << std::setprecision(3) << std::setw(10) << lemke_ms << std::setw(8) << lemke.pivots
              << std::setprecision(1) << std::setw(7) << lemke_ms / ours_ms << std::scientific
              << std::setprecision(1) << std::setw(12)
              << (ours.force - lemke.force).cwiseAbs().maxCoeff() << std::fixed << '\n';
  }
  std::cout << std::setprecision(3) << "all regions: ours " << ours_all << " ms, Lemke "
            << lemke_all << " ms, ratio " << std::setprecision(1) << lemke_all / ours_all << '\n';
}

/// The penetrating skin of the whole hand as one problem, as regions together pose it.
void compare_whole_hand(const contact::PreparedHand& prepared,
                        const contact::ContactResult& contact) {
  const contact::PreparedHand::Impl& impl = prepared.impl();
  std::vector<int> vertices;
  std::vector<double> b;
  std::vector<char> start;
  for (std::size_t v = 0; v < contact.distance.size(); ++v) {
    if (contact.distance[v] >= 0.0) continue;
    double modulus = 0.05;  // MPa
    double deepest = 4.0;   // mm
    for (const contact::RegionContact& part : contact.regions) {
      if (part.region != impl.hand->region[v]) continue;
      modulus = part.shear_modulus;
      deepest = part.max_penetration;
    }
    vertices.push_back(static_cast<int>(v));
    b.push_back(modulus * contact.distance[v]);
    start.push_back(contact.distance[v] < -0.5 * deepest);
  }
  contact::ContactProblem problem;
  problem.response = contact::dense_response(impl.response, vertices, impl.hand->region, true);
  problem.distance =
      Eigen::Map<const Eigen::VectorXd>(b.data(), static_cast<Eigen::Index>(b.size()));
  std::vector<double> force, gap;
  const double ours_ms = milliseconds(10, [&] {
    contact::ContactSystem system(impl.blocks);
    system.assemble(impl.response, vertices, nullptr);
    std::vector<char> in_contact = start;
    force.clear();
    system.solve(b, in_contact, force, gap);
  });
  const contact::ContactSolution lemke = contact::solve_contact_lemke(problem);
  const std::clock_t before = std::clock();
  contact::solve_contact_lemke(problem);
  const double lemke_ms =
      1e3 * static_cast<double>(std::clock() - before) / static_cast<double>(CLOCKS_PER_SEC);
  double difference = 0.0;
  for (std::size_t i = 0; i < force.size(); ++i) {
    difference =
        std::max(difference, std::abs(force[i] - lemke.force[static_cast<Eigen::Index>(i)]));
  }
  std::cout << "Whole hand, regions together: " << vertices.size() << " vertices, "
            << (lemke.force.array() > 0.0).count() << " loaded: ours " << std::setprecision(2)
            << ours_ms << " ms (assembling included), Lemke " << lemke_ms << " ms, ratio "
            << std::setprecision(0) << lemke_ms / ours_ms << ", largest difference "
            << std::scientific << std::setprecision(1) << difference << " N\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "lemke_benchmark: one argument is required: the template's asset, right.glb\n";
    return 2;
  }
  set_thread_count(1);
  const auto hand =
      std::make_shared<const hand::Hand>(hand::build_template(records::read_hand_asset(argv[1])));
  const contact::PreparedHand prepared(hand, {.coupling = contact::RegionCoupling::kIndependent});
  product::Product product;
  product.mesh = geometry::make_cylinder(
      {.radius = 24.0, .length = 150.0, .segments = 96, .rings = 20, .is_capped = true});
  product.distance = std::make_shared<geometry::MeshDistance>(product.mesh);
  const grasp::Grasp grasp = grasp::close_power_grasp(*hand, product);
  const contact::ContactResult contact = contact::solve_hand_contact(
      prepared, hand::pose_skin(*hand, grasp.posture), grasp.product_from_hand, *product.distance);

  std::cout << "Sub-active regions with their neighbourhood:\n";
  compare(blocks_of(prepared, contact, true));
  std::cout << "Penetrating skin alone:\n";
  compare(blocks_of(prepared, contact, false));
  const contact::PreparedHand coupled(hand);
  compare_whole_hand(coupled,
                     contact::solve_hand_contact(coupled, hand::pose_skin(*hand, grasp.posture),
                                                 grasp.product_from_hand, *product.distance));
  return 0;
}
