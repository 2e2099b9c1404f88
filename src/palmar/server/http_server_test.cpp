// Copyright the Palmar authors.
// SPDX-License-Identifier: Apache-2.0
#include "palmar/server/http_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <chrono>
#include <random>
#include <thread>

#include "palmar/core/error.h"

namespace palmar::server {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// A client that says what it likes.
class RawClient {
 public:
  explicit RawClient(unsigned port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<std::uint16_t>(port));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    timeval limit{20, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to), 0);
  }
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;
  ~RawClient() { ::close(socket_); }

  void say(const std::string& bytes) {
    std::size_t at = 0;
    while (at < bytes.size()) {
      const ssize_t sent = ::send(socket_, bytes.data() + at, bytes.size() - at, MSG_NOSIGNAL);
      if (sent <= 0) return;  // it doesn't listen any more
      at += static_cast<std::size_t>(sent);
    }
  }
  /// What comes until `end` was in it, or until the server closes.
  std::string hear(const std::string& end = "\r\n\r\n") {
    std::string heard;
    std::array<char, 4096> piece{};
    while (heard.find(end) == std::string::npos) {
      const ssize_t got = ::recv(socket_, piece.data(), piece.size(), 0);
      if (got <= 0) break;
      heard.append(piece.data(), static_cast<std::size_t>(got));
    }
    return heard;
  }
  std::string hear_all() { return hear(std::string("\0never", 6)); }

 private:
  int socket_;
};

/// A server in a thread.
class RunningServer {
 public:
  explicit RunningServer(HttpServerOptions options = {})
      : service_(std::make_shared<Service>("secret", std::make_shared<ProductShelf>())),
        server_(service_, options),
        thread_([this] { server_.run(); }) {}
  RunningServer(const RunningServer&) = delete;
  RunningServer& operator=(const RunningServer&) = delete;
  ~RunningServer() {
    server_.stop();
    thread_.join();
  }
  unsigned port() const { return server_.place().port; }
  std::string host() const { return "127.0.0.1:" + std::to_string(port()); }
  std::string request(const std::string& line, const std::string& more = "") const {
    return line + " HTTP/1.1\r\nHost: " + host() + "\r\n" + more + "\r\n";
  }
  std::string upgrade(const std::string& token = "secret", const std::string& more = "") const {
    return request("GET /api/live?token=" + token,
                   "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
                   "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                       more);
  }

 private:
  std::shared_ptr<Service> service_;
  HttpServer server_;
  std::thread thread_;
};

std::string answer_to(const RunningServer& server, const std::string& bytes) {
  RawClient client(server.port());
  client.say(bytes);
  return client.hear();
}

/// A text frame as clients send it, masked with 0 (RFC 6455, 5.2).
std::string text_frame(const std::string& text, unsigned char first = 0x81) {
  std::string frame(1, static_cast<char>(first));
  if (text.size() < 126) {
    frame += static_cast<char>(0x80U | text.size());
  } else {
    frame += static_cast<char>(0x80U | 127U);
    for (int shift = 56; shift >= 0; shift -= 8) {
      frame += static_cast<char>(static_cast<std::uint64_t>(text.size()) >> shift & 0xffU);
    }
  }
  return frame + std::string(4, '\0') + text;
}

TEST(HttpServer, AnswersWithHeadersThatKeepPagesOut) {
  const RunningServer server;
  const std::string answer = answer_to(server, server.request("GET /"));
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(answer, HasSubstr("Content-Security-Policy: default-src 'none'"));
  EXPECT_THAT(answer, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(answer, HasSubstr("Referrer-Policy: no-referrer"));
}

TEST(HttpServer, RefusesWhoHasNoBusinessHere) {
  const RunningServer server;
  const std::string state = "GET /api/state";
  EXPECT_THAT(answer_to(server, server.request(state)), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(answer_to(server, server.request(state + "?token=secret")),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(
      answer_to(server, server.request(state + "?token=secret", "Origin: http://evil.example\r\n")),
      StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer_to(server, state + "?token=secret HTTP/1.1\r\nHost: evil.example\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(answer_to(server, server.request("GET /../../etc/passwd")),
              StartsWith("HTTP/1.1 404"));
}

TEST(HttpServer, LiveChannelNeedsTokenAndOrigin) {
  const RunningServer server;
  EXPECT_THAT(answer_to(server, server.upgrade()), StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(answer_to(server, server.upgrade("guess")), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(answer_to(server, server.upgrade("secret", "Origin: http://evil.example\r\n")),
              StartsWith("HTTP/1.1 403"));
}

TEST(HttpServer, LimitsHeadsAndBodies) {
  const RunningServer server;
  const std::string long_head =
      server.request("GET /", "X-Long: " + std::string(20000, 'a') + "\r\n");
  EXPECT_THAT(answer_to(server, long_head), StartsWith("HTTP/1.1 431"));
  EXPECT_THAT(answer_to(server, server.request("POST /api/examples?token=secret&name=ball",
                                               "Content-Length: 2000000\r\n")),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(answer_to(server, server.request("POST /api/products?token=secret&name=a.stl",
                                               "Content-Length: 99999999999\r\n")),
              StartsWith("HTTP/1.1 413"));
  EXPECT_THAT(answer_to(server, server.request("POST /api/products?name=a.stl",
                                               "Content-Length: 100000000\r\n")),
              StartsWith("HTTP/1.1 401"))
      << "refused before the body is read";
}

TEST(HttpServer, DamagedRequestsEndTheirConnectionAlone) {
  const RunningServer server;
  std::mt19937 random(7);
  const std::string good = server.request("GET /api/state?token=secret", "Accept: */*\r\n");
  for (int round = 0; round < 200; ++round) {
    std::string bytes = good;
    for (int k = 0; k < 3; ++k) {
      bytes[random() % bytes.size()] = static_cast<char>(random() % 256U);
    }
    RawClient client(server.port());
    client.say(bytes);
    // Not waited for: a damaged head may be one that isn't finished.
  }
  EXPECT_THAT(answer_to(server, good), StartsWith("HTTP/1.1 200"));
}

TEST(HttpServer, MalformedFramesAndMessagesDoNoHarm) {
  const RunningServer server;
  const std::vector<std::string> nonsense = {
      text_frame("no json"),
      text_frame("{\"do\":\"fly\",\"id\":1}"),
      text_frame(std::string(100000, 'a')),     // longer than is read
      text_frame("abc", 0x82),                  // bytes
      text_frame("\xff\xfe"),                   // no UTF-8
      text_frame("abc", 0xf1),                  // reserved bits
      text_frame("abc", 0x83),                  // no such opcode
      text_frame(std::string(200, 'p'), 0x89),  // a ping that is too long
      std::string("\x81\x05hello", 7),          // not masked
      std::string("\x81\xff\x7f\xff\xff\xff\xff\xff\xff\xff\0\0\0\0", 14),  // 2^63 bytes
  };
  for (const std::string& bytes : nonsense) {
    RawClient client(server.port());
    client.say(server.upgrade());
    ASSERT_THAT(client.hear(), StartsWith("HTTP/1.1 101"));
    client.say(bytes);
  }
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    RawClient client(server.port());
    client.say(server.upgrade());
    ASSERT_THAT(client.hear(), StartsWith("HTTP/1.1 101")) << round;
    std::string bytes(1 + random() % 60U, '\0');
    for (char& c : bytes) c = static_cast<char>(random() % 256U);
    client.say(bytes);
  }
  RawClient client(server.port());
  client.say(server.upgrade());
  ASSERT_THAT(client.hear(), StartsWith("HTTP/1.1 101"));
  client.say(text_frame("{\"do\":\"fly\",\"id\":1}"));
  EXPECT_THAT(client.hear("\"code\":2"), HasSubstr("open, hold, close, rest, evaluate or move"));
}

TEST(HttpServer, SlowClientHoldsUpNoOther) {
  HttpServerOptions options;
  options.header_seconds = 1;
  const RunningServer server(options);
  RawClient slow(server.port());
  slow.say("GET / HTTP/1.1\r\nHost: ");
  const auto start = std::chrono::steady_clock::now();
  for (int k = 0; k < 5; ++k) {
    EXPECT_THAT(answer_to(server, server.request("GET /")), StartsWith("HTTP/1.1 200"));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(900));
  slow.hear_all();  // closed when its time is over
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(8));
}

TEST(HttpServer, TwoClientsHaveSessionsOfTheirOwn) {
  const RunningServer server;
  RawClient one(server.port()), other(server.port());
  for (RawClient* client : {&one, &other}) {
    client->say(server.upgrade());
    ASSERT_THAT(client->hear(), StartsWith("HTTP/1.1 101"));
  }
  one.say(text_frame(R"({"do":"hold","id":11,"number":1})"));
  other.say(text_frame(R"({"do":"hold","id":12,"number":1})"));
  EXPECT_THAT(one.hear("}"), HasSubstr("\"request\":11"));
  EXPECT_THAT(other.hear("}"), HasSubstr("\"request\":12"));
}

TEST(HttpServer, OpensNoMoreSessionsThanItMay) {
  HttpServerOptions options;
  options.most_live = 1;
  const RunningServer server(options);
  RawClient first(server.port());
  first.say(server.upgrade());
  ASSERT_THAT(first.hear(), StartsWith("HTTP/1.1 101"));
  EXPECT_THAT(answer_to(server, server.upgrade()), StartsWith("HTTP/1.1 503"));
}

TEST(HttpServer, PortsThatAreTakenAreNamed) {
  const RunningServer server;
  HttpServerOptions options;
  options.port = static_cast<unsigned short>(server.port());
  const auto service = std::make_shared<Service>("x", std::make_shared<ProductShelf>());
  try {
    const HttpServer second(service, options);
    FAIL() << "listens twice";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("can't listen on 127.0.0.1:" + std::to_string(server.port())));
  }
}

TEST(HttpServer, StopsAtOnce) {
  const auto start = std::chrono::steady_clock::now();
  {
    const RunningServer server;
    RawClient idle(server.port());
    RawClient live(server.port());
    live.say(server.upgrade());
    ASSERT_THAT(live.hear(), StartsWith("HTTP/1.1 101"));
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(1));
}

}  // namespace
}  // namespace palmar::server
