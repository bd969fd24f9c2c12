#include "workbench/live/monitor.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include "workbench/live/descriptor.hpp"

namespace waymark::live {
namespace {

Descriptor connect_to(const char* port) {
  auto connection = open_for_reading(parse_address(std::string("tcp://127.0.0.1:") + port, 115200).value());
  EXPECT_TRUE(connection.ok());
  return *std::move(connection);
}

void ask(const Descriptor& connection, const std::string& request) {
  ASSERT_GT(send(connection.get(), request.data(), request.size(), MSG_NOSIGNAL), 0);
}

/// What comes until the text does, or the connection ends, or five seconds have passed.
std::string read_until(const Descriptor& connection, const std::string& text) {
  std::string all;
  std::array<char, 4096> buffer{};
  while (all.find(text) == std::string::npos) {
    pollfd ready{connection.get(), POLLIN, 0};
    if (poll(&ready, 1, 5000) <= 0) break;
    const auto count = read(connection.get(), buffer.data(), buffer.size());
    if (count <= 0) break;
    all.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return all;
}

std::string get(const char* port, const std::string& path, const std::string& headers = "") {
  const Descriptor connection = connect_to(port);
  ask(connection, "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + headers + "\r\n");
  return read_until(connection, "never");
}

std::string press(const char* port, const std::string& button, const std::string& headers) {
  const Descriptor connection = connect_to(port);
  ask(connection,
      "POST /do/" + button + " HTTP/1.1\r\nHost: localhost\r\nContent-Length: 0\r\n" + headers + "\r\n");
  return read_until(connection, "never");
}

TEST(Monitor, ServesItsPageAndWhatCameBefore) {
  const auto monitor = Monitor::start("127.0.0.1:47021", "<p>the page</p>").value();
  monitor->show_past(R"({"trail":[[1,2]]})");
  EXPECT_EQ(monitor->url(), "http://127.0.0.1:47021/");
  EXPECT_NE(get("47021", "/").find("<p>the page</p>"), std::string::npos);
  EXPECT_NE(get("47021", "/past").find("[[1,2]]"), std::string::npos);
  EXPECT_NE(get("47021", "/image").find("404"), std::string::npos);
  EXPECT_NE(get("47021", "/etc/passwd").find("404"), std::string::npos);
  monitor->show_image(std::make_shared<const std::string>("\xff\xd8 image"));
  EXPECT_NE(get("47021", "/image").find("image/jpeg"), std::string::npos);
}

TEST(Monitor, TellsViewersWhatChanges) {
  const auto monitor = Monitor::start("127.0.0.1:47022", "").value();
  EXPECT_FALSE(monitor->is_watched());
  const Descriptor viewer = connect_to("47022");
  ask(viewer, "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(read_until(viewer, "text/event-stream").find("200"), std::string::npos);
  for (int i = 0; i < 500 && !monitor->is_watched(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  EXPECT_TRUE(monitor->is_watched());
  monitor->show(R"({"light":"good"})");
  EXPECT_NE(read_until(viewer, "good").find("data: {\"light\":\"good\"}\n\n"), std::string::npos);
}

TEST(Monitor, IsHeldUpByNoViewerThatDoesNotRead) {
  const auto monitor = Monitor::start("127.0.0.1:47023", "").value();
  const Descriptor stalled = connect_to("47023"), reads = connect_to("47023");
  for (const Descriptor* viewer : {&stalled, &reads})
    ask(*viewer, "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n");
  EXPECT_NE(read_until(reads, "event-stream"), "");
  const std::string large(1'000'000, 'x');
  for (int i = 0; i < 20; ++i) {
    const auto before = std::chrono::steady_clock::now();
    monitor->show("state" + std::to_string(i) + large);
    EXPECT_LT(std::chrono::steady_clock::now() - before, std::chrono::seconds(1));
    EXPECT_NE(read_until(reads, "state" + std::to_string(i)), "");
  }
}

TEST(Monitor, PressesButtonsForNoOtherPage) {
  const auto monitor = Monitor::start("127.0.0.1:47024", "").value();
  EXPECT_NE(press("47024", "mark", "").find("403"), std::string::npos);
  EXPECT_NE(get("47024", "/do/mark", "X-Waymark: 1\r\n").find("403"), std::string::npos);
  EXPECT_TRUE(monitor->take_commands().empty());
  EXPECT_NE(press("47024", "mark", "X-Waymark: 1\r\n").find("200"), std::string::npos);
  EXPECT_NE(press("47024", "stop", "X-Waymark: 1\r\n").find("200"), std::string::npos);
  EXPECT_NE(press("47024", "fly", "X-Waymark: 1\r\n").find("404"), std::string::npos);
  EXPECT_EQ(monitor->take_commands(), (std::vector{MonitorCommand::kMark, MonitorCommand::kStop}));
  EXPECT_TRUE(monitor->take_commands().empty());
}

TEST(Monitor, AsksForATokenWhereOthersCanReachIt) {
  const auto monitor = Monitor::start("0.0.0.0:47025", "<p>the page</p>").value();
  const std::size_t mark = monitor->url().find("token=");
  ASSERT_NE(mark, std::string::npos);
  const std::string token = monitor->url().substr(mark + 6);
  EXPECT_EQ(token.size(), 32U);
  EXPECT_NE(get("47025", "/").find("403"), std::string::npos);
  EXPECT_NE(get("47025", "/?token=" + std::string(32, '0')).find("403"), std::string::npos);
  const std::string page = get("47025", "/?token=" + token);
  EXPECT_NE(page.find("<p>the page</p>"), std::string::npos);
  EXPECT_NE(page.find("HttpOnly"), std::string::npos);
  EXPECT_NE(get("47025", "/past", "Cookie: waymark=" + token + "\r\n").find("200"), std::string::npos);
  EXPECT_NE(press("47025", "mark", "X-Waymark: 1\r\n").find("403"), std::string::npos);
}

TEST(Monitor, SaysWhereItCannotBe) {
  EXPECT_FALSE(Monitor::start("8080", "").ok());
  EXPECT_FALSE(Monitor::start("127.0.0.1:http", "").ok());
  const auto first = Monitor::start("127.0.0.1:47026", "");
  ASSERT_TRUE(first.ok());
  const auto second = Monitor::start("127.0.0.1:47026", "");
  ASSERT_FALSE(second.ok());
  EXPECT_NE(second.error().message.find("127.0.0.1:47026"), std::string::npos);
}

}  // namespace
}  // namespace waymark::live
