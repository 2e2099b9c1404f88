// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/study/statistics/mean_maps.h"

#include <cmath>
#include <sstream>

#include "palmar/core/error.h"

namespace palmar::study {
namespace {

/// Mean and scatter of the hands that touch a vertex, updated hand by hand (Welford 1962); those
/// that don't are merged as zeros at the end (Chan, Golub, LeVeque 1979).
class FieldSums {
 public:
  explicit FieldSums(int vertices)
      : count_(vertices, 0),
        above_(count_.size(), 0),
        mean_(count_.size(), 0.0),
        scatter_(count_.size(), 0.0) {}

  void add(const SparseField& field, double threshold, std::int64_t task) {
    for (std::size_t i = 0; i < field.vertex.size(); ++i) {
      const int vertex = field.vertex[i];
      if (vertex < 0 || vertex >= static_cast<int>(count_.size())) {
        throw UsageError("pressure map: task " + std::to_string(task) + " names vertex " +
                         std::to_string(vertex) + " of a mesh of " + std::to_string(count_.size()));
      }
      const double value = field.value[i];
      ++count_[vertex];
      const double step = value - mean_[vertex];
      mean_[vertex] += step / count_[vertex];
      scatter_[vertex] += step * (value - mean_[vertex]);
      above_[vertex] += value > threshold ? 1 : 0;
    }
  }

  PressureMap map_over(int hands) const {
    PressureMap map{std::vector<double>(count_.size(), 0.0),
                    std::vector<double>(count_.size(), 0.0),
                    std::vector<double>(count_.size(), 0.0)};
    if (hands == 0) return map;
    const double n = hands;
    for (std::size_t v = 0; v < count_.size(); ++v) {
      const double m = count_[v];
      map.mean[v] = mean_[v] * (m / n);
      const double scatter = scatter_[v] + mean_[v] * mean_[v] * m * (n - m) / n;
      map.sd[v] = hands > 1 ? std::sqrt(scatter / (n - 1.0)) : 0.0;
      map.above[v] = above_[v] / n;
    }
    return map;
  }

 private:
  std::vector<int> count_, above_;
  std::vector<double> mean_, scatter_;
};

struct MapSums {
  int hands = 0;
  FieldSums skin, on_product;
};

}  // namespace

void MeanMapOptions::check() const {
  if (threshold >= 0.0 && threshold <= 100.0) return;
  std::ostringstream message;
  message << "pressure map: threshold is " << threshold << " MPa; 0 to 100 MPa is allowed";
  throw UsageError(message.str());
}

std::vector<StudyMaps> mean_maps(const StudyPlan& plan, const RecordSource& records,
                                 int skin_vertices, const std::vector<int>& product_vertices,
                                 const MeanMapOptions& options) {
  options.check();
  if (product_vertices.size() != plan.products.size()) {
    throw UsageError("pressure map: meshes of " + std::to_string(product_vertices.size()) +
                     " products for a plan of " + std::to_string(plan.products.size()));
  }
  const std::vector<StudyCondition> conditions = conditions_of(plan);
  std::vector<MapSums> sums;
  for (std::size_t c = 0; c < conditions.size(); ++c) {
    for (const int vertices : product_vertices) {
      sums.push_back({0, FieldSums(skin_vertices), FieldSums(vertices)});
    }
  }
  records([&](const StudyRecord& record) {
    if (!is_in_hand(record)) return;
    const StudyTask task = task_at(plan, record.number);
    const int population = plan.hands[task.hand].population;
    for (std::size_t c = 0; c < conditions.size(); ++c) {
      const StudyCondition& condition = conditions[c];
      if (condition.profile != task.profile || condition.setting != task.setting ||
          condition.grip != task.grip ||
          (condition.population && *condition.population != population)) {
        continue;
      }
      MapSums& one = sums[c * plan.products.size() + static_cast<std::size_t>(task.product)];
      ++one.hands;
      one.skin.add(record.skin_pressure, options.threshold, record.number);
      one.on_product.add(record.product_pressure, options.threshold, record.number);
    }
  });
  std::vector<StudyMaps> maps;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    maps.push_back({conditions[i / plan.products.size()],
                    static_cast<int>(i % plan.products.size()), sums[i].hands,
                    sums[i].skin.map_over(sums[i].hands),
                    sums[i].on_product.map_over(sums[i].hands)});
  }
  return maps;
}

}  // namespace palmar::study
