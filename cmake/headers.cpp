// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Nothing of its own: the target that the tests' precompiled header belongs to.
