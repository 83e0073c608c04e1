// SPDX-License-Identifier: Apache-2.0
#include "launch/watch/prometheus_endpoint.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <limits>
#include <optional>

#include "common/base/error.h"

namespace shoal::launch {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// A TCP socket on 127.0.0.1, at a port of the system's choice when `port` is 0.
struct Socket {
  explicit Socket(uint16_t port = 0) : fd(socket(AF_INET, SOCK_STREAM, 0)) {
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  }
  ~Socket() { close(fd); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  uint16_t Bind() {
    EXPECT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    EXPECT_EQ(listen(fd, 1), 0);
    socklen_t size = sizeof(address);
    getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.sin_port);
  }

  const int fd;
  sockaddr_in address{};
};

uint16_t FreePort() { return Socket().Bind(); }

std::string Get(uint16_t port, const std::string& path) {
  Socket client(port);
  EXPECT_EQ(
      connect(client.fd, reinterpret_cast<sockaddr*>(&client.address), sizeof(client.address)), 0);
  const std::string request = "GET " + path + " HTTP/1.0\r\n\r\n";
  EXPECT_EQ(write(client.fd, request.data(), request.size()), static_cast<ssize_t>(request.size()));
  std::string answer;
  char buffer[4096];
  for (ssize_t n = 0; (n = read(client.fd, buffer, sizeof(buffer))) > 0;) answer.append(buffer, n);
  return answer;
}

RunViewMessage View() {
  RunViewMessage view;
  view.run = "reach";
  view.env_steps = 1200;
  view.updates = 30;
  MetricsMessage actor;
  actor.role = "actor";
  actor.id = 3;
  actor.host = "box";
  actor.state = "running";
  actor.names = {"resends", "share_physics", "rollout_return"};
  actor.values = {4, 0.25, std::numeric_limits<double>::quiet_NaN()};
  MetricsMessage replay = actor;
  replay.role = "replay";
  replay.id = 0;
  replay.state = "silent";
  replay.names = {"policy_lag_p90"};
  replay.values = {17};
  view.processes = {actor, replay};
  return view;
}

std::string Refusal(const std::string& where, int exit_code) {
  try {
    const PrometheusEndpoint endpoint(where);
    return "listens";
  } catch (const Error& e) {
    EXPECT_EQ(e.exit_code(), exit_code) << e.what();
    return e.what();
  }
}

TEST(PrometheusEndpoint, ShowsEveryFigureWithRunRoleIdAndHost) {
  const uint16_t port = FreePort();
  PrometheusEndpoint endpoint(std::to_string(port));
  EXPECT_EQ(endpoint.Url(), fmt::format("http://127.0.0.1:{}/metrics", port));
  endpoint.Update(View());
  const std::string page = Get(port, "/metrics");
  EXPECT_THAT(page, HasSubstr("200 OK"));
  const std::string actor = R"({run="reach",role="actor",id="3",host="box"})";
  EXPECT_THAT(page, HasSubstr("# TYPE shoal_resends counter"));
  EXPECT_THAT(page, HasSubstr("shoal_resends" + actor + " 4"));
  EXPECT_THAT(page, HasSubstr("# TYPE shoal_share_physics gauge"));
  EXPECT_THAT(page, HasSubstr("shoal_share_physics" + actor + " 0.25"));
  EXPECT_THAT(page, HasSubstr("shoal_process_up" + actor + " 1"));
  EXPECT_THAT(page,
              HasSubstr(R"(shoal_process_up{run="reach",role="replay",id="0",host="box"} 0)"));
  EXPECT_THAT(page, HasSubstr("# HELP shoal_policy_lag_p90 policy lag p90: updates from the "
                              "weights that chose an action"));
  EXPECT_THAT(page, HasSubstr(R"(shoal_run_env_steps{run="reach"} 1200)"));
  EXPECT_THAT(page, Not(HasSubstr("rollout_return"))) << "not a number yet";
}

TEST(PrometheusEndpoint, ATakenPortIsNamed) {
  Socket taken;
  const uint16_t port = taken.Bind();
  EXPECT_THAT(Refusal(std::to_string(port), 1),
              HasSubstr(fmt::format("127.0.0.1:{}: Address already in use", port)));
}

TEST(PrometheusEndpoint, OtherFormsAndForeignAddressesAreRefused) {
  for (const char* where :
       {"", "x", "0", "65536", "9464x", "localhost:9464", ":9464", "1.2.3:9464"}) {
    EXPECT_THAT(Refusal(where, 2), HasSubstr("expected PORT")) << where;
  }
  EXPECT_THAT(Refusal("192.0.2.1:9464", 1), HasSubstr("192.0.2.1:9464"));
}

}  // namespace
}  // namespace shoal::launch
