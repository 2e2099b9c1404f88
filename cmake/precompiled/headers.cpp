// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
//
// Nothing of its own: the source of the targets that precompiled headers belong to.
