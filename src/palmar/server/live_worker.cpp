// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/live_worker.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "palmar/core/error.h"
#include "palmar/grasp/equilibrium/grip_force.h"
#include "palmar/hand/skin/skinning.h"
#include "palmar/report/picture/display_mesh.h"
#include "palmar/server/live_answer.h"
#include "palmar/server/live_frame.h"

namespace palmar::server {
namespace {

constexpr auto kBetweenProgress = std::chrono::milliseconds(100);

LiveField field_of(const workflow::LivePose& pose, const contact::ContactResult& contact,
                   const product::Product& product) {
  LiveField field;
  field.posture = pose.posture;
  field.product_from_hand = pose.product_from_hand;
  field.contact = &contact;
  field.grip_force = grasp::grip_force(contact, *product.distance).force;
  return field;
}

}  // namespace

LiveWorker::LiveWorker(std::shared_ptr<ProductShelf> shelf, LiveSink sink)
    : shelf_(std::move(shelf)), sink_(std::move(sink)), thread_([this] { run(); }) {}

LiveWorker::~LiveWorker() {
  stop();
  thread_.join();
}

void LiveWorker::stop() {
  {
    const std::scoped_lock lock(mutex_);
    is_stopping_ = true;
    cancel_ = true;
    waiting_.clear();
  }
  woken_.notify_all();
}

void LiveWorker::post(LiveRequest request) {
  std::deque<LiveRequest> dropped;
  {
    const std::scoped_lock lock(mutex_);
    if (is_stopping_) return;
    const bool is_open = request.verb == LiveVerb::kOpen;
    std::deque<LiveRequest> kept;
    for (LiveRequest& one : waiting_) {
      const bool is_kept = one.verb == LiveVerb::kOpen && !is_open;
      (is_kept ? kept : dropped).push_back(std::move(one));
    }
    waiting_ = std::move(kept);
    if (running_ && (is_open || *running_ != LiveVerb::kOpen)) cancel_ = true;
    waiting_.push_back(std::move(request));
  }
  woken_.notify_one();
  for (const LiveRequest& one : dropped) sink_.text(dropped_answer(one.id));
}

bool LiveWorker::is_waited_for() {
  const std::scoped_lock lock(mutex_);
  return is_stopping_ || !waiting_.empty();
}

std::optional<LiveRequest> LiveWorker::next() {
  std::unique_lock lock(mutex_);
  running_.reset();
  woken_.wait(lock, [this] { return is_stopping_ || !waiting_.empty(); });
  if (is_stopping_) return std::nullopt;
  LiveRequest request = std::move(waiting_.front());
  waiting_.pop_front();
  running_ = request.verb;
  cancel_ = false;
  return request;
}

void LiveWorker::run() {
  while (const std::optional<LiveRequest> request = next()) {
    try {
      answer(*request);
      // So that the first step of a drag needn't wait for it.
      if (session_ && !is_waited_for()) session_->prepare_to_move();
    } catch (const Cancelled&) {
      sink_.text(dropped_answer(request->id));
    } catch (const Error& error) {
      sink_.text(error_answer(request->id, error.what(), error.exit_code()));
    } catch (const std::exception& error) {
      sink_.text(error_answer(request->id, error.what(), 1));
    }
  }
}

Progress LiveWorker::progress_of(const LiveRequest& request) {
  Progress progress;
  progress.cancel = &cancel_;
  const auto last = std::make_shared<std::chrono::steady_clock::time_point>();
  progress.report = [this, last, id = request.id](double share, const std::string& doing) {
    const auto now = std::chrono::steady_clock::now();
    if (now - *last < kBetweenProgress) return;
    *last = now;
    sink_.text(progress_answer(id, share, doing));
  };
  return progress;
}

void LiveWorker::answer(const LiveRequest& request) {
  const Progress progress = progress_of(request);
  if (request.verb == LiveVerb::kOpen) {
    open(request, progress);
    return;
  }
  if (session_ == nullptr) throw UsageError("live request: no product is open");
  if (request.verb == LiveVerb::kMove) {
    move(request);
  } else {
    work(request, progress);
  }
}

void LiveWorker::open(const LiveRequest& request, const Progress& progress) {
  session_.reset();
  progress.update(0.0, "reading the product");
  product_ = shelf_->open(request.product, progress);
  progress.update(0.1, "preparing the hand");
  workflow::LiveHand hand = shelf_->hand({request.person, request.own_hand, request.is_left});
  own_hand_ = request.own_hand.empty() ? "" : shelf_->own_hand(request.own_hand).string();
  opened_ = request;
  auto session = std::make_unique<workflow::LiveSession>(std::move(hand), product_->product);
  const product::Product& product = session->product();
  sink_.bytes(hand_frame(session->hand(), request.id), false);
  const std::vector<double> none(product.mesh.vertices.size(), 0.0);
  // As fine as the skin, as its vertices are coloured along a motion.
  moving_footprint_.emplace(contact::surface_for_moving(
      report::display_mesh(product.mesh, none, kMostShownTriangles).mesh, kMostShownTriangles));
  sink_.bytes(product_frame(moving_footprint_->surface(), request.id), false);
  progress.update(0.2, "looking for ways to hold it");
  const grasp::RankedHolds& ranked = session->holds(progress);
  // The reference hand's skin has the same vertices in the same order.
  for (std::size_t k = 0; k < ranked.holds.size(); ++k) {
    const grasp::Grasp& grasp = ranked.holds[k].grasp;
    const std::vector<Vec3> skin = hand::pose_skin(session->reference(), grasp.posture);
    LiveField field;
    field.posture = grasp.posture;
    field.product_from_hand = grasp.product_from_hand;
    field.posed_skin = &skin;
    sink_.bytes(
        field_frame(field, {FrameKind::kPreview, request.id, static_cast<std::uint32_t>(k + 1)}),
        false);
  }
  sink_.text(opened_answer(request.id, *product_, *session, request.language));
  session_ = std::move(session);
}

void LiveWorker::move(const LiveRequest& request) {
  const contact::ContactResult& contact = session_->move(request.pose);
  LiveField field = field_of(request.pose, contact, session_->product());
  field.on_product = &moving_footprint_->under(session_->hand(), contact);
  sink_.bytes(field_frame(field, {FrameKind::kMoving, request.id, 0}), true);
}

void LiveWorker::work(const LiveRequest& asked, const Progress& progress) {
  LiveRequest request = asked;
  request.task = workflow::task_of_person(asked.task, opened_.person);
  const grasp::Grip grip = request.grip.value_or(grasp::Grip::kMediumWrap);
  switch (request.verb) {
    case LiveVerb::kHold:
      return send_result(request, session_->take_hold(request.number, request.task, progress));
    case LiveVerb::kClose:
      return send_result(request,
                         session_->close_here(request.pose, request.grip, request.task, progress));
    case LiveVerb::kRest:
      return send_result(request, session_->rest_here(request.pose, grip, request.task, progress));
    default:
      return send_result(request,
                         session_->evaluate_here(request.pose, grip, request.task, progress));
  }
}

void LiveWorker::send_result(const LiveRequest& request, study::AssessmentSet set) {
  set.command_line = command_of(request, opened_, *product_, own_hand_);
  const study::Assessment& assessment = set.assessments.front().assessment;
  LiveField field = field_of({assessment.grasp.posture, assessment.grasp.product_from_hand},
                             assessment.contact, session_->product());
  field.posed_skin = &assessment.posed_skin;
  // The words last: with them the client has everything.
  sink_.bytes(field_frame(field, {FrameKind::kAtRest, request.id, 0}), false);
  sink_.bytes(footprint_frame(assessment.footprint, request.id), false);
  sink_.text(result_answer(request, set, opened_.language));
}

}  // namespace palmar::server
