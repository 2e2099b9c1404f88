// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <StepData_StepModel.hxx>

namespace palmar::cad {

/// How many parts the assemblies of a STEP file stand for, before anything is translated: products
/// used in products (NEXT_ASSEMBLY_USAGE_OCCURRENCE) and representations mapped into
/// representations (MAPPED_ITEM). A double: it may be more than any integer holds. Infinite if an
/// assembly contains itself.
double count_instances(const Handle(StepData_StepModel) & model);

}  // namespace palmar::cad
