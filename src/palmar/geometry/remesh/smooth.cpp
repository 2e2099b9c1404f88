// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/remesh/smooth.h"

#include <sstream>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {
namespace {

void require_rounds(const char* method, int rounds) {
  if (rounds >= 0 && rounds <= 10000) return;
  std::ostringstream message;
  message << method << ": rounds is " << rounds << "; allowed are 0 to 10000";
  throw UsageError(message.str());
}

void require_share(const char* method, const char* name, double value, bool allows_one) {
  if (value > 0.0 && (value < 1.0 || (allows_one && value == 1.0))) return;
  std::ostringstream message;
  message << method << ": " << name << " is " << value << "; allowed is above 0 and "
          << (allows_one ? "at most" : "below") << " 1";
  throw UsageError(message.str());
}

// Neighbours that each vertex is drawn to: all, but for a border vertex those along the border.
class Neighbourhood {
 public:
  explicit Neighbourhood(const MeshTopology& topology)
      : topology_(topology), is_border_(topology.vertex_count, false) {
    for (size_t e = 0; e < topology.edge.size(); ++e) {
      if (topology.edge_use[e] == 2) continue;
      for (const int v : topology.edge[e]) is_border_[v] = true;
    }
  }
  bool is_border(size_t v) const { return is_border_[v]; }

  // Mean of the neighbours minus the vertex.
  std::vector<Vec3> pull(const std::vector<Vec3>& points) const {
    std::vector<Vec3> sum(points.size(), Vec3::Zero());
    std::vector<int> count(points.size(), 0);
    for (size_t e = 0; e < topology_.edge.size(); ++e) {
      const int a = topology_.edge[e][0];
      const int b = topology_.edge[e][1];
      const bool is_border_edge = topology_.edge_use[e] != 2;
      if (is_border_edge || !is_border_[a]) {
        sum[a] += points[b];
        ++count[a];
      }
      if (is_border_edge || !is_border_[b]) {
        sum[b] += points[a];
        ++count[b];
      }
    }
    for (size_t v = 0; v < points.size(); ++v) {
      sum[v] = count[v] > 0 ? Vec3(sum[v] / count[v] - points[v]) : Vec3(Vec3::Zero());
    }
    return sum;
  }

 private:
  const MeshTopology& topology_;
  std::vector<bool> is_border_;
};

}  // namespace

void TaubinOptions::check() const {
  require_rounds("Taubin smoothing", rounds);
  require_share("Taubin smoothing", "lambda", lambda, false);
  require_share("Taubin smoothing", "pass_band", pass_band, false);
}

TriangleMesh smooth_taubin(const TriangleMesh& mesh, const TaubinOptions& options) {
  options.check();
  const MeshTopology topology = build_topology(mesh);
  const Neighbourhood neighbourhood(topology);
  const double mu = 1.0 / (options.pass_band - 1.0 / options.lambda);
  TriangleMesh result = mesh;
  for (int round = 0; round < options.rounds; ++round) {
    for (const double step : {options.lambda, mu}) {
      const std::vector<Vec3> pull = neighbourhood.pull(result.vertices);
      for (size_t v = 0; v < pull.size(); ++v) result.vertices[v] += step * pull[v];
    }
  }
  return result;
}

void TangentialOptions::check() const {
  require_rounds("tangential smoothing", rounds);
  require_share("tangential smoothing", "step", step, true);
}

TriangleMesh smooth_tangentially(const TriangleMesh& mesh, const TangentialOptions& options) {
  options.check();
  const MeshTopology topology = build_topology(mesh);
  const Neighbourhood neighbourhood(topology);
  TriangleMesh result = mesh;
  for (int round = 0; round < options.rounds; ++round) {
    const std::vector<Vec3> pull = neighbourhood.pull(result.vertices);
    std::vector<Vec3> normal(pull.size(), Vec3::Zero());
    for (const Triangle& t : result.triangles) {
      const Vec3& a = result.vertices[t[0]];
      const Vec3 area = (result.vertices[t[1]] - a).cross(result.vertices[t[2]] - a);
      for (const int v : t) normal[v] += area;
    }
    for (size_t v = 0; v < pull.size(); ++v) {
      const double length = normal[v].norm();
      if (neighbourhood.is_border(v) || !(length > 0.0)) continue;
      const Vec3 n = normal[v] / length;
      result.vertices[v] += options.step * (pull[v] - pull[v].dot(n) * n);
    }
  }
  return result;
}

}  // namespace palmar::geometry
