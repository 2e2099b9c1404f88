// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/mesh_topology.h"

#include <algorithm>
#include <sstream>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/disjoint_sets.h"

namespace palmar::geometry {
namespace {

bool is_collapsed(const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; }

std::vector<std::array<int, 2>> edges_used(const MeshTopology& topology, bool (*accept)(int use)) {
  std::vector<std::array<int, 2>> result;
  for (size_t e = 0; e < topology.edge.size(); ++e) {
    if (accept(topology.edge_use[e])) result.push_back(topology.edge[e]);
  }
  return result;
}

}  // namespace

MeshTopology build_topology(const TriangleMesh& mesh) {
  MeshTopology topology;
  const int n = topology.vertex_count = mesh.vertex_count();
  const size_t half_edges = 3 * mesh.triangles.size();
  topology.fan_begin.assign(static_cast<std::size_t>(n) + 1, 0);
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const int v : mesh.triangles[t]) {
      if (v >= 0 && v < n) continue;
      std::ostringstream message;
      message << "mesh: triangle " << t << " names vertex " << v << "; there are " << n
              << " vertices";
      throw InputError(message.str());
    }
    if (is_collapsed(mesh.triangles[t])) continue;
    for (const int v : mesh.triangles[t]) ++topology.fan_begin[v + 1];
  }
  std::partial_sum(topology.fan_begin.begin(), topology.fan_begin.end(),
                   topology.fan_begin.begin());
  topology.fan.resize(topology.fan_begin.back());
  std::vector<int> fill(topology.fan_begin.begin(), topology.fan_begin.end() - 1);

  // Half-edges in buckets by their smaller end; a bucket is short, so sorting it is cheap and the
  // edges come out in ascending order.
  struct Link {
    int other, half_edge;
  };
  std::vector<int> begin(static_cast<std::size_t>(n) + 1, 0);
  const auto ends = [&](size_t h) {
    const Triangle& t = mesh.triangles[h / 3];
    return std::minmax(t[h % 3], t[(h + 1) % 3]);
  };
  for (size_t h = 0; h < half_edges; ++h) {
    if (is_collapsed(mesh.triangles[h / 3])) continue;
    const int v = mesh.triangles[h / 3][h % 3];
    topology.fan[fill[v]++] = static_cast<int>(h);
    ++begin[(ends(h).first) + 1];
  }
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Link> links(begin.back());
  fill.assign(begin.begin(), begin.end() - 1);
  for (size_t h = 0; h < half_edges; ++h) {
    if (is_collapsed(mesh.triangles[h / 3])) continue;
    const auto [a, b] = ends(h);
    links[fill[a]++] = {b, static_cast<int>(h)};
  }

  topology.edge_of.assign(half_edges, -1);
  topology.twin.assign(half_edges, -1);
  for (int a = 0; a < n; ++a) {
    const auto first = links.begin() + begin[a];
    const auto last = links.begin() + begin[a + 1];
    std::sort(first, last, [](const Link& x, const Link& y) {
      return x.other != y.other ? x.other < y.other : x.half_edge < y.half_edge;
    });
    for (auto run = first; run != last;) {
      auto run_end = run;
      const int e = static_cast<int>(topology.edge.size());
      for (; run_end != last && run_end->other == run->other; ++run_end) {
        topology.edge_of[run_end->half_edge] = e;
      }
      topology.edge.push_back({a, run->other});
      topology.edge_use.push_back(static_cast<int>(run_end - run));
      if (run_end - run == 2) {
        topology.twin[run->half_edge] = (run + 1)->half_edge;
        topology.twin[(run + 1)->half_edge] = run->half_edge;
      }
      run = run_end;
    }
  }
  return topology;
}

std::vector<std::array<int, 2>> boundary_edges(const MeshTopology& topology) {
  return edges_used(topology, [](int use) { return use == 1; });
}

std::vector<std::array<int, 2>> non_manifold_edges(const MeshTopology& topology) {
  return edges_used(topology, [](int use) { return use > 2; });
}

std::vector<int> non_manifold_vertices(const TriangleMesh& mesh, const MeshTopology& topology) {
  std::vector<int> result;
  std::vector<int> place(mesh.triangles.size(), -1);
  for (int v = 0; v < topology.vertex_count; ++v) {
    const auto fan = topology.outgoing(v);
    if (fan.size() < 2) continue;
    for (size_t i = 0; i < fan.size(); ++i) {
      place[fan[i] / 3] = static_cast<int>(i);
    }
    // Triangles of one fan are joined over edges at v that two of them share.
    DisjointSets sets(static_cast<int>(fan.size()));
    bool has_bad_edge = false;
    int boundary = 0;
    for (size_t i = 0; i < fan.size(); ++i) {
      for (const int h : {fan[i], MeshTopology::previous(fan[i])}) {
        const int use = topology.edge_use[topology.edge_of[h]];
        has_bad_edge |= use > 2;
        boundary += use == 1;
        const int twin = topology.twin[h];
        if (twin >= 0) sets.unite(static_cast<int>(i), place[twin / 3]);
      }
    }
    bool is_one_fan = !has_bad_edge && boundary <= 2;
    for (size_t i = 1; i < fan.size() && is_one_fan; ++i) {
      is_one_fan = sets.root(static_cast<int>(i)) == 0;
    }
    if (!is_one_fan) result.push_back(v);
  }
  return result;
}

std::vector<int> triangle_components(const TriangleMesh& mesh, const MeshTopology& topology) {
  DisjointSets sets(topology.vertex_count);
  for (const auto& [a, b] : topology.edge) sets.unite(a, b);
  std::vector<int> number_of_root(topology.vertex_count, -1);
  std::vector<int> component(mesh.triangles.size(), -1);
  int count = 0;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (topology.edge_of[3 * t] < 0) continue;
    int& number = number_of_root[sets.root(mesh.triangles[t][0])];
    if (number < 0) number = count++;
    component[t] = number;
  }
  return component;
}

std::vector<std::vector<int>> vertex_neighbours(const MeshTopology& topology) {
  std::vector<std::vector<int>> result(topology.vertex_count);
  // Edges ascend, so first the smaller then the larger neighbours arrive in order.
  for (const auto& [a, b] : topology.edge) result[b].push_back(a);
  for (const auto& [a, b] : topology.edge) result[a].push_back(b);
  return result;
}

TopologyReport examine_topology(const TriangleMesh& mesh) {
  return examine_topology(mesh, build_topology(mesh));
}

TopologyReport examine_topology(const TriangleMesh& mesh, const MeshTopology& topology) {
  TopologyReport report;
  report.edges = static_cast<int>(topology.edge.size());
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    ++(topology.edge_of[3 * t] < 0 ? report.collapsed_triangles : report.triangles);
  }
  for (int v = 0; v < topology.vertex_count; ++v) {
    report.used_vertices += !topology.outgoing(v).empty();
  }
  DisjointSets boundary(topology.vertex_count);
  for (size_t e = 0; e < topology.edge.size(); ++e) {
    report.non_manifold_edges += topology.edge_use[e] > 2;
    if (topology.edge_use[e] != 1) continue;
    ++report.boundary_edges;
    boundary.unite(topology.edge[e][0], topology.edge[e][1]);
  }
  std::vector<int> loops;
  for (size_t e = 0; e < topology.edge.size(); ++e) {
    if (topology.edge_use[e] == 1) loops.push_back(boundary.root(topology.edge[e][0]));
  }
  std::sort(loops.begin(), loops.end());
  report.boundary_loops = static_cast<int>(std::unique(loops.begin(), loops.end()) - loops.begin());
  for (size_t h = 0; h < topology.twin.size(); ++h) {
    const int twin = topology.twin[h];
    if (twin <= static_cast<int>(h)) continue;
    report.inconsistent_edges += mesh.triangles[h / 3][h % 3] == mesh.triangles[twin / 3][twin % 3];
  }
  report.non_manifold_vertices = static_cast<int>(non_manifold_vertices(mesh, topology).size());
  const std::vector<int> component = triangle_components(mesh, topology);
  for (const int c : component) report.components = std::max(report.components, c + 1);
  report.euler_number = report.used_vertices - report.edges + report.triangles;
  report.is_closed = report.triangles > 0 && report.boundary_edges == 0;
  report.is_two_manifold = report.triangles > 0 && report.collapsed_triangles == 0 &&
                           report.non_manifold_edges == 0 && report.non_manifold_vertices == 0;
  report.is_oriented = report.inconsistent_edges == 0 && report.non_manifold_edges == 0;
  return report;
}

void require_closed_manifold(const TriangleMesh& mesh, const std::string& object) {
  const TopologyReport report = examine_topology(mesh);
  std::ostringstream fault;
  if (report.triangles == 0) {
    fault << "it has no triangles";
  } else if (report.collapsed_triangles > 0) {
    fault << report.collapsed_triangles << " triangles use a vertex twice";
  } else if (report.non_manifold_edges > 0) {
    fault << report.non_manifold_edges << " edges have more than two triangles";
  } else if (report.non_manifold_vertices > 0) {
    fault << "the triangles round " << report.non_manifold_vertices << " vertices are not one fan";
  } else if (report.boundary_edges > 0) {
    fault << report.boundary_edges << " edges are on " << report.boundary_loops << " open borders";
  } else if (report.inconsistent_edges > 0) {
    fault << "the triangles at " << report.inconsistent_edges << " edges disagree about outside";
  } else {
    return;
  }
  throw InputError(object + ": " + fault.str() +
                   "; a closed, 2-manifold, consistently oriented mesh is required");
}

}  // namespace palmar::geometry
