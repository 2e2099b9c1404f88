// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "palmar/server/service.h"

namespace palmar::server {

struct HttpServerOptions {
  std::string address = "127.0.0.1";  ///< to listen on
  unsigned short port = 0;            ///< 0: one that is free
  bool stops_on_signals = false;      ///< SIGINT and SIGTERM end run()
  int header_seconds = 15;            ///< for the head of a request to come in
  int body_seconds = 300;             ///< for its body, and for a client to take an answer
  int most_connections = 64;
  int most_live = 8;  ///< sessions on the live channel; each has a hand and a thread
};

/// HTTP/1.1 and WebSocket (RFC 9112, 6455) on one thread for all connections; what takes time runs
/// on others: a small pool for requests, one thread for each live session. So a client that is
/// slow, or asks for much, holds up no other one. Frames that a client is too slow to take are left
/// out, the newest is sent. Heads are limited to 16 kB, bodies by Service::largest_body(), messages
/// on the live channel to kLongestLiveMessage.
class HttpServer {
 public:
  /// Listens at once. Throws InputError if the address or port can't be had.
  HttpServer(std::shared_ptr<Service> service, const HttpServerOptions& options);
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;
  ~HttpServer();

  ServedAt place() const;
  void run();   ///< until stop(); ends what is being computed
  void stop();  ///< from any thread

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palmar::server
