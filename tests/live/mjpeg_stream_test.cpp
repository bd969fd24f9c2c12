#include "workbench/live/mjpeg_stream.hpp"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "support/jpeg_bytes.hpp"

namespace waymark::live {
namespace {

using test::jpeg_bytes;

/// A web server that answers each connection with the next of some texts and ends it.
class Server {
 public:
  Server(std::uint16_t port, std::vector<std::string> answers) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    const int yes = 1;
    setsockopt(socket_.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    EXPECT_EQ(listen(socket_.get(), 4), 0);
    thread_ = std::jthread([this, answers = std::move(answers)] {
      for (const std::string& answer : answers) {
        const Descriptor connection(accept(socket_.get(), nullptr, nullptr));
        std::array<char, 1024> request{};
        static_cast<void>(read(connection.get(), request.data(), request.size()));
        requests_ += request.data();
        static_cast<void>(send(connection.get(), answer.data(), answer.size(), MSG_NOSIGNAL));
        shutdown(connection.get(), SHUT_WR);
        while (read(connection.get(), request.data(), request.size()) > 0) {
        }
      }
    });
  }

  /// After the answers were given.
  [[nodiscard]] std::string requests() {
    thread_.join();
    return requests_;
  }

 private:
  Descriptor socket_;
  std::string requests_;
  std::jthread thread_;
};

std::string part(int grey, double stamp_s) {
  return fmt::format("--b\r\nContent-Type: image/jpeg\r\nX-Timestamp: {:.6f}\r\n\r\n", stamp_s) +
         jpeg_bytes(GreyImage(16, 8, static_cast<std::uint8_t>(grey))) + "\r\n";
}

const std::string kHead = "HTTP/1.0 200 OK\r\nContent-Type: multipart/x-mixed-replace; boundary=b\r\n\r\n";

struct Brought {
  std::vector<Arrival> arrivals;
  StreamSummary summary;
};

/// What a stream brings until `done`.
template <class Done>
Brought run_until(MjpegStream& stream, const Done& done) {
  Brought run;
  std::mutex mutex;
  {
    const SessionClock clock;
    std::jthread thread([&](const std::stop_token& stop) {
      stream.run(stop, clock, [&](Arrival arrival) {
        const std::lock_guard lock(mutex);
        run.arrivals.push_back(std::move(arrival));
      });
    });
    for (int i = 0; i < 1000; ++i) {
      {
        const std::lock_guard lock(mutex);
        if (done(run.arrivals, stream.state().summary({}))) break;
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  run.summary = stream.state().summary({});
  return run;
}

TEST(MjpegStream, TakesImagesOfAWebServerAndConnectsAgain) {
  Server server(47041,
                {kHead + part(100, 5.0), kHead + part(150, 5.5).substr(0, 200), kHead + part(200, 6.0)});
  MjpegStream stream(parse_address("http://127.0.0.1:47041/camera?size=s", 0).value(), 7, Duration{0},
                     ImageSize{16, 8});
  const Brought run =
      run_until(stream, [](const auto& arrivals, const auto&) { return arrivals.size() == 2; });
  ASSERT_EQ(run.arrivals.size(), 2U);
  const auto& image = std::get<Image>(run.arrivals[1].event.content);
  EXPECT_NEAR((*image.pixels)(3, 3), 200, 2);
  EXPECT_EQ(run.arrivals[1].event.stream.device, 7);
  EXPECT_TRUE(image.encoded->starts_with("\xff\xd8"));
  EXPECT_EQ(run.summary.bad, 1);
  EXPECT_GE(run.summary.reconnects, 2);
  EXPECT_NE(server.requests().find("GET /camera?size=s HTTP/1.0\r\n"), std::string::npos);
}

TEST(MjpegStream, UnpacksOnlyTheNewestOfSeveral) {
  Server server(47042, {kHead + part(10, 1.0) + part(20, 1.1) + part(30, 1.2)});
  MjpegStream stream(parse_address("http://127.0.0.1:47042", 0).value(), 0, Duration{0}, ImageSize{16, 8});
  const Brought run = run_until(stream, [](const auto& arrivals, const auto& summary) {
    return !arrivals.empty() && summary.replaced + static_cast<std::int64_t>(arrivals.size()) == 3;
  });
  EXPECT_NEAR((*std::get<Image>(run.arrivals.back().event.content).pixels)(3, 3), 30, 2);
}

TEST(MjpegStream, SaysWhyNothingComes) {
  Server server(47043, {"HTTP/1.0 404 Not Found\r\n\r\n"});
  MjpegStream stream(parse_address("http://127.0.0.1:47043/x", 0).value(), 0, Duration{0}, std::nullopt);
  const Brought run = run_until(stream, [](const auto&, const auto& summary) {
    return summary.fault.find("404") != std::string::npos;
  });
  EXPECT_NE(run.summary.fault.find("404"), std::string::npos);
}

TEST(MjpegStream, CountsImagesOfAnotherSize) {
  Server server(47044, {kHead + part(10, 1.0)});
  MjpegStream stream(parse_address("http://127.0.0.1:47044/x", 0).value(), 0, Duration{0},
                     ImageSize{320, 240});
  const Brought run = run_until(stream, [](const auto&, const auto& summary) { return summary.bad == 1; });
  EXPECT_EQ(run.summary.bad, 1);
  EXPECT_TRUE(run.arrivals.empty());
}

}  // namespace
}  // namespace waymark::live
