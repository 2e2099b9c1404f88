// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/workflow/redesign/proposal_list.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace palmar::workflow {
namespace {

constexpr double kLeastShare = 0.1;  // of hands; rarer ones aren't worth a change of the product
constexpr std::size_t kMostProposals = 24, kMostMoved = 6;
constexpr double kFirstRadii[] = {3.0, 6.0};   // mm; of an edge that is sharp
constexpr double kTimesRadius[] = {2.0, 4.0};  // of one that is rounded
constexpr double kMove = 1.0;                  // mm; of a face
constexpr double kSameRadius = 0.05;           // mm; fillets that were made with one radius

std::string share_words(const product::ProductFaces& faces, const study::FaceSummary& face) {
  const std::string title = title_of(faces.face[static_cast<std::size_t>(face.face)]);
  if (face.has_peak.share < kLeastShare) {
    return fmt::format("{} is touched by {:.0f} % of hands", title, 100 * face.touched.share);
  }
  return fmt::format("{} has the highest pressure in {:.0f} % of hands", title,
                     100 * face.has_peak.share);
}

/// Radius that a budget of change allows: between faces at right angles the surface of a fillet
/// moves by (sqrt 2 - 1) of the change of its radius.
double radius_within(double from, double wanted, const FeatureLimits& limits) {
  if (!limits.largest_offset) return wanted;
  const double most = from + *limits.largest_offset / (std::numbers::sqrt2 - 1);
  return std::floor(std::min(wanted, most) * 20) / 20;
}

bool rounds(const product::ProductFace& face) { return face.is_fillet && face.radius > 0.0; }

/// A face and those that it runs into smoothly, fillets aside: they move together. "3+4".
std::string faces_with(const product::ProductFaces& faces, int face) {
  std::vector<int> group = {face};
  for (std::size_t i = 0; i < group.size(); ++i) {
    for (const product::ProductEdge& edge : faces.edge) {
      if (!edge.is_smooth || edge.faces[0] < 0 || edge.faces[1] < 0) continue;
      if (edge.faces[0] != group[i] && edge.faces[1] != group[i]) continue;
      const int beyond = edge.faces[0] == group[i] ? edge.faces[1] : edge.faces[0];
      if (rounds(faces.face[static_cast<std::size_t>(beyond)])) continue;
      if (std::find(group.begin(), group.end(), beyond) == group.end()) group.push_back(beyond);
    }
  }
  std::vector<int> numbers;
  for (const int one : group) numbers.push_back(faces.face[static_cast<std::size_t>(one)].number);
  std::sort(numbers.begin(), numbers.end());
  return fmt::format("{}", fmt::join(numbers, "+"));
}

bool is_hot(const study::FaceSummary& face) { return face.has_peak.share >= kLeastShare; }

/// Proposals that know each other.
class ProposalList {
 public:
  void add(const std::string& words, const std::string& reason) {
    if (all_.size() < kMostProposals && known_.insert(words).second)
      all_.push_back({words, reason});
  }
  std::vector<Proposal> take() { return std::move(all_); }

 private:
  std::vector<Proposal> all_;
  std::set<std::string> known_;
};

std::string joined(std::vector<int> numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return fmt::format("{}", fmt::join(numbers, "+"));
}

void add_radii(ProposalList& list, const std::string& where, double from,
               const std::vector<double>& wanted, const std::string& reason,
               const FeatureLimits& limits) {
  for (const double radius : wanted) {
    list.add(fmt::format("fillet:{}={:g}", where, radius_within(from, radius, limits)), reason);
  }
}

}  // namespace

std::vector<Proposal> proposals_for(const product::ProductFaces& faces,
                                    std::vector<study::FaceSummary> touched,
                                    const FeatureLimits& limits) {
  std::erase_if(touched, [](const study::FaceSummary& face) {
    return face.touched.share < kLeastShare && !is_hot(face);
  });
  std::stable_sort(touched.begin(), touched.end(),
                   [](const study::FaceSummary& a, const study::FaceSummary& b) {
                     return std::pair(a.has_peak.count, a.touched.count) >
                            std::pair(b.has_peak.count, b.touched.count);
                   });
  const auto own = [&](const study::FaceSummary& face) -> const product::ProductFace& {
    return faces.face[static_cast<std::size_t>(face.face)];
  };
  const auto sharp_edges_of = [&](const study::FaceSummary& face) {
    std::vector<int> edges;
    for (const product::ProductEdge& edge : faces.edge) {
      if (edge.is_convex && !edge.is_smooth && edge.faces[0] >= 0 && edge.faces[1] >= 0 &&
          (edge.faces[0] == face.face || edge.faces[1] == face.face)) {
        edges.push_back(edge.number);
      }
    }
    return edges;
  };
  ProposalList list;
  // All fillets of one radius together, then each hot one.
  std::map<long, std::vector<const study::FaceSummary*>> by_radius;
  std::vector<int> edges;
  for (const study::FaceSummary& face : touched) {
    if (rounds(own(face)) && !own(face).is_concave) {
      by_radius[std::lround(own(face).radius / kSameRadius)].push_back(&face);
    }
    const std::vector<int> its = sharp_edges_of(face);
    edges.insert(edges.end(), its.begin(), its.end());
  }
  for (const auto& [key, those] : by_radius) {
    const double radius = own(*those.front()).radius;
    std::vector<double> wanted;
    for (const double times : kTimesRadius) wanted.push_back(times * radius);
    std::vector<int> numbers;
    for (const study::FaceSummary* face : those) numbers.push_back(own(*face).number);
    const std::string reason = share_words(faces, *those.front());
    add_radii(list, "face=" + joined(numbers), radius, wanted,
              those.size() > 1
                  ? fmt::format("{}; all {} fillets of r {:.3g} mm", reason, those.size(), radius)
                  : reason,
              limits);
    for (const study::FaceSummary* face : those) {
      if (is_hot(*face) && those.size() > 1) {
        add_radii(list, fmt::format("face={}", own(*face).number), radius, wanted,
                  share_words(faces, *face), limits);
      }
    }
  }
  const std::vector<double> first(std::begin(kFirstRadii), std::end(kFirstRadii));
  if (!edges.empty()) {
    add_radii(list, "edge=" + joined(edges), 0.0, first, "the sharp edges that hands come near",
              limits);
  }
  for (const study::FaceSummary& face : touched) {
    const std::vector<int> its = sharp_edges_of(face);
    if (is_hot(face) && !its.empty()) {
      add_radii(list, "edge=" + joined(its), 0.0, first,
                share_words(faces, face) + "; its sharp edges", limits);
    }
  }
  // Faces in and out: all together first, then each.
  const double move = std::min(kMove, limits.largest_offset.value_or(kMove));
  std::vector<std::pair<std::string, std::string>> groups;
  std::set<std::string> known;
  for (const study::FaceSummary& face : touched) {
    if (rounds(own(face)) || groups.size() == kMostMoved) continue;
    const std::string group = faces_with(faces, face.face);
    if (known.insert(group).second) groups.emplace_back(group, share_words(faces, face));
  }
  if (groups.size() > 1) {
    std::string all;
    for (const auto& [group, reason] : groups) all += (all.empty() ? "" : "+") + group;
    for (const double by : {move, -move}) {
      list.add(fmt::format("offset:face={}={:g}", all, by), "all faces that hands touch");
    }
  }
  for (const auto& [group, reason] : groups) {
    for (const double by : {-move, move}) {
      list.add(fmt::format("offset:face={}={:g}", group, by), reason);
    }
  }
  return list.take();
}

}  // namespace palmar::workflow
