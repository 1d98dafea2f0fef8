#include "app/commands/console_service.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "tests/app/net/raw_http.hpp"
#include "tests/app/net/socket_client.hpp"

namespace lodestar {
namespace {

using ::testing::StartsWith;

/// Wider than a JPEG may be, so that its coder throws.
Frame unusable_frame() {
  return {.stamp = Stamp{} + std::chrono::seconds(1), .gray = cv::Mat(1, 70'000, CV_8UC1, cv::Scalar(0))};
}

TEST(ConsoleService, an_exception_in_a_turn_does_not_end_the_program) {
  LiveLink link;
  ConsoleService service(
      {.site = std::filesystem::path(LODESTAR_SOURCE_DIR) / "sites/lab", .live = {.camera_period = {}}},
      &link);
  const ConsoleThread thread(service);
  SocketClient viewer(service.port());
  ASSERT_THAT(viewer.upgrade("lodestar.v1"), StartsWith("HTTP/1.1 101"));
  viewer.send(R"({"type": "camera", "on": true})");
  viewer.send(R"({"type": "hold"})");
  while (viewer.receive().value_or("refused").find("refused") == std::string::npos)
    continue;  // it has read both
  for (int i = 0; i < 2; ++i) {
    while (!link.wants_state()) std::this_thread::yield();
    link.publish({.frame = unusable_frame()});
  }
  while (!link.wants_state()) std::this_thread::yield();  // it has taken both, and lives
  const std::string request =
      "GET /api/site HTTP/1.1\r\nConnection: close\r\nHost: 127.0.0.1:" + std::to_string(service.port()) +
      "\r\n\r\n";
  EXPECT_THAT(exchange(service.port(), request, std::chrono::seconds(10)).bytes, StartsWith("HTTP/1.1 200"));
}

}  // namespace
}  // namespace lodestar
