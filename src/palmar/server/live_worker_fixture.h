// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "palmar/server/live_worker.h"

namespace palmar::server {

/// What came, in its order; waits for it.
class LiveAnswers {
 public:
  LiveSink sink() {
    return {[this](std::string text) { add(nlohmann::json::parse(text)); },
            [this](std::string bytes, bool) {
              const auto word = [&](std::size_t at) {
                return static_cast<unsigned char>(bytes[at]) |
                       static_cast<unsigned char>(bytes[at + 1]) << 8U;
              };
              add({{"say", "frame"}, {"kind", word(4)}, {"request", word(8)}});
            }};
  }
  /// The first answer of that kind to that request.
  nlohmann::json wait_for(const std::string& say, int request) {
    std::unique_lock lock(mutex_);
    std::size_t seen = 0;
    nlohmann::json found;
    const bool is_there = come_.wait_for(lock, std::chrono::seconds(60), [&] {
      for (; seen < all_.size(); ++seen) {
        if (all_[seen]["say"] == say && all_[seen]["request"] == request) {
          found = all_[seen];
          return true;
        }
      }
      return false;
    });
    EXPECT_TRUE(is_there) << say << " of " << request << " didn't come";
    return found;
  }
  int count(const std::string& say) {
    const std::scoped_lock lock(mutex_);
    return static_cast<int>(std::count_if(
        all_.begin(), all_.end(), [&](const nlohmann::json& one) { return one["say"] == say; }));
  }

 private:
  void add(nlohmann::json answer) {
    {
      const std::scoped_lock lock(mutex_);
      all_.push_back(std::move(answer));
    }
    come_.notify_all();
  }
  std::mutex mutex_;
  std::condition_variable come_;
  std::vector<nlohmann::json> all_;
};

}  // namespace palmar::server
