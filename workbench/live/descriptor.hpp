#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "waymark/core/result.hpp"

namespace waymark::live {

/// An open file, port or socket; closed with this object.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  ~Descriptor();

  [[nodiscard]] int get() const { return fd_; }
  [[nodiscard]] bool is_open() const { return fd_ >= 0; }

 private:
  int fd_ = -1;
};

/// Where bytes come from:
///
///     -                    standard input
///     udp://HOST:PORT      datagrams that arrive at this address of ours
///     tcp://HOST:PORT      a server
///     http://HOST:PORT/PATH  a server, asked for that page
///     /dev/ttyACM0         a serial port: 8 bits, no parity, raw, at `baud`
///     any other path       a FIFO or a file
///
/// Never blocks for longer than a second. A file or FIFO that is read to its end does not begin again.
struct Address {
  enum class Kind { kStandardInput, kUdp, kTcp, kHttp, kSerial, kFile };

  Kind kind = Kind::kFile;
  std::string text;  ///< as the user wrote it
  std::string host;
  std::string port;
  std::string page = "/";  ///< of kHttp
  int baud = 115200;

  /// What is read to its end has ended, and is not opened again.
  [[nodiscard]] bool may_come_back() const { return kind != Kind::kStandardInput && kind != Kind::kFile; }
};

/// An error names what is wrong with the text.
[[nodiscard]] Result<Address> parse_address(std::string_view text, int baud);

/// An error says why, in a few words.
[[nodiscard]] Result<Descriptor> open_for_reading(const Address& address);

/// A socket that sends datagrams to a host and port.
[[nodiscard]] Result<Descriptor> open_udp_sender(const std::string& host, const std::string& port);

}  // namespace waymark::live
