// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/grasp/indices/convex_body.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <queue>

#include "palmar/core/error.h"
#include "palmar/grasp/rest/cone_projection.h"

namespace palmar::grasp {
namespace {

constexpr double kRankTolerance = 1e-6;  // of the largest singular value
constexpr double kJoggle = 1e-7;         // of the body's size; far above rounding of long double
constexpr double kOffFacet = 1e-6;       // of the body's size: nearer points are on the facet
constexpr double kTie = 1e-5;            // of the body's size: points of one facet
constexpr std::size_t kMaxPoints = 65000;

/// Bits that depend on the input in no visible way (splitmix64; Steele, Lea, Flood 2014).
std::uint64_t scrambled(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15ULL;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebULL;
  return x ^ (x >> 31);
}

/// The groups as one matrix, a row per point, so that a support query is one product.
template <int D>
class Support {
 public:
  using Point = Eigen::Matrix<double, D, 1>;
  explicit Support(const PointGroups<D>& body) : is_sum_(body.is_sum) {
    Eigen::Index count = 0;
    for (const auto& group : body.group) count += static_cast<Eigen::Index>(group.size());
    points_.resize(D, count);
    count = 0;
    for (const auto& group : body.group) {
      begin_.push_back(count);
      for (const Point& point : group) points_.col(count++) = point;
    }
    begin_.push_back(count);
    dot_.resize(count);
  }

  /// The farthest point along u; h(u) goes into `value`.
  Point operator()(const Point& u, double& value) {
    dot_.noalias() = points_.transpose() * u;
    Point point = Point::Zero();
    value = 0.0;
    if (!is_sum_) {
      Eigen::Index best = 0;
      if (dot_.size() == 0 || dot_.maxCoeff(&best) <= 0.0) return point;
      value = dot_[best];
      return points_.col(best);
    }
    for (std::size_t g = 0; g + 1 < begin_.size(); ++g) {
      if (begin_[g] == begin_[g + 1]) continue;
      Eigen::Index best = 0;
      const double largest = dot_.segment(begin_[g], begin_[g + 1] - begin_[g]).maxCoeff(&best);
      if (largest <= 0.0) continue;
      value += largest;
      point += points_.col(begin_[g] + best);
    }
    return point;
  }

  double size() const { return points_.cols() == 0 ? 0.0 : points_.colwise().norm().maxCoeff(); }
  double reach() const {
    return is_sum_ ? size() * static_cast<double>(begin_.size() - 1) : size();
  }
  const Eigen::Matrix<double, D, Eigen::Dynamic>& points() const { return points_; }

  /// The plane on which all points within `tie` of the farthest lie, if they span one: its normal.
  std::optional<Point> plane_near(const Point& u, double tie) {
    dot_.noalias() = points_.transpose() * u;
    std::vector<Point> difference;
    const auto add_ties = [&](Eigen::Index begin, Eigen::Index end, bool with_origin) {
      double largest = with_origin ? 0.0 : -std::numeric_limits<double>::infinity();
      Eigen::Index first = -1;  // the origin
      for (Eigen::Index j = begin; j < end; ++j) {
        if (dot_[j] > largest) {
          largest = dot_[j];
          first = j;
        }
      }
      const Point base = first < 0 ? Point(Point::Zero()) : Point(points_.col(first));
      if (with_origin && first >= 0 && largest < tie) difference.push_back(-base);
      for (Eigen::Index j = begin; j < end; ++j) {
        if (j != first && dot_[j] > largest - tie) difference.push_back(points_.col(j) - base);
      }
    };
    if (is_sum_) {
      for (std::size_t g = 0; g + 1 < begin_.size(); ++g) add_ties(begin_[g], begin_[g + 1], true);
    } else {
      add_ties(0, points_.cols(), false);
    }
    if (static_cast<int>(difference.size()) < D - 1) return std::nullopt;
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(difference.size()), D);
    for (std::size_t k = 0; k < difference.size(); ++k) {
      rows.row(static_cast<Eigen::Index>(k)) = difference[k].transpose();
    }
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows, Eigen::ComputeFullV);
    const auto& sigma = svd.singularValues();
    const double least = sigma.size() < D ? 0.0 : sigma[D - 1];
    // One plane: a clear null direction, and only one.
    if (!(least < 1e-9 * sigma[0] && sigma[D - 2] > 1e-6 * sigma[0])) return std::nullopt;
    Point n = svd.matrixV().col(D - 1);
    if (n.dot(u) < 0.0) n = -n;
    return n;
  }

 private:
  bool is_sum_;
  Eigen::Matrix<double, D, Eigen::Dynamic> points_;
  std::vector<Eigen::Index> begin_;
  Eigen::VectorXd dot_;
};

/// Polytope of simplices that grows by points outside it.
template <int D>
class GrowingHull {
 public:
  using Point = Eigen::Matrix<double, D, 1>;
  struct Facet {
    std::array<int, D> vertex;
    std::array<int, D> neighbour;  ///< [k] shares all vertices but vertex[k]
    Point normal;
    double offset = 0.0;  ///< b: normal . x <= b inside
    double reach = -1.0;  ///< h(normal); not yet asked for if below 0
    bool is_alive = true;
  };

  /// From D + 1 points in general position.
  GrowingHull(const std::vector<Point>& simplex, double size) : size_(size) {
    centre_.setZero();
    for (const Point& p : simplex) {
      add_point(p);
      centre_ += p / static_cast<double>(simplex.size());
    }
    for (int left_out = 0; left_out <= D; ++left_out) {
      Facet facet;
      for (int k = 0, i = 0; i <= D; ++i) {
        if (i == left_out) continue;
        facet.vertex[k] = i;
        facet.neighbour[k] = i;  // the facet that leaves out i
        ++k;
      }
      set_plane(facet);
      facets_.push_back(facet);
    }
    alive_ = D + 1;
  }

  const std::vector<Facet>& facets() const { return facets_; }
  Facet& facet(int f) { return facets_[f]; }
  const Point& centre() const { return centre_; }
  int alive() const { return alive_; }
  bool is_broken() const { return is_broken_; }
  bool is_full() const { return true_.size() >= kMaxPoints; }

  /// Adds a point that facet `from` sees; facets from the number returned on are new.
  int add(const Point& point, int from) {
    const int apex = add_point(point);
    const int first_new = static_cast<int>(facets_.size());
    find_visible(apex, from);
    table_.clear();
    for (const auto& [outer, side] : horizon_) add_facet(apex, outer, side, first_new);
    for (const int f : visible_) facet(f).is_alive = false;
    alive_ += static_cast<int>(facets_.size()) - first_new - static_cast<int>(visible_.size());
    if (open_ != 0) is_broken_ = true;
    return first_new;
  }

  /// Volume between a facet and the inner point, at the points' true places.
  double volume_of(const Facet& facet) const {
    Eigen::Matrix<double, D, D> m;
    for (int k = 0; k < D; ++k) {
      m.col(k) = true_[facet.vertex[k]] - centre_;
    }
    double factorial = 1.0;
    for (int k = 2; k <= D; ++k) factorial *= k;
    return std::abs(m.partialPivLu().determinant()) / factorial;
  }

 private:
  int add_point(const Point& p) {
    Point moved = p;
    for (int k = 0; k < D; ++k) {
      const std::uint64_t bits = scrambled(true_.size() * D + static_cast<std::size_t>(k));
      const double in_unit = static_cast<double>(bits >> 11) * 0x1p-52 - 1.0;
      moved[k] += kJoggle * size_ * in_unit;
    }
    true_.push_back(p);
    moved_.push_back(moved);
    return static_cast<int>(true_.size()) - 1;
  }

  /// Normal and offset of a facet: the null vector of its edges. In double; for slivers between
  /// points on a common plane, thin as the joggle, in long double.
  void set_plane(Facet& facet) const {
    if (!null_vector<double>(facet, 1e-3 * size_)) null_vector<long double>(facet, 0.0L);
    facet.offset = facet.normal.dot(moved_[facet.vertex[0]]);
    if (facet.normal.dot(centre_) > facet.offset) {
      facet.normal = -facet.normal;
      facet.offset = -facet.offset;
    }
  }

  /// Elimination with complete pivoting; false if a pivot is not above `least`.
  template <typename Real>
  bool null_vector(Facet& facet, Real least) const {
    Real m[D - 1][D];
    const Point& origin = moved_[facet.vertex[0]];
    for (int i = 0; i + 1 < D; ++i) {
      const Point& p = moved_[facet.vertex[i + 1]];
      for (int k = 0; k < D; ++k) m[i][k] = static_cast<Real>(p[k]) - static_cast<Real>(origin[k]);
    }
    int column[D];  // where the columns came from; they are swapped in place
    for (int k = 0; k < D; ++k) column[k] = k;
    for (int step = 0; step + 1 < D; ++step) {
      int row = step, col = step;
      Real largest = -1;
      for (int i = step; i + 1 < D; ++i) {
        for (int k = step; k < D; ++k) {
          if (std::abs(m[i][k]) > largest) {
            largest = std::abs(m[i][k]);
            row = i;
            col = k;
          }
        }
      }
      if (!(largest > least)) return false;
      if (row != step) std::swap(m[row], m[step]);
      if (col != step) {
        for (int i = 0; i + 1 < D; ++i) std::swap(m[i][col], m[i][step]);
        std::swap(column[col], column[step]);
      }
      for (int i = step + 1; i + 1 < D; ++i) {
        const Real factor = m[i][step] / m[step][step];
        for (int k = step + 1; k < D; ++k) m[i][k] -= factor * m[step][k];
      }
    }
    Real n[D];
    n[D - 1] = 1;
    Real squared = 1;
    for (int step = D - 2; step >= 0; --step) {
      Real sum = 0;
      for (int k = step + 1; k < D; ++k) sum += m[step][k] * n[k];
      n[step] = -sum / m[step][step];
      squared += n[step] * n[step];
    }
    const Real length = std::sqrt(squared);
    for (int k = 0; k < D; ++k) facet.normal[column[k]] = static_cast<double>(n[k] / length);
    return true;
  }

  void find_visible(int apex, int from) {
    const Point& p = moved_[apex];
    seen_.resize(facets_.size(), 0);
    visible_.assign(1, from);
    horizon_.clear();
    seen_[from] = apex;
    for (std::size_t at = 0; at < visible_.size(); ++at) {
      const int f = visible_[at];
      for (int k = 0; k < D; ++k) {
        const int next = facet(f).neighbour[k];
        int& mark = seen_[next];
        if (mark == apex) continue;
        if (facet(next).normal.dot(p) > facet(next).offset) {
          mark = apex;
          visible_.push_back(next);
        } else {
          horizon_.emplace_back(f, k);
        }
      }
    }
  }

  /// The facet over the ridge between visible facet `inner` and its neighbour `side`.
  void add_facet(int apex, int inner, int side, int first_new) {
    const int number = static_cast<int>(facets_.size());
    if (number == first_new) open_ = 0;
    Facet made;
    made.vertex = facet(inner).vertex;
    made.vertex[side] = apex;
    made.neighbour.fill(-1);
    const int outer = facet(inner).neighbour[side];
    made.neighbour[side] = outer;
    for (int& back : facet(outer).neighbour) {
      if (back == inner) {
        back = number;
        break;
      }
    }
    set_plane(made);
    facets_.push_back(made);
    for (int k = 0; k < D; ++k) {
      if (k == side) continue;
      // The ridge without vertex k holds the apex and D - 2 others, which name it.
      std::uint64_t others[D];
      int count = 0;
      for (int i = 0; i < D; ++i) {
        if (i == k || i == side) continue;
        const auto v = static_cast<std::uint64_t>(made.vertex[i]);
        int at = count++;
        for (; at > 0 && others[at - 1] > v; --at) others[at] = others[at - 1];
        others[at] = v;
      }
      std::uint64_t key = 0;
      for (int i = 0; i < count; ++i) key = (key << 16) | others[i];
      if (const auto other = table_.match(key, number, k)) {
        facet(number).neighbour[k] = other->first;
        facet(other->first).neighbour[other->second] = number;
        --open_;
      } else {
        ++open_;
      }
    }
  }

  /// Ridges that wait for their second facet: open addressing.
  class RidgeTable {
   public:
    void clear() {
      std::fill(slot_.begin(), slot_.end(), Slot{});
      used_ = 0;
    }
    /// The ridge's other facet and its side, or nothing the first time.
    std::optional<std::pair<int, int>> match(std::uint64_t key, int facet, int side) {
      if (2 * (used_ + 1) > slot_.size()) grow();
      Slot& slot = slot_[place(key)];
      if (slot.facet >= 0) return std::pair(slot.facet, slot.side);
      slot = {key, facet, side};
      ++used_;
      return std::nullopt;
    }

   private:
    struct Slot {
      std::uint64_t key = 0;
      int facet = -1, side = 0;
    };
    std::size_t place(std::uint64_t key) const {
      std::size_t i = scrambled(key) & (slot_.size() - 1);
      while (slot_[i].facet >= 0 && slot_[i].key != key) i = (i + 1) & (slot_.size() - 1);
      return i;
    }
    void grow() {
      std::vector<Slot> old = std::move(slot_);
      slot_.assign(old.empty() ? 256 : 2 * old.size(), Slot{});
      for (const Slot& one : old) {
        if (one.facet >= 0) slot_[place(one.key)] = one;
      }
    }
    std::vector<Slot> slot_;
    std::size_t used_ = 0;
  };

  double size_;
  Point centre_;
  std::vector<Point> true_, moved_;
  std::vector<Facet> facets_;
  std::vector<int> seen_;  ///< last point that asked whether a facet sees it
  std::vector<int> visible_;
  std::vector<std::pair<int, int>> horizon_;
  RidgeTable table_;
  int open_ = 0;  ///< ridges of the new facets that have one facet only
  int alive_ = 0;
  bool is_broken_ = false;
};

/// D + 1 points of the body that span it; fewer if it is flat.
template <int D>
std::vector<Eigen::Matrix<double, D, 1>> first_simplex(Support<D>& support, double size) {
  using Point = Eigen::Matrix<double, D, 1>;
  double value = 0.0;
  std::vector<Point> simplex = {support(Point::Unit(0), value)};
  Eigen::Matrix<double, D, D> spanned = Eigen::Matrix<double, D, D>::Zero();
  for (int k = 0; k < D; ++k) {
    Point best;
    double farthest = 0.0;
    for (int axis = 0; axis < D; ++axis) {
      Point u = Point::Unit(axis);
      for (int i = 0; i < k; ++i) u -= spanned.col(i) * spanned.col(i).dot(u);
      if (u.norm() < 1e-6) continue;
      u.normalize();
      for (const double sign : {1.0, -1.0}) {
        const Point p = support(sign * u, value);
        Point away = p - simplex.front();
        for (int i = 0; i < k; ++i) away -= spanned.col(i) * spanned.col(i).dot(away);
        if (away.norm() > farthest * (1.0 + 1e-9)) {
          farthest = away.norm();
          best = p;
        }
      }
    }
    if (!(farthest > 1e-9 * size)) return simplex;
    Point axis = best - simplex.front();
    for (int pass = 0; pass < 2; ++pass) {
      for (int i = 0; i < k; ++i) axis -= spanned.col(i) * spanned.col(i).dot(axis);
    }
    spanned.col(k) = axis.normalized();
    simplex.push_back(best);
  }
  return simplex;
}

/// A direction in which the body doesn't reach, or nothing if the origin lies strictly inside. It
/// does just if the points span the space and the negative of their mean is a combination of them
/// with factors >= 0: then 0 is one with all factors > 0.
template <int D>
std::optional<Eigen::Matrix<double, D, 1>> unreached(
    const Eigen::Matrix<double, D, Eigen::Dynamic>& points, double size) {
  const ConeProjection nearest = project_on_cone(points, -points.rowwise().mean());
  if (nearest.rest.norm() < 1e-9 * size) return std::nullopt;
  return Eigen::Matrix<double, D, 1>(nearest.rest.normalized());
}

template <int D>
class Measuring {
 public:
  using Point = Eigen::Matrix<double, D, 1>;
  Measuring(Support<D>& support, const BodyOptions& options)
      : support_(support),
        options_(options),
        size_(support.reach()),
        hull_(first_simplex(support, size_), size_) {}

  void find_distance(BodyMeasures<D>& result) {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> nearest;
    int pushed = 0;
    const auto push = [&] {
      for (const int end = static_cast<int>(hull_.facets().size()); pushed < end; ++pushed) {
        nearest.emplace(hull_.facet(pushed).offset, pushed);
      }
    };
    push();
    double upper = std::numeric_limits<double>::infinity();
    Point best = Point::Zero();
    result.is_distance_exact = false;
    while (!nearest.empty() && !hull_.is_broken()) {
      const int f = nearest.top().second;
      if (!hull_.facet(f).is_alive) {
        nearest.pop();
        continue;
      }
      const double lower = hull_.facet(f).offset;
      double reach = 0.0;
      const Point point = support_(hull_.facet(f).normal, reach);
      hull_.facet(f).reach = reach;
      if (reach < upper) {
        upper = reach;
        best = hull_.facet(f).normal;
      }
      result.distance_lower = std::max(0.0, lower - 2.0 * std::sqrt(D) * kJoggle * size_);
      if (reach <= lower + kOffFacet * size_) {
        result.is_distance_exact = true;
        break;
      }
      if (upper - lower <= options_.distance_gap * upper) break;
      if (static_cast<int>(hull_.facets().size()) >= options_.max_facets || hull_.is_full()) break;
      hull_.add(point, f);
      push();
    }
    if (const auto plane = support_.plane_near(best, kTie * size_)) {
      double reach = 0.0;
      support_(*plane, reach);
      if (reach < upper + kTie * size_) {
        upper = reach;
        best = *plane;
      }
    }
    result.distance = upper;
    result.weakest = best;
    if (result.is_distance_exact) result.distance_lower = upper;
  }

  void find_volume(BodyMeasures<D>& result) {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry> widest;
    int asked = 0;
    const auto ask = [&] {
      for (const int end = static_cast<int>(hull_.facets().size()); asked < end; ++asked) {
        if (!hull_.facet(asked).is_alive) continue;
        typename GrowingHull<D>::Facet& facet = hull_.facet(asked);
        if (facet.reach < 0.0) support_(facet.normal, facet.reach);
        if (facet.reach > facet.offset + kOffFacet * size_) {
          widest.emplace(facet.reach - facet.offset, asked);
        }
      }
    };
    ask();
    const std::size_t most =
        hull_.facets().size() + static_cast<std::size_t>(options_.max_volume_facets);
    while (!widest.empty() && !hull_.is_broken() && hull_.facets().size() < most &&
           !hull_.is_full()) {
      const int f = widest.top().second;
      widest.pop();
      if (!hull_.facet(f).is_alive) continue;
      double reach = 0.0;
      hull_.add(support_(hull_.facet(f).normal, reach), f);
      ask();
    }
    result.volume = result.volume_upper = 0.0;
    result.is_volume_exact = true;
    for (const typename GrowingHull<D>::Facet& facet : hull_.facets()) {
      if (!facet.is_alive) continue;
      const double volume = hull_.volume_of(facet);
      result.volume += volume;
      double ratio = 1.0;
      if (facet.reach > facet.offset + kOffFacet * size_) {
        const double inner = facet.normal.dot(hull_.centre());
        ratio = std::pow((facet.reach - inner) / (facet.offset - inner), D);
        result.is_volume_exact = false;
      }
      result.volume_upper += ratio * volume;
    }
  }

  int facets() const { return hull_.alive(); }
  int made() const { return static_cast<int>(hull_.facets().size()); }
  bool is_broken() const { return hull_.is_broken(); }

 private:
  Support<D>& support_;
  const BodyOptions& options_;
  double size_;
  GrowingHull<D> hull_;
};

}  // namespace

template <int D>
double support(const PointGroups<D>& body, const Eigen::Matrix<double, D, 1>& direction) {
  double value = 0.0;
  Support<D> ask(body);
  ask(direction, value);
  return value;
}

template <int D>
BodyMeasures<D> measure(const PointGroups<D>& body, const BodyOptions& options) {
  BodyMeasures<D> result;
  Support<D> support(body);
  if (!support.points().allFinite()) throw UsageError("convex body: a point is not finite");
  if (!(support.size() > 0.0)) return result;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(support.points() * support.points().transpose(),
                                              Eigen::ComputeFullU);
  for (int k = 0; k < D; ++k) {
    if (svd.singularValues()[k] > kRankTolerance * kRankTolerance * svd.singularValues()[0]) {
      ++result.rank;
    }
  }
  if (result.rank < D) {
    result.weakest = svd.matrixU().col(D - 1);
    return result;
  }
  if (const auto direction = unreached<D>(support.points(), support.size())) {
    result.weakest = *direction;
  } else {
    result.contains_origin = true;
  }
  Measuring<D> measuring(support, options);
  if (result.contains_origin) measuring.find_distance(result);
  if (options.with_volume) {
    measuring.find_volume(result);
  } else {
    result.volume_upper = std::numeric_limits<double>::infinity();
    result.is_volume_exact = false;
  }
  if (measuring.is_broken()) {
    result.is_distance_exact = result.is_volume_exact = false;
  }
  result.facets = measuring.facets();
  return result;
}

template double support<3>(const PointGroups<3>&, const Eigen::Matrix<double, 3, 1>&);
template double support<6>(const PointGroups<6>&, const Eigen::Matrix<double, 6, 1>&);
template BodyMeasures<3> measure<3>(const PointGroups<3>&, const BodyOptions&);
template BodyMeasures<6> measure<6>(const PointGroups<6>&, const BodyOptions&);

}  // namespace palmar::grasp
