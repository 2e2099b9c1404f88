// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/cad/model/step_instances.h"

#include <StepBasic_ProductDefinition.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_Representation.hxx>
#include <StepRepr_RepresentationMap.hxx>
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <vector>

namespace palmar::cad {
namespace {

using Entity = const Standard_Transient*;

/// Who uses whom; each use counts.
class Uses {
 public:
  void add(Entity user, Entity used) {
    if (user == nullptr || used == nullptr) return;
    used_by_[user].push_back(used);
    is_used_.insert(used);
  }
  double count() const {
    if (used_by_.empty()) return 0.0;
    double sum = 0.0;
    bool has_root = false;
    std::map<Entity, double> known;
    std::set<Entity> open;
    for (const auto& [user, used] : used_by_) {
      if (is_used_.count(user) > 0) continue;
      has_root = true;
      sum += count(user, known, open);
    }
    return has_root ? sum : std::numeric_limits<double>::infinity();
  }

 private:
  double count(Entity user, std::map<Entity, double>& known, std::set<Entity>& open) const {
    constexpr std::size_t kDeepest = 1000;  // of recursion here; real assemblies are 10 deep
    const auto uses = used_by_.find(user);
    if (uses == used_by_.end()) return 1.0;
    if (const auto found = known.find(user); found != known.end()) return found->second;
    if (open.size() > kDeepest || !open.insert(user).second) {
      return std::numeric_limits<double>::infinity();
    }
    double sum = 0.0;
    for (const Entity used : uses->second) sum += count(used, known, open);
    open.erase(user);
    known[user] = sum;
    return sum;
  }

  std::map<Entity, std::vector<Entity>> used_by_;
  std::set<Entity> is_used_;
};

}  // namespace

double count_instances(const Handle(StepData_StepModel) & model) {
  Uses products, representations;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (const auto use = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(entity);
        !use.IsNull()) {
      products.add(use->RelatingProductDefinition().get(), use->RelatedProductDefinition().get());
    }
    if (const auto representation = Handle(StepRepr_Representation)::DownCast(entity);
        !representation.IsNull()) {
      for (int k = 1; k <= representation->NbItems(); ++k) {
        const auto item = Handle(StepRepr_MappedItem)::DownCast(representation->ItemsValue(k));
        if (item.IsNull() || item->MappingSource().IsNull()) continue;
        representations.add(representation.get(),
                            item->MappingSource()->MappedRepresentation().get());
      }
    }
  }
  return std::max(products.count(), representations.count());
}

}  // namespace palmar::cad
