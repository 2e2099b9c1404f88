// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/face_statistics.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/product/gloved.h"
#include "palmar/study/assessment/face_contacts.h"
#include "palmar/study/study_task.h"

namespace palmar::study {
namespace {

/// The maps of all products that have faces, bare and inside each glove.
class FaceMaps {
 public:
  FaceMaps(const StudyPlan& plan, const std::vector<product::Product>& products) {
    for (std::size_t p = 0; p < products.size(); ++p) {
      if (products[p].faces == nullptr) continue;
      const ProductMap map = product_map(products[p]);
      for (const population::HandProfile& profile : plan.profiles) {
        const std::pair key(static_cast<int>(p), profile.glove_thickness);
        if (areas_.contains(key)) continue;
        if (profile.glove_thickness == 0.0) {
          areas_.emplace(key, FaceAreas(map.mesh, map.face_of_triangle));
          continue;
        }
        product::Product as_map = products[p];
        as_map.mesh = map.mesh;
        areas_.emplace(key, FaceAreas(product::gloved(as_map, profile.glove_thickness).mesh,
                                      map.face_of_triangle));
      }
    }
  }
  bool empty() const { return areas_.empty(); }
  const FaceAreas* of(int product, double glove) const {
    const auto found = areas_.find({product, glove});
    return found == areas_.end() ? nullptr : &found->second;
  }

 private:
  std::map<std::pair<int, double>, FaceAreas> areas_;
};

/// What was seen of one face so far.
struct FaceSums {
  std::vector<double> peaks;
  int with_peak = 0, above = 0;
  double force = 0.0, share = 0.0, area = 0.0;
};

struct Sums {
  int hands = 0;
  std::map<int, FaceSums> face;

  void add(const std::vector<FaceContact>& contacts, double threshold) {
    ++hands;
    double total = 0.0;
    for (const FaceContact& one : contacts) total += one.force;
    for (const FaceContact& one : contacts) {
      FaceSums& sums = face[one.face];
      sums.peaks.push_back(one.peak_pressure);
      sums.with_peak += one.has_peak ? 1 : 0;
      sums.above += one.peak_pressure > threshold ? 1 : 0;
      sums.force += one.force;
      sums.share += one.force / total;
      sums.area += one.area;
    }
  }

  std::vector<FaceSummary> summaries() const {
    std::vector<FaceSummary> all;
    for (const auto& [index, sums] : face) {
      FaceSummary one;
      one.face = index;
      one.touched = statistics::wilson_proportion(static_cast<int>(sums.peaks.size()), hands);
      one.has_peak = statistics::wilson_proportion(sums.with_peak, hands);
      one.above = statistics::wilson_proportion(sums.above, hands);
      one.peak = statistics::summarise(sums.peaks);
      std::vector<double> sorted = sums.peaks;
      std::sort(sorted.begin(), sorted.end());
      one.peak_p95 = statistics::quantile(sorted, 0.95);
      one.force = sums.force / hands;
      one.force_share = sums.share / hands;
      one.area = sums.area / hands;
      all.push_back(one);
    }
    return all;
  }
};

}  // namespace

std::vector<FaceStatistics> face_statistics(const StudyPlan& plan,
                                            const std::vector<product::Product>& products,
                                            const RecordSource& records,
                                            const MeanMapOptions& options) {
  options.check();
  if (products.size() != plan.products.size()) {
    throw UsageError("faces: " + std::to_string(products.size()) + " products for a plan of " +
                     std::to_string(plan.products.size()));
  }
  const FaceMaps maps(plan, products);
  if (maps.empty()) return {};
  const std::vector<StudyCondition> conditions = conditions_of(plan);
  std::vector<Sums> sums(conditions.size() * products.size());
  records([&](const StudyRecord& record) {
    if (!is_in_hand(record)) return;
    const StudyTask task = task_at(plan, record.number);
    const FaceAreas* areas = maps.of(task.product, plan.profiles[task.profile].glove_thickness);
    if (areas == nullptr) return;
    const std::vector<FaceContact> contacts = areas->contacts(
        dense(record.product_pressure, areas->vertex_count()), record.product_pressure.vertex);
    const int population = plan.hands[task.hand].population;
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const StudyCondition& condition = conditions[c];
      if (condition.profile != task.profile || condition.setting != task.setting ||
          condition.grip != task.grip ||
          (condition.population && *condition.population != population)) {
        continue;
      }
      sums[c * products.size() + static_cast<std::size_t>(task.product)].add(contacts,
                                                                             options.threshold);
    }
  });
  std::vector<FaceStatistics> all;
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    for (std::size_t p = 0; p < products.size(); ++p) {
      if (products[p].faces == nullptr) continue;
      const Sums& one = sums[c * products.size() + p];
      all.push_back({conditions[c], static_cast<int>(p), one.hands, one.summaries()});
    }
  }
  return all;
}

const FaceSummary* hottest_face(const FaceStatistics& statistics) {
  const FaceSummary* best = nullptr;
  for (const FaceSummary& one : statistics.faces) {
    if (best == nullptr || one.has_peak.count > best->has_peak.count ||
        (one.has_peak.count == best->has_peak.count && one.peak.mean > best->peak.mean)) {
      best = &one;
    }
  }
  return best;
}

}  // namespace palmar::study
