// SPDX-License-Identifier: Apache-2.0
// The real server with clients of every kind, on loopback.
#include "launch/tools/web/web_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <fstream>
#include <random>
#include <vector>

#include "common/base/clock.h"
#include "tests/support/error_message.h"
#include "tests/support/page_client.h"
#include "tests/support/temporary_folder.h"

namespace shoal::launch {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class WebServerTest : public ::testing::Test {
 protected:
  WebServerTest() {
    signal(SIGPIPE, SIG_IGN);
    Write("runs/reach/config.json", "{}");
    Write("runs/reach/report.html", "<p>report</p>");
    Write("runs/reach/videos/best.mp4", "0123456789");
    Write("secret.mp4", "secret");
  }
  void Write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder_.path() / file).parent_path());
    std::ofstream(folder_.path() / file) << text;
  }
  WebOptions Options(const std::string& address = "127.0.0.1", uint16_t port = 0) const {
    return {.run = "",
            .run_dir = (folder_.path() / "runs").string(),
            .secure = "",
            .listen = {.address = address, .port = port}};
  }
  // A request with the headers' lines in `more`.
  static std::string Request(const std::string& line, const std::string& more = "") {
    return line + " HTTP/1.1\r\nHost: 127.0.0.1\r\n" + more + "\r\n";
  }
  static void ExpectAlive(const WebServer& server) {
    EXPECT_THAT(AskPage(server.port(), Request("GET /api/runs")), StartsWith("HTTP/1.1 200"));
  }

  const TemporaryFolder folder_;
};

TEST_F(WebServerTest, ShowsThePageAndTheRuns) {
  const WebServer server(Options());
  const std::string page = AskPage(server.port(), Request("GET /"));
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(page, HasSubstr("<title>Shoal</title>"));
  EXPECT_THAT(page, HasSubstr("Content-Security-Policy: default-src 'none'; script-src 'self';"));
  EXPECT_THAT(page, HasSubstr("X-Content-Type-Options: nosniff"));
  const std::string runs = AskPage(server.port(), Request("GET /api/runs"));
  EXPECT_THAT(runs, HasSubstr(R"("name": "reach")"));
  EXPECT_THAT(AskPage(server.port(), Request("GET /api/runs/reach/curves")), HasSubstr("charts"));
  EXPECT_THAT(AskPage(server.port(), Request("GET /api/runs/reach")), HasSubstr("videos/best.mp4"));
}

TEST_F(WebServerTest, WhatIsNotThereIsSaidInOneLine) {
  const WebServer server(Options());
  for (const char* path : {"/none", "/api/runs/none", "/api/runs/..", "/api/runs/%2e%2e/curves",
                           "/files/reach/config.json", "/files/reach/videos/none.mp4",
                           "/files/reach/..%2f..%2fsecret.mp4", "/files/reach/../../secret.mp4",
                           "/files/reach/videos/..%2f..%2f..%2fsecret.mp4", "/episode/reach",
                           "/api/runs/reach/order"}) {
    const std::string answer = AskPage(server.port(), Request(std::string("GET ") + path));
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 404")) << path;
    EXPECT_THAT(answer, HasSubstr(R"({"error":"there is no )")) << path;
    EXPECT_THAT(answer, Not(HasSubstr("secret"))) << path;
  }
  EXPECT_THAT(AskPage(server.port(), Request("GET /api/runs/reach/top")),
              AllOf(StartsWith("HTTP/1.1 409"), HasSubstr("is not running")));
}

TEST_F(WebServerTest, FilesComeWholeAndInParts) {
  const WebServer server(Options());
  const std::string film = "GET /files/reach/videos/best.mp4";
  const std::string whole = AskPage(server.port(), Request(film));
  EXPECT_THAT(whole, AllOf(StartsWith("HTTP/1.1 200"), HasSubstr("Content-Type: video/mp4"),
                           HasSubstr("Content-Length: 10\r\n"), HasSubstr("sandbox"),
                           ::testing::EndsWith("\r\n\r\n0123456789")));
  const std::string part = AskPage(server.port(), Request(film, "Range: bytes=3-5\r\n"));
  EXPECT_THAT(part, AllOf(StartsWith("HTTP/1.1 206"), HasSubstr("Content-Range: bytes 3-5/10"),
                          HasSubstr("Content-Length: 3\r\n"), ::testing::EndsWith("\r\n\r\n345")));
  EXPECT_THAT(AskPage(server.port(), Request(film, "Range: bytes=10-\r\n")),
              StartsWith("HTTP/1.1 416"));
  std::string many = "Range: bytes=0-";
  for (int i = 0; i < 1000; ++i) many += ",0-";
  EXPECT_THAT(AskPage(server.port(), Request(film, many + "\r\n")),
              AllOf(StartsWith("HTTP/1.1 200"), ::testing::EndsWith("\r\n\r\n0123456789")));
}

TEST_F(WebServerTest, AnotherNameIsTurnedAway) {
  const WebServer server(Options());
  EXPECT_THAT(AskPage(server.port(), "GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n"),
              StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(AskPage(server.port(), "GET / HTTP/1.1\r\n\r\n"), StartsWith("HTTP/1.1 403"));
}

TEST_F(WebServerTest, SteeringTakesTheToken) {
  const WebServer server(Options());
  const std::string stop = "POST /api/runs/reach/order";
  const std::string body = R"({"verb": "stop", "arguments": []})";
  const auto order = [&](const std::string& headers) {
    return AskPage(
        server.port(),
        Request(stop, headers + "Content-Length: " + std::to_string(body.size()) + "\r\n") + body);
  };
  EXPECT_THAT(order(""), StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(order("X-Shoal-Token: 00000000000000000000000000000000\r\n"),
              StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(
      order("Cookie: shoal_token_" + std::to_string(server.port()) + "=" + server.token() + "\r\n"),
      StartsWith("HTTP/1.1 401"));
  const std::string token = "X-Shoal-Token: " + server.token() + "\r\n";
  EXPECT_THAT(order(token + "Origin: http://evil.example\r\n"), StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(order(token), AllOf(StartsWith("HTTP/1.1 409"), HasSubstr("is not running")));
  EXPECT_THAT(AskPage(server.port(), Request(stop, token + "Content-Length: 2\r\n") + "{}"),
              StartsWith("HTTP/1.1 400"));
  EXPECT_THAT(
      AskPage(server.port(),
              Request("POST /api/runs/reach/episode", token + "Content-Length: 2\r\n") + "{}"),
      AllOf(StartsWith("HTTP/1.1 409"), HasSubstr("has no checkpoint yet")));
  for (const char* method : {"PUT", "DELETE", "PATCH", "OPTIONS", "TRACE", "CONNECT"}) {
    EXPECT_THAT(AskPage(server.port(), Request(std::string(method) + " /api/runs/reach/order")),
                AnyOf(StartsWith("HTTP/1.1 401"), StartsWith("HTTP/1.1 400")))
        << method;
  }
}

// The request of a browser whose `ssh -L` listens at another port of another host's loopback.
TEST_F(WebServerTest, BehindAForwardedPortItIsLookedAtAndSteered) {
  const WebServer server(Options());
  const std::string token = "X-Shoal-Token: " + server.token() + "\r\n";
  const auto ask = [&](const std::string& line, const std::string& host, const std::string& more) {
    return AskPage(server.port(), line + " HTTP/1.1\r\nHost: " + host + "\r\n" + more);
  };
  const auto order = [&](const std::string& host, const std::string& origin) {
    return ask("POST /api/runs/reach/order", host,
               token + "Origin: " + origin + "\r\nContent-Length: 2\r\n\r\n{}");
  };
  for (const std::string host : {"127.0.0.1:18470", "localhost:18470"}) {
    EXPECT_THAT(ask("GET /?token=" + server.token(), host, "\r\n"), StartsWith("HTTP/1.1 200"));
    EXPECT_THAT(order(host, "http://" + host), StartsWith("HTTP/1.1 400")) << host;  // no verb
  }
  // A different page that is forwarded to the same computer is not trusted.
  EXPECT_THAT(order("127.0.0.1:18470", "http://127.0.0.1:18471"), StartsWith("HTTP/1.1 403"));
}

TEST_F(WebServerTest, AtAnotherAddressEverythingTakesTheToken) {
  // Every address of this host: not loopback alone, though a test reaches it there.
  const WebServer server(Options("0.0.0.0"));
  for (const char* path : {"/", "/page.js", "/api/runs", "/files/reach/report.html", "/none"}) {
    EXPECT_THAT(AskPage(server.port(), Request(std::string("GET ") + path)),
                AllOf(StartsWith("HTTP/1.1 401"), Not(HasSubstr("reach"))))
        << path;
  }
  const std::string page = AskPage(server.port(), Request("GET /?token=" + server.token()));
  EXPECT_THAT(page, StartsWith("HTTP/1.1 200"));
  const std::string cookie = "shoal_token_" + std::to_string(server.port()) + "=" + server.token();
  EXPECT_THAT(page, HasSubstr("Set-Cookie: " + cookie + "; HttpOnly; SameSite=Strict; Path=/"));
  EXPECT_THAT(AskPage(server.port(), Request("GET /page.js", "Cookie: " + cookie + "\r\n")),
              StartsWith("HTTP/1.1 200"));
  EXPECT_THAT(server.Url(), HasSubstr("/?token=" + server.token()));
}

TEST_F(WebServerTest, APortThatIsTakenAndAForeignAddressAreNamed) {
  const WebServer server(Options());
  EXPECT_THAT(
      ErrorMessage(1, [&] { WebServer(Options("127.0.0.1", server.port())); }),
      ::testing::StrEq("shoal web: cannot listen on 127.0.0.1:" + std::to_string(server.port()) +
                       ": Address already in use; choose another port"));
  EXPECT_THAT(ErrorMessage(1, [&] { WebServer(Options("192.0.2.1", 8470)); }),
              HasSubstr("192.0.2.1:8470: Cannot assign requested address; expected an address "
                        "of this host"));
}

TEST_F(WebServerTest, ARunThatDoesNotExistIsNamed) {
  WebOptions options = Options();
  options.run = "none";
  EXPECT_THAT(UsageMessage([&] { WebServer{options}; }), HasSubstr("none"));
}

TEST_F(WebServerTest, OneRunIsShownAlone) {
  Write("runs/other/config.json", "{}");
  WebOptions options = Options();
  options.run = "reach";
  const WebServer server(options);
  EXPECT_THAT(AskPage(server.port(), Request("GET /api/runs")),
              AllOf(HasSubstr("\"reach\""), Not(HasSubstr("other"))));
  EXPECT_THAT(AskPage(server.port(), Request("GET /api/runs/other")), StartsWith("HTTP/1.1 404"));
}

TEST_F(WebServerTest, LongRequestsEndAtTheirBounds) {
  const WebServer server(Options());
  const std::string token = "X-Shoal-Token: " + server.token() + "\r\n";
  // The server grants none of these requests and closes each connection.
  for (const std::string& request : {
           Request("GET /" + std::string(1'000'000, 'a')),
           Request("GET /", "X: " + std::string(1'000'000, 'a') + "\r\n"),
           Request("GET /",
                   [] {
                     std::string headers;
                     for (int i = 0; i < 100'000; ++i) headers += "X: y\r\n";
                     return headers;
                   }()),
           Request("POST /api/runs/reach/order", token + "Content-Length: 1000000\r\n") +
               std::string(1'000'000, '['),
           Request("POST /api/runs/reach/order", token + "Transfer-Encoding: chunked\r\n") +
               "fffff\r\n" + std::string(1'000'000, '['),
       }) {
    const PageConnection client(server.port());
    client.Send(request);
    EXPECT_THAT(client.Answer(), Not(HasSubstr("charts"))) << request.substr(0, 60);
  }
  EXPECT_THAT(
      AskPage(server.port(), Request("POST /api/runs/reach/order",
                                     token + "Content-Encoding: gzip\r\nContent-Length: 2\r\n") +
                                 "{}"),
      StartsWith("HTTP/1.1 415"));
  // The library reads ranges by a regular expression, which goes deeper with each digit.
  EXPECT_THAT(
      AskPage(server.port(), Request("GET /", "Range: bytes=" + std::string(8000, '0') + "-\r\n")),
      AnyOf(StartsWith("HTTP/1.1 200"), StartsWith("HTTP/1.1 416")));
  ExpectAlive(server);
}

TEST_F(WebServerTest, GarbageIsOutlived) {
  const WebServer server(Options());
  std::mt19937 random(7);
  const std::string model = Request("GET /files/reach/videos/best.mp4",
                                    "Range: bytes=1-2\r\nCookie: a=b\r\nContent-Length: 3\r\n") +
                            "abc";
  for (int i = 0; i < 300; ++i) {
    std::string request = model;
    const size_t changes = 1 + random() % 20;
    for (size_t k = 0; k < changes; ++k) {
      request[random() % request.size()] = static_cast<char>(random());
    }
    if (i % 3 == 0) request.resize(random() % request.size());
    const PageConnection client(server.port());
    client.Send(request);
    client.EndSending();
    client.Answer();
  }
  ExpectAlive(server);
}

TEST_F(WebServerTest, SlowClientsAreCutOffAndOthersAnswered) {
  const WebServer server(Options());
  // More than there are threads, each with a request that it never ends; and many that say nothing.
  std::vector<std::unique_ptr<PageConnection>> slow;
  for (int i = 0; i < 12; ++i) {
    slow.push_back(std::make_unique<PageConnection>(server.port()));
    slow.back()->Send("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-");
  }
  for (int i = 0; i < 60; ++i) slow.push_back(std::make_unique<PageConnection>(server.port()));
  // The server closes all connections by itself within the duration of two rounds.
  for (const auto& client : slow) {
    EXPECT_THAT(client->Answer(), AnyOf(::testing::IsEmpty(), StartsWith("HTTP/1.1 400")));
  }
  ExpectAlive(server);
}

TEST_F(WebServerTest, EndsAtOnceWhoeverIsConnected) {
  std::vector<std::unique_ptr<PageConnection>> slow;
  auto server = std::make_unique<WebServer>(Options());
  for (int i = 0; i < 10; ++i) {
    slow.push_back(std::make_unique<PageConnection>(server->port()));
    slow.back()->Send("GET /");
  }
  const SteadyTime start = Now();
  server.reset();
  EXPECT_LT(SecondsSince(start), 3) << "less than a request may take";
}

}  // namespace
}  // namespace shoal::launch
