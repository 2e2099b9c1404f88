// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/http_server.h"

#include <atomic>
#include <boost/asio/bind_executor.hpp>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

#include "palmar/core/error.h"
#include "palmar/server/live_answer.h"
#include "palmar/server/live_request.h"
#include "palmar/server/live_worker.h"

namespace palmar::server {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using Tcp = asio::ip::tcp;
using ErrorCode = beast::error_code;

constexpr std::uint32_t kLongestHead = 16U << 10U;
constexpr int kMostTextsWaiting = 200;  // a client that takes none of them is gone
constexpr int kLiveHandshakeSeconds = 10;
constexpr int kLiveIdleSeconds = 60;  // then it is asked whether it is there

constexpr const char* kClientPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data: blob:; "
    "connect-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors "
    "'none'";

class LiveConnection;

/// What connections share.
struct Shared {
  std::shared_ptr<Service> service;
  HttpServerOptions options;
  asio::thread_pool* pool = nullptr;
  std::atomic<bool> is_stopping{false};
  std::atomic<int> connections{0};
  std::atomic<int> live{0};
  std::vector<std::weak_ptr<LiveConnection>> sessions;  ///< on the I/O thread
};

/// Counts one more as long as it lives.
class Counted {
 public:
  explicit Counted(std::atomic<int>& count) : count_(&count) { ++*count_; }
  Counted(const Counted&) = delete;
  Counted& operator=(const Counted&) = delete;
  ~Counted() { --*count_; }

 private:
  std::atomic<int>* count_;
};

std::string text_of(beast::string_view text) { return {text.data(), text.size()}; }

template <typename Body>
ServiceRequest head_of(const http::request<Body>& request) {
  ServiceRequest head;
  head.method = text_of(request.method_string());
  head.target = text_of(request.target());
  head.host = text_of(request[http::field::host]);
  head.origin = text_of(request[http::field::origin]);
  head.authorization = text_of(request[http::field::authorization]);
  return head;
}

http::response<http::string_body> response_of(ServiceAnswer answer, bool keeps_alive,
                                              bool is_head) {
  http::response<http::string_body> response;
  response.version(11);
  response.result(static_cast<unsigned>(answer.status));
  response.set(http::field::content_type, answer.type);
  response.set(http::field::cache_control, "no-store");
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.set("Content-Security-Policy", answer.policy.empty() ? kClientPolicy : answer.policy);
  if (!answer.file_name.empty()) {
    std::string name;
    for (const char c : answer.file_name) {
      const bool is_plain = c >= ' ' && c < 0x7f && c != '"' && c != '\\';
      name += is_plain ? c : '_';
    }
    response.set(http::field::content_disposition, "attachment; filename=\"" + name + "\"");
  }
  response.keep_alive(keeps_alive);
  response.body() = std::move(answer.body);
  response.prepare_payload();
  if (is_head) response.body().clear();
  return response;
}

/// One client on the live channel.
class LiveConnection : public std::enable_shared_from_this<LiveConnection> {
 public:
  LiveConnection(Tcp::socket&& socket, std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)), counted_(shared_->live), stream_(std::move(socket)) {}

  void start(http::request<http::string_body> upgrade) {
    websocket::stream_base::timeout limits{};
    limits.handshake_timeout = std::chrono::seconds(kLiveHandshakeSeconds);
    limits.idle_timeout = std::chrono::seconds(kLiveIdleSeconds);
    limits.keep_alive_pings = true;
    stream_.set_option(limits);
    stream_.read_message_max(kLongestLiveMessage);
    stream_.auto_fragment(false);
    stream_.async_accept(upgrade, [self = shared_from_this()](ErrorCode error) {
      if (!error) self->begin();
    });
  }

  /// Once nothing runs on the I/O thread any more: nothing is computed, nothing will be sent.
  void ask_to_stop() {
    if (worker_) worker_->stop();
  }
  void finish() { worker_.reset(); }

 private:
  struct Message {
    std::string bytes;
    bool is_text = false;
    bool is_newest_only = false;
  };

  void begin() {
    // The worker's thread may outlive the connection by what it is computing: its answers then go
    // nowhere.
    const std::weak_ptr<LiveConnection> weak = weak_from_this();
    const auto executor = stream_.get_executor();
    const auto send = [weak, executor](Message message) {
      asio::post(executor, [weak, message = std::move(message)]() mutable {
        if (const auto self = weak.lock()) self->send(std::move(message));
      });
    };
    worker_ = std::make_shared<LiveWorker>(
        shared_->service->shelf(), LiveSink{[send](std::string json) {
                                              send({std::move(json), true, false});
                                            },
                                            [send](std::string bytes, bool is_newest_only) {
                                              send({std::move(bytes), false, is_newest_only});
                                            }});
    std::erase_if(shared_->sessions, [](const auto& one) { return one.expired(); });
    shared_->sessions.push_back(weak);
    read();
  }

  void read() {
    stream_.async_read(buffer_, [self = shared_from_this()](ErrorCode error, std::size_t) {
      if (error) return self->end();
      self->take();
      self->read();
    });
  }

  void take() {
    const std::string message = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    try {
      if (!stream_.got_text()) throw UsageError("live request: bytes; text is required");
      worker_->post(parse_live_request(message));
    } catch (const std::exception& error) {
      send({error_answer(0, error.what(), 2), true, false});
    }
  }

  void send(Message message) {
    if (is_over_) return;
    if (message.is_newest_only && waiting_.size() > 1 && waiting_.back().is_newest_only) {
      waiting_.back() = std::move(message);  // the first is on its way
      return;
    }
    waiting_.push_back(std::move(message));
    if (waiting_.size() > kMostTextsWaiting) return end();
    if (waiting_.size() == 1) write();
  }

  void write() {
    stream_.text(waiting_.front().is_text);
    stream_.async_write(asio::buffer(waiting_.front().bytes),
                        [self = shared_from_this()](ErrorCode error, std::size_t) {
                          if (error) return self->end();
                          self->waiting_.pop_front();
                          if (!self->waiting_.empty()) self->write();
                        });
  }

  void end() {
    if (std::exchange(is_over_, true)) return;
    ErrorCode ignored;
    beast::get_lowest_layer(stream_).socket().close(ignored);
    if (worker_ == nullptr) return;
    worker_->stop();
    // Its thread is waited for elsewhere.
    asio::post(*shared_->pool, [worker = std::move(worker_)]() mutable { worker.reset(); });
  }

  std::shared_ptr<Shared> shared_;
  Counted counted_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  std::deque<Message> waiting_;
  std::shared_ptr<LiveWorker> worker_;
  bool is_over_ = false;
};

/// One connection: requests, one after the other.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Tcp::socket&& socket, std::shared_ptr<Shared> shared)
      : shared_(std::move(shared)), counted_(shared_->connections), stream_(std::move(socket)) {}

  void start() { read_head(); }

 private:
  void limit(int seconds) { stream_.expires_after(std::chrono::seconds(seconds)); }

  void read_head() {
    parser_.emplace();
    parser_->header_limit(kLongestHead);
    parser_->body_limit(kLargestUpload);
    limit(shared_->options.header_seconds);
    http::async_read_header(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](ErrorCode error, std::size_t) { self->take_head(error); });
  }

  void take_head(ErrorCode error) {
    if (error == http::error::end_of_stream || error == beast::error::timeout) return close();
    if (error) {
      const int status = error == http::error::header_limit ? 431
                         : error == http::error::body_limit ? 413
                                                            : 400;
      return respond(refusal(status, error.message()), false);
    }
    const auto& request = parser_->get();
    const ServiceRequest head = head_of(request);
    // Before anything of the body is read.
    if (auto refused = shared_->service->refused(head)) return respond(*refused, false);
    const std::uint64_t largest = shared_->service->largest_body(head);
    const auto announced = parser_->content_length();
    if (announced && *announced > largest) {
      return respond(
          refusal(413, "the body has " + std::to_string(*announced) + " bytes; at most " +
                           std::to_string(largest) + " are allowed"),
          false);
    }
    parser_->body_limit(largest);
    limit(shared_->options.body_seconds);
    http::async_read(
        stream_, buffer_, *parser_,
        [self = shared_from_this()](ErrorCode failed, std::size_t) { self->take_request(failed); });
  }

  void take_request(ErrorCode error) {
    if (error == http::error::body_limit) {
      return respond(refusal(413, "the body is larger than is allowed"), false);
    }
    if (error) return close();
    http::request<http::string_body> request = parser_->release();
    const bool keeps_alive = request.keep_alive();
    const bool is_live = parse_target(text_of(request.target())).path == "/api/live";
    if (is_live && websocket::is_upgrade(request)) {
      if (shared_->live >= shared_->options.most_live) {
        return respond(refusal(503, "too many sessions are open; close a tab"), false);
      }
      stream_.expires_never();
      std::make_shared<LiveConnection>(stream_.release_socket(), shared_)
          ->start(std::move(request));
      return;
    }
    is_head_ = request.method() == http::verb::head;
    ServiceRequest asked = head_of(request);
    if (is_head_) asked.method = "GET";
    asked.body = std::move(request.body());
    stream_.expires_never();  // until there is an answer
    asio::post(*shared_->pool,
               [self = shared_from_this(), asked = std::move(asked), keeps_alive]() mutable {
                 Progress progress;
                 progress.cancel = &self->shared_->is_stopping;
                 ServiceAnswer answer = self->shared_->service->answer(asked, progress);
                 const auto executor = self->stream_.get_executor();
                 // The connection goes back to the I/O thread, where it ends.
                 asio::post(executor, [self = std::move(self), answer = std::move(answer),
                                       keeps_alive] { self->respond(answer, keeps_alive); });
               });
  }

  void respond(const ServiceAnswer& answer, bool keeps_alive) {
    response_.emplace(response_of(answer, keeps_alive, is_head_));
    limit(shared_->options.body_seconds);
    http::async_write(stream_, *response_,
                      [self = shared_from_this(), keeps_alive](ErrorCode error, std::size_t) {
                        self->response_.reset();
                        self->is_head_ = false;
                        if (error || !keeps_alive) return self->close();
                        self->read_head();
                      });
  }

  void close() {
    ErrorCode ignored;
    stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
  }

  std::shared_ptr<Shared> shared_;
  Counted counted_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_{kLongestHead + 4096};
  std::optional<http::request_parser<http::string_body>> parser_;
  std::optional<http::response<http::string_body>> response_;
  bool is_head_ = false;
};

}  // namespace

struct HttpServer::Impl {
  asio::thread_pool pool{2};
  asio::io_context io{1};
  Tcp::acceptor acceptor{io};
  asio::signal_set signals{io};
  std::shared_ptr<Shared> shared = std::make_shared<Shared>();

  void accept() {
    acceptor.async_accept([this](ErrorCode error, Tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error && shared->connections < shared->options.most_connections) {
        ErrorCode ignored;
        socket.set_option(Tcp::no_delay(true), ignored);  // a frame's last bytes wait for nothing
        std::make_shared<Connection>(std::move(socket), shared)->start();
      }
      accept();
    });
  }
};

HttpServer::HttpServer(std::shared_ptr<Service> service, const HttpServerOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->shared->service = std::move(service);
  impl_->shared->options = options;
  impl_->shared->pool = &impl_->pool;
  try {
    const Tcp::endpoint endpoint(asio::ip::make_address(options.address), options.port);
    impl_->acceptor.open(endpoint.protocol());
    impl_->acceptor.set_option(asio::socket_base::reuse_address(true));
    impl_->acceptor.bind(endpoint);
    impl_->acceptor.listen();
  } catch (const boost::system::system_error& error) {
    throw InputError("can't listen on " + options.address + ":" + std::to_string(options.port) +
                     ": " + error.code().message());
  }
  impl_->shared->service->set_place(place());
  impl_->accept();
  if (options.stops_on_signals) {
    impl_->signals.add(SIGINT);
    impl_->signals.add(SIGTERM);
    impl_->signals.async_wait([this](ErrorCode error, int) {
      if (!error) stop();
    });
  }
}

HttpServer::~HttpServer() {
  stop();
  std::vector<std::shared_ptr<LiveConnection>> sessions;
  for (const auto& one : impl_->shared->sessions) {
    if (auto session = one.lock()) sessions.push_back(std::move(session));
  }
  for (const auto& session : sessions) session->ask_to_stop();
  for (const auto& session : sessions) session->finish();
  impl_->pool.join();
}

ServedAt HttpServer::place() const {
  return {impl_->shared->options.address, impl_->acceptor.local_endpoint().port()};
}

void HttpServer::run() { impl_->io.run(); }

void HttpServer::stop() {
  impl_->shared->is_stopping = true;
  impl_->io.stop();
}

}  // namespace palmar::server
