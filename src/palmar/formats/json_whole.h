// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace palmar::formats {

/// A whole number that T can hold. nlohmann::json's own get<T>() takes 1e20 or 2^32 + 1 for any T
/// and gives whatever the processor makes of it. Throws nlohmann::json::other_error, which readers
/// of JSON catch with the library's own errors and name the file for.
template <typename T, typename JsonValue>
T json_whole(const JsonValue& value) {
  const auto refuse = [&value] {
    throw nlohmann::json::other_error::create(501,
                                              value.dump() + " isn't a whole number from " +
                                                  std::to_string(std::numeric_limits<T>::min()) +
                                                  " to " +
                                                  std::to_string(std::numeric_limits<T>::max()),
                                              nullptr);
  };
  if (!value.is_number()) return value.template get<T>();  // says what it is instead
  if (value.is_number_unsigned()) {
    const auto number = value.template get<std::uint64_t>();
    if (!std::in_range<T>(number)) refuse();
    return static_cast<T>(number);
  }
  if (value.is_number_integer()) {
    const auto number = value.template get<std::int64_t>();
    if (!std::in_range<T>(number)) refuse();
    return static_cast<T>(number);
  }
  // 3.0 is the whole number 3; from 2^53 on a double can't tell whole numbers apart.
  constexpr double kExact = 9007199254740992.0;
  const auto number = value.template get<double>();
  if (!(number > -kExact && number < kExact) ||
      number != static_cast<double>(static_cast<std::int64_t>(number)) ||
      !std::in_range<T>(static_cast<std::int64_t>(number))) {
    refuse();
  }
  return static_cast<T>(number);
}

/// That of an object's member, or `without` where it has none. Throws as json_whole().
template <typename T, typename JsonValue>
T json_whole_or(const JsonValue& object, const char* key, T without) {
  if (!object.is_object()) return object.value(key, without);  // says what it is instead
  const auto found = object.find(key);
  return found == object.end() ? without : json_whole<T>(*found);
}

/// Those of an object's list; none where it has no such member. Throws as json_whole().
template <typename T, typename JsonValue>
std::vector<T> json_wholes(const JsonValue& object, const char* key) {
  std::vector<T> numbers;
  if (!object.is_object()) return object.value(key, numbers);  // says what it is instead
  const auto found = object.find(key);
  if (found == object.end()) return numbers;
  if (!found->is_array()) return found->template get<std::vector<T>>();  // the same
  for (const JsonValue& one : *found) numbers.push_back(json_whole<T>(one));
  return numbers;
}

}  // namespace palmar::formats
