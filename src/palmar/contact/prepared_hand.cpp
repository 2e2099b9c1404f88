// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/prepared_hand.h"

#include <limits>
#include <string>
#include <utility>

#include "palmar/contact/response.h"
#include "palmar/core/error.h"
#include "palmar/core/parallel.h"
#include "palmar/geometry/geodesic.h"

namespace palmar {
namespace {

/// No two points of a region are farther apart on the skin.
constexpr double kLongestDistance = 400.0;  // mm

void check_hand(const Hand& hand) {
  if (hand.skin.vertices.empty()) {
    throw UsageError("hand \"" + hand.name + "\": the skin has no vertices");
  }
  if (hand.region.size() != hand.skin.vertices.size()) {
    throw UsageError("hand \"" + hand.name + "\": " + std::to_string(hand.region.size()) +
                     " region labels for " + std::to_string(hand.skin.vertices.size()) +
                     " skin vertices; the numbers must be equal");
  }
}

/// Fills the matrices of a response whose rows are set. distance(i, j) with i >= j in mm.
template <typename Distance>
void fill_matrices(const SkinGeometry& skin, Kernel kernel, const RegionTissue& tissue,
                   const Distance& distance, RegionResponse& response) {
  const int rows = static_cast<int>(response.vertex.size());
  response.bou.resize(rows, response.columns);
  response.gau.resize(rows, response.columns);
  for (int j = 0; j < response.columns; ++j) {
    const double a_j = skin.radius[response.vertex[j]];
    for (int i = j; i < rows; ++i) {
      const double r = distance(i, j);
      response.bou(i, j) =
          static_cast<float>(boussinesq_response(kernel, r, skin.radius[response.vertex[i]], a_j));
      response.gau(i, j) =
          static_cast<float>(gaussian_response(r, tissue.swelling_radius, tissue.swelling_width));
    }
  }
  for (int j = 1; j < response.columns; ++j) {
    for (int i = 0; i < j; ++i) {
      response.bou(i, j) = response.bou(j, i);
      response.gau(i, j) = response.gau(j, i);
    }
  }
}

/// Geodesic distances from the columns to the rows along the rows' own part of the skin; in the
/// upper square the mean of both directions. Infinite where the part has no path.
Eigen::MatrixXf geodesic_distances(const GeodesicSolver& solver, const RegionResponse& response) {
  const auto rows = static_cast<Eigen::Index>(response.vertex.size());
  std::vector<unsigned char> allowed(static_cast<std::size_t>(solver.vertex_count()), 0);
  std::vector<int> row(allowed.size(), -1);
  for (Eigen::Index i = 0; i < rows; ++i) {
    allowed[response.vertex[i]] = 1;
    row[response.vertex[i]] = static_cast<int>(i);
  }
  constexpr float kUnreached = std::numeric_limits<float>::infinity();
  Eigen::MatrixXf distance = Eigen::MatrixXf::Constant(rows, response.columns, kUnreached);
  GeodesicWorkspace workspace;
  for (int j = 0; j < response.columns; ++j) {
    for (const GeodesicReach& reached :
         solver.reach(response.vertex[j], kLongestDistance, workspace, allowed)) {
      distance(row[reached.vertex], j) = static_cast<float>(reached.distance);
    }
  }
  for (int j = 0; j < response.columns; ++j) {
    for (int i = 0; i < j; ++i) {
      const float mean = 0.5F * (distance(i, j) + distance(j, i));
      distance(i, j) = mean;
      distance(j, i) = mean;
    }
  }
  return distance;
}

}  // namespace

RegionResponse response_between(const PreparedHand::Impl& prepared, const RegionTissue& tissue,
                                const std::vector<int>& columns,
                                const std::vector<int>& further_rows) {
  RegionResponse response;
  response.vertex = columns;
  response.vertex.insert(response.vertex.end(), further_rows.begin(), further_rows.end());
  response.columns = static_cast<int>(columns.size());
  const auto distance = [&](int i, int j) {
    return i == j ? 0.0 : arc_distance(prepared.skin, response.vertex[i], response.vertex[j]);
  };
  fill_matrices(prepared.skin, prepared.model.kernel, tissue, distance, response);
  return response;
}

PreparedHand::PreparedHand(std::shared_ptr<const Hand> hand, const ContactModel& model) {
  if (!hand) throw UsageError("prepare hand: no hand was given");
  check_hand(*hand);
  auto impl = std::make_unique<Impl>();
  impl->model = model;
  impl->skin = skin_geometry(hand->skin);
  impl->hand = std::move(hand);
  impl->row.assign(impl->hand->region.size(), 0);

  for (int v = 0; v < impl->skin.vertex_count(); ++v) {
    const Region region = impl->hand->region[v];
    if (region == Region::kDorsum) continue;
    auto& response = impl->region[static_cast<std::size_t>(region)];
    impl->row[v] = response.columns++;
    response.vertex.push_back(v);
  }
  const GeodesicSolver solver(impl->hand->skin);
  parallel_for(kRegionCount, [&](int r) {
    RegionResponse& response = impl->region[static_cast<std::size_t>(r)];
    if (response.columns == 0) return;
    const Region region = static_cast<Region>(r);
    const RegionTissue& tissue = impl->tissue(region);
    const std::vector<int> own = response.vertex;
    for (const GrownVertex& g : grow(impl->skin, own, tissue.neighbourhood)) {
      if (impl->hand->region[g.vertex] != region) response.vertex.push_back(g.vertex);
    }
    const Eigen::MatrixXf r_ij = geodesic_distances(solver, response);
    const auto distance = [&](int i, int j) { return static_cast<double>(r_ij(i, j)); };
    fill_matrices(impl->skin, model.kernel, tissue, distance, response);
  });
  impl_ = std::move(impl);
}

PreparedHand::~PreparedHand() = default;
PreparedHand::PreparedHand(PreparedHand&&) noexcept = default;
PreparedHand& PreparedHand::operator=(PreparedHand&&) noexcept = default;

const Hand& PreparedHand::hand() const { return *impl_->hand; }
const ContactModel& PreparedHand::model() const { return impl_->model; }

}  // namespace palmar
