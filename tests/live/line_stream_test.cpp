#include "workbench/live/line_stream.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>

#include <gtest/gtest.h>

namespace waymark::live {
namespace {

using std::chrono::milliseconds;

/// Runs a stream on a thread and keeps what it brings.
class Running {
 public:
  explicit Running(Stream& stream)
      : thread_([this, &stream](const std::stop_token& stop) {
          stream.run(stop, clock_, [this](Arrival arrival) {
            const std::lock_guard lock(mutex_);
            arrivals_.push_back(std::move(arrival));
          });
        }) {}

  /// Waits for so many, at most ten seconds.
  std::vector<Arrival> wait_for(std::size_t count) {
    for (int i = 0; i < 1000; ++i) {
      {
        const std::lock_guard lock(mutex_);
        if (arrivals_.size() >= count) return arrivals_;
      }
      std::this_thread::sleep_for(milliseconds(10));
    }
    const std::lock_guard lock(mutex_);
    return arrivals_;
  }

  void join() { thread_.join(); }

 private:
  SessionClock clock_;
  std::mutex mutex_;
  std::vector<Arrival> arrivals_;
  std::jthread thread_;
};

void send(int fd, const std::string& text) {
  ASSERT_EQ(write(fd, text.data(), text.size()), static_cast<ssize_t>(text.size()));
}

/// The other end of a serial port.
class Terminal {
 public:
  Terminal() : fd_(posix_openpt(O_RDWR | O_NOCTTY)) {
    grantpt(fd_.get());
    unlockpt(fd_.get());
  }
  [[nodiscard]] int get() const { return fd_.get(); }
  [[nodiscard]] std::string path() const { return ptsname(fd_.get()); }

 private:
  Descriptor fd_;
};

TEST(LineStream, ReadsWheelsFromASerialPort) {
  const Terminal board;
  LineStream stream(parse_address(board.path(), 115200).value(), decode_wheel_lines(1000.0, 4));
  Running running(stream);
  while (stream.state().summary({}).received == 0) {  // the port discards what came before it was opened
    send(board.get(), to_string(WheelLine{1, 0, 0, 0}) + "\r\n");
    std::this_thread::sleep_for(milliseconds(20));
  }
  const auto before = running.wait_for(1).size();
  send(board.get(), to_string(WheelLine{5, 33, 250, -250}) + "\nE 6 66 500 -5garbage\n");
  send(board.get(), to_string(WheelLine{7, 99, 500, -500}) + "\n");
  const auto arrivals = running.wait_for(before + 2);
  ASSERT_EQ(arrivals.size(), before + 2);
  EXPECT_EQ(arrivals.back().event.stream.device, 4);
  EXPECT_NEAR(std::get<WheelAngles>(arrivals.back().event.content).left_rad, 3.14159265, 1e-6);
  EXPECT_EQ(stream.state().summary({}).bad, 1);
  EXPECT_GE(stream.state().summary({}).lost, 1);
}

TEST(LineStream, ReadsJsonFromDatagrams) {
  LineStream stream(parse_address("udp://127.0.0.1:47012", 0).value(), decode_json_lines(2));
  Running running(stream);
  const auto sender = open_udp_sender("127.0.0.1", "47012");
  ASSERT_TRUE(sender.ok());
  std::vector<Arrival> arrivals;
  for (int i = 0; i < 100 && arrivals.size() < 2; ++i) {  // until it listens
    static_cast<void>(write(sender->get(), R"({"v_mps":1,"w_radps":0})", 23));
    static_cast<void>(write(sender->get(), R"({"observations":[]})", 19));
    std::this_thread::sleep_for(milliseconds(20));
    arrivals = running.wait_for(stream.state().summary({}).received > 0 ? 2 : 0);
  }
  ASSERT_GE(arrivals.size(), 2U);
  for (const Arrival& each : arrivals)
    EXPECT_EQ(each.event.stream.device, std::holds_alternative<Velocity>(each.event.content) ? 2 : 3);
}

TEST(LineStream, EndsWithAFile) {
  const std::string path = testing::TempDir() + "/lines.json";
  const Descriptor file(open(path.c_str(), O_CREAT | O_TRUNC | O_WRONLY, 0600));
  send(file.get(), "{\"stamp_s\":1,\"w_radps\":0.5}\nnonsense\n{\"stamp_s\":2,\"w_radps\":0.5}\n");
  LineStream stream(parse_address(path, 0).value(), decode_json_lines(0));
  Running running(stream);
  running.join();
  EXPECT_EQ(running.wait_for(2).size(), 2U);
  EXPECT_TRUE(stream.state().has_ended());
  EXPECT_EQ(stream.state().summary({}).bad, 1);
}

TEST(LineStream, SaysWhyNothingComes) {
  LineStream stream(parse_address("/dev/waymark-is-not-there", 115200).value(), decode_wheel_lines(1.0, 0));
  Running running(stream);
  for (int i = 0; i < 500 && stream.state().summary({}).fault.empty(); ++i)
    std::this_thread::sleep_for(milliseconds(10));
  EXPECT_NE(stream.state().summary({}).fault.find("No such file"), std::string::npos);
  EXPECT_FALSE(stream.state().has_ended());
}

TEST(Address, NamesWhatIsWrong) {
  EXPECT_FALSE(parse_address("", 115200).ok());
  EXPECT_FALSE(parse_address("udp://host", 115200).ok());
  EXPECT_FALSE(parse_address("/dev/ttyACM0", 12345).ok());
  EXPECT_EQ(parse_address("tcp://[::1]:80", 0)->port, "80");
}

}  // namespace
}  // namespace waymark::live
