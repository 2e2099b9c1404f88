// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>

namespace palmar {

/// Place of an enumerator in an array that has an entry for each one, in their order.
template <typename Enum>
requires std::is_enum_v<Enum>
constexpr std::size_t index_of(Enum value) { return static_cast<std::size_t>(value); }

}  // namespace palmar
