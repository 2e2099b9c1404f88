// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/redesign/contact_study.h"

#include "palmar/geometry/mesh/mesh_measures.h"
#include "palmar/product/intake/make_product.h"
#include "palmar/redesign/imprint.h"

namespace palmar::redesign {

ContactStudy study_contact(const study::StudyPlan& plan, const study::StudyInputs& inputs,
                           const study::RecordSource& records,
                           const study::StudyCondition& condition, int product, double threshold,
                           const Progress& progress) {
  const product::Product& held_product = inputs.products[product];
  ContactStudy study;
  study.map = study::product_map(held_product);
  const geometry::TriangleMesh& map = study.map.mesh;
  study.count = start_count(map, threshold);
  const ImprintGauge gauge(held_product.mesh, map.vertices, geometry::vertex_normals(map));
  std::vector<Imprint> imprints;
  for_each_held_hand(
      plan, inputs, records, condition, product,
      [&](const HeldHand& held) {
        imprints.push_back(gauge.measure(held.skin));
        add_hand(study.count, map, held, imprints.back());
      },
      progress);
  study.imprint = combine_imprints(imprints, map.vertex_count());
  return study;
}

product::Product relieved_product(const product::Product& original, const ReliefPlan& plan,
                                  const std::string& name) {
  product::UnitDecision unit;
  unit.unit = geometry::LengthUnit::kMillimetre;
  unit.source = product::UnitSource::kMade;
  return product::make_product(name, relieved_mesh(original.mesh, plan.reliefs), unit,
                               "made: " + name);
}

}  // namespace palmar::redesign
