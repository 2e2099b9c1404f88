// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "palmar/contact/footprint/moving_footprint.h"
#include "palmar/server/live_request.h"
#include "palmar/server/product_shelf.h"

namespace palmar::server {

/// Where answers go; called on the worker's thread.
struct LiveSink {
  std::function<void(std::string json)> text;
  /// `is_newest_only`: a later such frame makes this one worthless if it wasn't sent yet.
  std::function<void(std::string bytes, bool is_newest_only)> bytes;
};

/// One client's session: a thread that computes, and what waits for it. The newest wins: what a
/// person asks for now makes what she asked for before worthless, so a new request takes the place
/// of waiting ones and cancels the one that runs; only a product that is being opened is waited
/// for. Requests that are given up are answered by {"say": "dropped", "request"}.
///
/// Answers: {"say": "opened", "request", "product", "hand", "holds", "colours"} with frames of the
/// hand, the product and every hold; {"say": "progress", "request", "share", "doing"};
/// {"say": "result", "request", "assessment", "command", ...} with a field and a footprint;
/// {"say": "error", "request", "message", "code"}; a request to move: one frame.
class LiveWorker {
 public:
  LiveWorker(std::shared_ptr<ProductShelf> shelf, LiveSink sink);
  LiveWorker(const LiveWorker&) = delete;
  LiveWorker& operator=(const LiveWorker&) = delete;
  ~LiveWorker();  ///< stops and waits for the thread

  void post(LiveRequest request);
  void stop();  ///< soon; answers nothing more

 private:
  void run();
  std::optional<LiveRequest> next();
  bool is_waited_for();
  void answer(const LiveRequest& request);
  void open(const LiveRequest& request, const Progress& progress);
  void move(const LiveRequest& request);
  void work(const LiveRequest& asked, const Progress& progress);
  void send_result(const LiveRequest& request, study::AssessmentSet set);
  Progress progress_of(const LiveRequest& request);

  std::shared_ptr<ProductShelf> shelf_;
  LiveSink sink_;
  // Shared with those who post:
  std::mutex mutex_;
  std::condition_variable woken_;
  std::deque<LiveRequest> waiting_;
  std::optional<LiveVerb> running_;
  bool is_stopping_ = false;
  std::atomic<bool> cancel_{false};
  // The thread's own:
  std::unique_ptr<workflow::LiveSession> session_;
  std::optional<contact::MovingFootprint> moving_footprint_;  ///< on the product as it was sent
  std::optional<ShelvedProduct> product_;
  LiveRequest opened_;    ///< hand and language of the session
  std::string own_hand_;  ///< file of the hand, if it was made here
  std::thread thread_;
};

}  // namespace palmar::server
