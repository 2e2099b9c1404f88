// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/contact/bone/surface_compliance.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>
#include <string>

#include "palmar/contact/bone/block_tree.h"
#include "palmar/contact/bone/mini_element.h"
#include "palmar/core/error.h"

namespace palmar::contact {
namespace {

using Eigen::Index;
using Scalar = float;
using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

/// What a front leaves for its parent: the matrix among the vertices that come later (lower
/// triangle) and the border of the loads that act on them.
struct Remainder {
  Matrix matrix;
  std::vector<int> load;  ///< ascending
  Matrix border;          ///< unknowns x loads
};

class Eliminator {
 public:
  Eliminator(const geometry::TetrahedralMesh& mesh, const std::vector<char>& is_held,
             const std::vector<SurfaceLoad>& loads, const SurfaceComplianceOptions& options,
             PatchMatrix& compliance)
      : mesh_(mesh),
        is_held_(is_held),
        loads_(loads),
        options_(options),
        compliance_(compliance),
        tree_(dissect(mesh)),
        loads_at_(mesh.vertices.size()),
        place_(mesh.vertices.size(), -1) {
    for (std::size_t j = 0; j < loads.size(); ++j) {
      for (const int v : loads[j].vertex) loads_at_[v].push_back(static_cast<int>(j));
    }
  }

  std::size_t run() {
    std::vector<std::optional<Remainder>> remainder(tree_.size());
    std::size_t held = 0, most = 0;
    const auto size_of = [](const Remainder& r) {
      return sizeof(Scalar) * static_cast<std::size_t>(r.matrix.size() + r.border.size());
    };
    for (std::size_t n = 0; n < tree_.size(); ++n) {
      std::vector<Remainder*> children;
      for (const int c : tree_[n].child) children.push_back(&*remainder[c]);
      remainder[n] = front(tree_[n], children);
      held += size_of(*remainder[n]);
      most = std::max(most, held + front_bytes_);
      for (const int c : tree_[n].child) {
        held -= size_of(*remainder[c]);
        remainder[c].reset();
      }
    }
    return most;
  }

 private:
  /// Unknowns of a front, in the order: displacements of its own vertices, their pressures, then
  /// vertex by vertex what comes later. place_[v]: the first displacement, pressure_[v].
  struct Layout {
    Index displacements = 0, own = 0, all = 0;
  };
  bool moves(int v) const { return !is_held_[v]; }

  Layout lay_out(const DissectionNode& node) {
    Layout layout;
    pressure_.resize(place_.size());
    for (const int v : node.vertex) {
      place_[v] = static_cast<int>(layout.displacements);
      if (moves(v)) layout.displacements += 3;
    }
    layout.own = layout.displacements;
    for (const int v : node.vertex) pressure_[v] = static_cast<int>(layout.own++);
    layout.all = layout.own;
    for (const int v : node.later) add_later(v, layout.all);
    return layout;
  }
  void add_later(int v, Index& next) {
    place_[v] = static_cast<int>(next);
    if (moves(v)) next += 3;
    pressure_[v] = static_cast<int>(next++);
  }

  /// Where the unknowns of a child's remainder stand in this front.
  std::vector<int> places_of(const DissectionNode& child) const {
    std::vector<int> places;
    for (const int v : child.later) {
      for (int k = 0; moves(v) && k < 3; ++k) places.push_back(place_[v] + k);
      places.push_back(pressure_[v]);
    }
    return places;
  }

  void assemble_element(int e, Matrix& A) const {
    const geometry::Tetrahedron& t = mesh_.tetrahedra[e];
    const MiniElement element = mini_element(
        {mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]], mesh_.vertices[t[3]]},
        options_.poisson);
    std::array<int, 16> at{};  // 12 displacements, 4 pressures; -1: held
    for (int a = 0; a < 4; ++a) {
      for (int k = 0; k < 3; ++k) at[3 * a + k] = moves(t[a]) ? place_[t[a]] + k : -1;
      at[12 + a] = pressure_[t[a]];
    }
    const auto value = [&](int i, int j) -> double {
      if (i < 12 && j < 12) return element.stiffness(i, j);
      if (i >= 12 && j >= 12) return -element.slack(i - 12, j - 12);
      return i >= 12 ? element.divergence(i - 12, j) : element.divergence(j - 12, i);
    };
    for (int i = 0; i < 16; ++i) {
      for (int j = 0; j < 16; ++j) {
        if (at[i] >= at[j] && at[j] >= 0) A(at[i], at[j]) += static_cast<Scalar>(value(i, j));
      }
    }
  }

  Remainder front(const DissectionNode& node, const std::vector<Remainder*>& children) {
    const Layout layout = lay_out(node);
    Matrix A = Matrix::Zero(layout.all, layout.all);
    for (const int e : node.element) assemble_element(e, A);

    std::vector<int> load;
    for (const Remainder* child : children) {
      load.insert(load.end(), child->load.begin(), child->load.end());
    }
    for (const int v : node.vertex) {
      if (!moves(v)) continue;
      load.insert(load.end(), loads_at_[v].begin(), loads_at_[v].end());
    }
    std::sort(load.begin(), load.end());
    load.erase(std::unique(load.begin(), load.end()), load.end());
    Matrix F = Matrix::Zero(layout.all, static_cast<Index>(load.size()));
    for (std::size_t c = 0; c < children.size(); ++c) {
      const std::vector<int> to = places_of(tree_[node.child[c]]);
      Remainder& child = *children[c];
      for (std::size_t j = 0; j < to.size(); ++j) {
        for (std::size_t i = j; i < to.size(); ++i) {
          A(std::max(to[i], to[j]), std::min(to[i], to[j])) +=
              child.matrix(static_cast<Index>(i), static_cast<Index>(j));
        }
      }
      for (std::size_t k = 0; k < child.load.size(); ++k) {
        const Index column =
            std::lower_bound(load.begin(), load.end(), child.load[k]) - load.begin();
        for (std::size_t i = 0; i < to.size(); ++i) {
          F(to[i], column) += child.border(static_cast<Index>(i), static_cast<Index>(k));
        }
      }
    }
    for (const int v : node.vertex) {
      if (!moves(v)) continue;
      for (const int j : loads_at_[v]) {
        const Index column = std::lower_bound(load.begin(), load.end(), j) - load.begin();
        const std::vector<int>& at = loads_[j].vertex;
        const auto k =
            static_cast<std::size_t>(std::lower_bound(at.begin(), at.end(), v) - at.begin());
        F.col(column).segment<3>(place_[v]) += loads_[j].force[k].cast<Scalar>();
      }
    }
    eliminate(A, F, load, 0, layout.displacements, 1);
    eliminate(A, F, load, layout.displacements, layout.own - layout.displacements, -1);
    front_bytes_ = sizeof(Scalar) * static_cast<std::size_t>(2 * A.size() + 2 * F.size());
    return remainder_of(A, F, load, layout);
  }

  Remainder remainder_of(const Matrix& A, const Matrix& F, const std::vector<int>& load,
                         const Layout& layout) const {
    Remainder result;
    const Index later = layout.all - layout.own;
    result.matrix = A.bottomRightCorner(later, later);
    std::vector<Index> kept;
    for (Index k = 0; k < F.cols(); ++k) {
      if (later == 0 ||
          F.col(k).tail(later).lpNorm<Eigen::Infinity>() < static_cast<Scalar>(options_.pruning))
        continue;
      kept.push_back(k);
      result.load.push_back(load[k]);
    }
    result.border = F.bottomRows(later)(Eigen::all, kept);
    return result;
  }

  /// Eliminates `count` unknowns from `first` on, whose block is definite with this sign.
  void eliminate(Matrix& A, Matrix& F, const std::vector<int>& load, Index first, Index count,
                 Scalar sign) {
    if (count == 0) return;
    const Index rest = A.rows() - first - count;
    const Eigen::LLT<Matrix> factor(sign * A.block(first, first, count, count));
    if (factor.info() != Eigen::Success) {
      throw NumericalError(
          "tissue: the elements around vertex " + std::to_string(first) +
          " of a front are not held anywhere; every part of the tissue must touch bone");
    }
    Matrix W(count, rest + F.cols());
    W.leftCols(rest) = A.block(first + count, first, rest, count).transpose();
    W.rightCols(F.cols()) = F.middleRows(first, count);
    factor.matrixL().solveInPlace(W);
    A.bottomRightCorner(rest, rest)
        .selfadjointView<Eigen::Lower>()
        .rankUpdate(W.leftCols(rest).transpose(), -sign);
    if (F.cols() == 0) return;
    F.bottomRows(rest).noalias() -= sign * W.leftCols(rest).transpose() * W.rightCols(F.cols());
    add_compliance(W.rightCols(F.cols()), load, sign);
  }

  /// Adds sign W^T W to the compliance among the loads, patch by patch.
  void add_compliance(const Eigen::Ref<const Matrix>& W, const std::vector<int>& load,
                      Scalar sign) {
    const auto count = static_cast<std::size_t>(compliance_.patch_count());
    std::vector<std::vector<int>> column(count), place(count);
    std::vector<int> met;
    for (std::size_t k = 0; k < load.size(); ++k) {
      const int I = compliance_.patch_of(load[k]);
      if (column[I].empty()) met.push_back(I);
      column[I].push_back(static_cast<int>(k));
      place[I].push_back(compliance_.place_of(load[k]));
    }
    std::vector<Matrix> part(count);
    for (const int I : met) part[I] = W(Eigen::all, column[I]);
    for (const int I : met) {
      const std::vector<int>& near = compliance_.near(I);
      for (std::size_t k = 0; k < near.size(); ++k) {
        const int J = near[k];
        if (column[J].empty()) continue;
        const Matrix product = part[I].transpose() * part[J];
        Eigen::MatrixXd& block = compliance_.block(I, k);
        for (Index b = 0; b < product.cols(); ++b) {
          for (Index a = 0; a < product.rows(); ++a) {
            // Of a patch with itself the lower half twice: rounding must not tell i, j from j, i.
            const Scalar value = J == I && a < b ? product(b, a) : product(a, b);
            block(place[I][a], place[J][b]) += static_cast<double>(sign * value);
          }
        }
      }
    }
  }

  const geometry::TetrahedralMesh& mesh_;
  const std::vector<char>& is_held_;
  const std::vector<SurfaceLoad>& loads_;
  const SurfaceComplianceOptions& options_;
  PatchMatrix& compliance_;
  std::vector<DissectionNode> tree_;
  std::vector<std::vector<int>> loads_at_;
  std::vector<int> place_, pressure_;
  std::size_t front_bytes_ = 0;
};

}  // namespace

void SurfaceComplianceOptions::check() const {
  if (!(poisson >= 0.0 && poisson <= 0.5)) {
    throw UsageError("tissue on bone: Poisson's ratio is " + std::to_string(poisson) +
                     "; 0 to 0.5 is required");
  }
  if (!(pruning >= 0.0 && pruning < 0.1)) {
    throw UsageError("tissue on bone: pruning is " + std::to_string(pruning) +
                     "; at least 0 and less than 0.1 is required");
  }
}

std::size_t surface_compliance(const geometry::TetrahedralMesh& mesh,
                               const std::vector<char>& is_held,
                               const std::vector<SurfaceLoad>& loads,
                               const SurfaceComplianceOptions& options, PatchMatrix& compliance) {
  options.check();
  return Eliminator(mesh, is_held, loads, options, compliance).run();
}

}  // namespace palmar::contact
