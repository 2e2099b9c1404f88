// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/geometry/mesh/editable_mesh.h"

#include <sstream>

#include "palmar/core/error.h"
#include "palmar/geometry/mesh/mesh_topology.h"

namespace palmar::geometry {

EditableMesh::EditableMesh(const TriangleMesh& mesh) : position_(mesh.vertices) {
  const MeshTopology topology = build_topology(mesh);
  const TopologyReport report = examine_topology(mesh, topology);
  if (!mesh.triangles.empty() && !(report.is_two_manifold && report.is_oriented)) {
    std::ostringstream message;
    message << "mesh: " << report.non_manifold_edges << " edges and "
            << report.non_manifold_vertices << " vertices are not 2-manifold, "
            << report.collapsed_triangles << " triangles use a vertex twice, "
            << report.inconsistent_edges
            << " edges disagree about outside; remeshing requires none of these";
    throw InputError(message.str());
  }
  start_.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) start_.insert(start_.end(), t.begin(), t.end());
  twin_ = topology.twin;
  outgoing_.assign(position_.size(), -1);
  for (int v = 0; v < vertex_capacity(); ++v) {
    const auto fan = topology.outgoing(v);
    if (!fan.empty()) settle_outgoing(v, fan.front());
  }
}

// Makes h, or the half-edge on the border if turning clockwise from h meets one, the vertex' own.
void EditableMesh::settle_outgoing(int v, int h) {
  const int first = h;
  while (twin(h) >= 0) {
    h = next(twin(h));
    if (h == first) break;
  }
  outgoing_[v] = h;
}

int EditableMesh::valence(int v) const {
  int count = 0;
  const int first = outgoing(v);
  for (int h = first; h >= 0;) {
    ++count;
    h = turn(h);
    if (h == first) return count;
  }
  return count + 1;  // the border edge that comes in
}

bool EditableMesh::is_neighbour(int a, int b) const {
  const int first = outgoing(a);
  for (int h = first; h >= 0;) {
    if (end(h) == b || apex(h) == b) return true;
    h = turn(h);
    if (h == first) break;
  }
  return false;
}

int EditableMesh::add_triangle(int a, int b, int c) {
  const int h = half_edge_capacity();
  for (const int v : {a, b, c}) {
    start_.push_back(v);
    twin_.push_back(-1);
  }
  return h;
}

void EditableMesh::link(int h, int g) {
  if (h >= 0) twin_[h] = g;
  if (g >= 0) twin_[g] = h;
}

int EditableMesh::split(int h, const Vec3& p) {
  const int g = twin(h);
  const int b = end(h), c = apex(h);
  const int m = vertex_capacity();
  position_.push_back(p);
  outgoing_.push_back(-1);

  // Triangle a b c becomes a m c (in place) and m b c.
  const int t = add_triangle(m, b, c);
  const int bc = next(h);
  link(t + 1, twin(bc));
  start_[bc] = m;
  link(bc, t + 2);
  if (g >= 0) {
    // Triangle b a d becomes m a d (in place) and b m d.
    const int db = previous(g);
    const int d = start(db);
    const int s = add_triangle(b, m, d);
    link(s + 2, twin(db));
    start_[g] = m;
    link(db, s + 1);
    link(t, s);
    settle_outgoing(d, s + 2);
  }
  settle_outgoing(m, t);
  settle_outgoing(b, t + 1);
  settle_outgoing(c, t + 2);
  return m;
}

bool EditableMesh::can_collapse(int h) const {
  const int a = start(h), b = end(h);
  if (twin(h) < 0 || is_border_vertex(a)) return false;
  const int c = apex(h), d = apex(twin(h));
  if (c == d) return false;
  int common = 0;
  const int first = outgoing(a);
  for (int o = first; o >= 0;) {
    const int n = end(o);
    if (n != b && is_neighbour(n, b)) ++common;
    o = turn(o);
    if (o == first) break;
  }
  if (common != 2) return false;
  for (const int v : {c, d}) {
    if (valence(v) <= (is_border_vertex(v) ? 2 : 3)) return false;
  }
  // A tetrahedron would collapse to two triangles back to back.
  return valence(a) + valence(b) - 4 >= (is_border_vertex(b) ? 2 : 3);
}

bool EditableMesh::collapse(int h) {
  if (!can_collapse(h)) return false;
  const int g = twin(h);
  const int a = start(h), b = end(h), c = apex(h), d = apex(g);
  const int first = outgoing(a);
  int o = first;
  do {
    const int following = turn(o);
    start_[o] = b;
    o = following;
  } while (o != first);
  // Across each vanishing triangle its two other neighbours become each other's.
  const int bc = twin(next(h)), ca = twin(previous(h));
  const int ad = twin(next(g)), db = twin(previous(g));
  link(bc, ca);
  link(ad, db);
  for (const int dead : {h, g}) {
    for (const int e : {dead, next(dead), previous(dead)}) {
      start_[e] = -1;
      twin_[e] = -1;
    }
  }
  outgoing_[a] = -1;
  // bc runs from c to b, ca from a (now b) to c; one of them may be a border's missing twin.
  settle_outgoing(b, ca >= 0 ? ca : next(bc));
  settle_outgoing(c, bc >= 0 ? bc : next(ca));
  settle_outgoing(d, ad >= 0 ? ad : next(db));
  return true;
}

bool EditableMesh::can_flip(int h) const {
  const int g = twin(h);
  if (g < 0) return false;
  const int a = start(h), b = end(h), c = apex(h), d = apex(g);
  if (c == d || is_neighbour(c, d)) return false;
  for (const int v : {a, b}) {
    if (valence(v) <= (is_border_vertex(v) ? 2 : 3)) return false;
  }
  return true;
}

bool EditableMesh::flip(int h) {
  if (!can_flip(h)) return false;
  const int g = twin(h);
  const int a = start(h), b = end(h), c = apex(h), d = apex(g);
  const int bc = next(h), ca = previous(h), ad = next(g), db = previous(g);
  const int bc_twin = twin(bc), ca_twin = twin(ca), ad_twin = twin(ad), db_twin = twin(db);
  // h's triangle becomes c d b, g's triangle d c a; h and g stay twins.
  const auto set = [&](int e, int v, int other) {
    start_[e] = v;
    link(e, other);
    if (other < 0) twin_[e] = -1;
  };
  start_[h] = c;
  set(bc, d, db_twin);
  set(ca, b, bc_twin);
  start_[g] = d;
  set(ad, c, ca_twin);
  set(db, a, ad_twin);
  settle_outgoing(a, db);
  settle_outgoing(b, ca);
  settle_outgoing(c, h);
  settle_outgoing(d, g);
  return true;
}

EditableMesh::Compacted EditableMesh::compacted() const {
  Compacted result;
  std::vector<int> new_of_old(position_.size(), -1);
  for (int v = 0; v < vertex_capacity(); ++v) {
    if (!has_vertex(v)) continue;
    new_of_old[v] = result.mesh.vertex_count();
    result.mesh.vertices.push_back(position(v));
    result.old_of_new.push_back(v);
  }
  for (int h = 0; h < half_edge_capacity(); h += 3) {
    if (!has_half_edge(h)) continue;
    result.mesh.triangles.push_back(
        {new_of_old[start(h)], new_of_old[start(h + 1)], new_of_old[start(h + 2)]});
  }
  return result;
}

}  // namespace palmar::geometry
