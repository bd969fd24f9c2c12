#include "workbench/live/descriptor.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <netdb.h>

namespace waymark::live {
namespace {

constexpr int kConnect_ms = 1000;

Error failed(const Address& address, int error) {
  return {fmt::format("{}: {}", address.text, std::strerror(error)), Error::Kind::kFailed};
}

std::optional<speed_t> speed_of(int baud) {
  struct Speed {
    int baud;
    speed_t speed;
  };
  constexpr std::array kSpeeds{Speed{9600, B9600},     Speed{19200, B19200},   Speed{38400, B38400},
                               Speed{57600, B57600},   Speed{115200, B115200}, Speed{230400, B230400},
                               Speed{460800, B460800}, Speed{921600, B921600}, Speed{1000000, B1000000}};
  for (const auto& [rate, speed] : kSpeeds)
    if (rate == baud) return speed;
  return std::nullopt;
}

/// As it is: no echo, no line editing, no signals; hanging up does not reset the board.
bool make_raw(int fd, speed_t speed) {
  termios settings{};
  if (tcgetattr(fd, &settings) != 0) return false;
  cfmakeraw(&settings);
  settings.c_cflag |= CLOCAL | CREAD;
  settings.c_cflag &= ~static_cast<tcflag_t>(HUPCL | CRTSCTS);
  settings.c_cc[VMIN] = 0;
  settings.c_cc[VTIME] = 0;
  return cfsetispeed(&settings, speed) == 0 && cfsetospeed(&settings, speed) == 0 &&
         tcsetattr(fd, TCSANOW, &settings) == 0;
}

Result<Descriptor> open_path(const Address& address) {
  Descriptor file(open(address.text.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  return file.is_open() ? Result<Descriptor>(std::move(file)) : failed(address, errno);
}

Result<Descriptor> open_serial(const Address& address) {
  Descriptor port(open(address.text.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC));
  if (!port.is_open()) return failed(address, errno);
  if (!make_raw(port.get(), *speed_of(address.baud))) return failed(address, errno);
  tcflush(port.get(), TCIFLUSH);
  return port;
}

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Result<AddressList> resolve(const Address& address, int type, int flags) {
  addrinfo hints{};
  hints.ai_socktype = type;
  hints.ai_flags = flags;
  addrinfo* list = nullptr;
  const int error =
      getaddrinfo(address.host.empty() ? nullptr : address.host.c_str(), address.port.c_str(), &hints, &list);
  if (error != 0)
    return Error{fmt::format("{}: {}", address.text, gai_strerror(error)), Error::Kind::kFailed};
  return AddressList(list, &freeaddrinfo);
}

Descriptor socket_for(const addrinfo& info) {
  return Descriptor(
      socket(info.ai_family, info.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC, info.ai_protocol));
}

Result<Descriptor> bind_udp(const Address& address) {
  const auto list = resolve(address, SOCK_DGRAM, AI_PASSIVE);
  if (!list) return list.error();
  int error = 0;
  for (const addrinfo* each = list->get(); each != nullptr; each = each->ai_next) {
    Descriptor made = socket_for(*each);
    if (made.is_open() && bind(made.get(), each->ai_addr, each->ai_addrlen) == 0) return made;
    error = errno;
  }
  return failed(address, error);
}

/// Waits for a connection that is being made.
int connect_error(int fd) {
  pollfd waiting{fd, POLLOUT, 0};
  if (poll(&waiting, 1, kConnect_ms) <= 0) return ETIMEDOUT;
  int error = 0;
  socklen_t size = sizeof error;
  getsockopt(fd, SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

Result<Descriptor> connect_to(const Address& address, int type) {
  const auto list = resolve(address, type, 0);
  if (!list) return list.error();
  int error = 0;
  for (const addrinfo* each = list->get(); each != nullptr; each = each->ai_next) {
    Descriptor made = socket_for(*each);
    if (!made.is_open()) continue;
    error = connect(made.get(), each->ai_addr, each->ai_addrlen) == 0 ? 0 : errno;
    if (error == EINPROGRESS) error = connect_error(made.get());
    if (error == 0) return made;
  }
  return failed(address, error);
}

bool is_terminal(const std::string& path) {
  struct stat info {};
  return stat(path.c_str(), &info) == 0 ? S_ISCHR(info.st_mode) : path.starts_with("/dev/");
}

struct Scheme {
  std::string_view begin;
  Address::Kind kind;
};
constexpr std::array kSchemes{Scheme{"udp://", Address::Kind::kUdp}, Scheme{"tcp://", Address::Kind::kTcp},
                              Scheme{"http://", Address::Kind::kHttp}};

/// `rest` is HOST:PORT, for http also HOST/PAGE and HOST:PORT/PAGE.
Result<Address> parse_url(Address address, std::string_view rest, Address::Kind kind) {
  address.kind = kind;
  if (kind == Address::Kind::kHttp) {
    address.port = "80";
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    if (slash < rest.size()) address.page = rest.substr(slash);
    rest = rest.substr(0, slash);
  }
  const std::size_t colon = rest.rfind(':');
  address.host = rest.substr(0, colon);
  if (colon != std::string_view::npos) address.port = rest.substr(colon + 1);
  if (address.port.empty()) return Error{fmt::format("{}: a port is missing: HOST:PORT", address.text)};
  return address;
}

/// Asks for the page in the oldest way, so that the answer ends with the connection.
Result<Descriptor> open_page(const Address& address) {
  auto connection = connect_to(address, SOCK_STREAM);
  if (!connection) return connection;
  const std::string request =
      fmt::format("GET {} HTTP/1.0\r\nHost: {}:{}\r\n\r\n", address.page, address.host, address.port);
  if (send(connection->get(), request.data(), request.size(), MSG_NOSIGNAL) < 0)
    return failed(address, errno);
  return connection;
}

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

/// The standard streams are not ours to close.
Descriptor::~Descriptor() {
  if (fd_ > STDERR_FILENO) close(fd_);
}

Result<Address> parse_address(std::string_view text, int baud) {
  Address address{.text = std::string(text), .baud = baud};
  for (const auto& [scheme, kind] : kSchemes)
    if (text.starts_with(scheme)) return parse_url(std::move(address), text.substr(scheme.size()), kind);
  if (text.empty()) return Error{"an address of a stream is empty"};
  if (text == "-") {
    address.kind = Address::Kind::kStandardInput;
  } else if (is_terminal(address.text)) {
    address.kind = Address::Kind::kSerial;
    if (!speed_of(baud)) return Error{fmt::format("{}: {} baud is not a usual speed", text, baud)};
  }
  return address;
}

Result<Descriptor> open_for_reading(const Address& address) {
  switch (address.kind) {
    case Address::Kind::kStandardInput:
      return Descriptor(STDIN_FILENO);
    case Address::Kind::kUdp:
      return bind_udp(address);
    case Address::Kind::kTcp:
      return connect_to(address, SOCK_STREAM);
    case Address::Kind::kHttp:
      return open_page(address);
    case Address::Kind::kSerial:
      return open_serial(address);
    case Address::Kind::kFile:
      return open_path(address);
  }
  return Descriptor();
}

Result<Descriptor> open_udp_sender(const std::string& host, const std::string& port) {
  return connect_to({Address::Kind::kUdp, fmt::format("udp://{}:{}", host, port), host, port}, SOCK_DGRAM);
}

}  // namespace waymark::live
