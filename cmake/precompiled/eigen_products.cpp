// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#define PALMAR_MAKES_EIGEN_INSTANCES
#include "eigen_instances.h"

PALMAR_EIGEN_PRODUCTS()
