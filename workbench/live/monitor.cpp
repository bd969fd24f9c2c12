#include "workbench/live/monitor.hpp"

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <random>
#include <string_view>
#include <utility>

#include <civetweb.h>
#include <fmt/format.h>

namespace waymark::live {

struct Monitor::Server {
  std::string page;
  std::string token;  // empty: nobody has to know one
  std::string url;
  std::atomic<int> viewers{0};
  std::atomic<bool> stopping{false};

  std::mutex mutex;  // of all below
  std::condition_variable changed;
  std::uint64_t version = 0;
  std::string state = "{}";
  std::string past = "{}";
  std::shared_ptr<const std::string> image;
  std::vector<MonitorCommand> commands;

  mg_context* context = nullptr;
};

namespace {

constexpr const char* kPlain = "text/plain; charset=utf-8";
constexpr const char* kJson = "application/json";
constexpr std::size_t kMostCommands = 64;

void answer(mg_connection* connection, const char* status, const char* type, std::string_view body,
            const std::string& more = "") {
  const std::string head = fmt::format(
      "HTTP/1.1 {}\r\nContent-Type: {}\r\nContent-Length: {}\r\nCache-Control: no-store\r\n"
      "X-Content-Type-Options: nosniff\r\nConnection: close\r\n{}\r\n",
      status, type, body.size(), more);
  mg_write(connection, head.data(), head.size());
  mg_write(connection, body.data(), body.size());
}

/// The token in the page's address, or in the cookie that the page was given.
bool knows(mg_connection* connection, const std::string& token) {
  if (token.empty()) return true;
  std::array<char, 128> given{};
  const char* const query = mg_get_request_info(connection)->query_string;
  if (query != nullptr && mg_get_var(query, std::strlen(query), "token", given.data(), given.size()) > 0 &&
      token == given.data())
    return true;
  const char* const cookie = mg_get_header(connection, "Cookie");
  return cookie != nullptr && mg_get_cookie(cookie, "waymark", given.data(), given.size()) > 0 &&
         token == given.data();
}

std::string random_token() {
  std::random_device device;
  return fmt::format("{:08x}{:08x}{:08x}{:08x}", device(), device(), device(), device());
}

struct HostPort {
  std::string host;
  std::string port;
};

std::optional<HostPort> split(const std::string& address) {
  const std::size_t colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == address.size()) return std::nullopt;
  const std::string port = address.substr(colon + 1);
  if (port.size() > 5 || port.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
  return HostPort{address.substr(0, colon), port};
}

}  // namespace

/// What the server calls, on its threads.
struct MonitorPages {
  using State = Monitor::Server;

  static State& state(void* data) { return *static_cast<State*>(data); }

  static int refuse(mg_connection* connection) {
    answer(connection, "403 Forbidden", kPlain,
           "The address of this page has a token, which waymark live prints.\n");
    return 403;
  }

  static int page(mg_connection* connection, void* data) {
    State& server = state(data);
    if (!knows(connection, server.token)) return refuse(connection);
    if (std::string_view(mg_get_request_info(connection)->local_uri) != "/") {
      answer(connection, "404 Not Found", kPlain, "There is nothing here.\n");
      return 404;
    }
    const std::string cookie =
        server.token.empty()
            ? ""
            : fmt::format("Set-Cookie: waymark={}; HttpOnly; SameSite=Strict\r\n", server.token);
    answer(connection, "200 OK", "text/html; charset=utf-8", server.page, cookie);
    return 200;
  }

  static int past(mg_connection* connection, void* data) {
    State& server = state(data);
    if (!knows(connection, server.token)) return refuse(connection);
    std::string past;
    {
      const std::lock_guard lock(server.mutex);
      past = server.past;
    }
    answer(connection, "200 OK", kJson, past);
    return 200;
  }

  static int image(mg_connection* connection, void* data) {
    State& server = state(data);
    if (!knows(connection, server.token)) return refuse(connection);
    std::shared_ptr<const std::string> image;
    {
      const std::lock_guard lock(server.mutex);
      image = server.image;
    }
    if (!image) {
      answer(connection, "404 Not Found", kPlain, "No image has come yet.\n");
      return 404;
    }
    answer(connection, "200 OK", image->starts_with("\x89PNG") ? "image/png" : "image/jpeg", *image);
    return 200;
  }

  /// Server-sent events: the newest state whenever it changed and this viewer has taken the one before.
  static int events(mg_connection* connection, void* data) {
    State& server = state(data);
    if (!knows(connection, server.token)) return refuse(connection);
    constexpr std::string_view kHead =
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n"
        "Connection: close\r\n\r\n";
    std::uint64_t seen = 0;
    {
      const std::lock_guard lock(server.mutex);
      seen = server.version;  // of before: nobody may have looked for long
    }
    if (mg_write(connection, kHead.data(), kHead.size()) <= 0) return 200;
    ++server.viewers;
    while (!server.stopping) {
      std::string message = ":\n\n";  // a comment: is the viewer still there?
      {
        std::unique_lock lock(server.mutex);
        server.changed.wait_for(lock, std::chrono::seconds(1),
                                [&] { return server.version != seen || server.stopping; });
        if (server.version != seen) message = "data: " + server.state + "\n\n";
        seen = server.version;
      }
      if (mg_write(connection, message.data(), message.size()) <= 0) break;
    }
    --server.viewers;
    return 200;
  }

  /// A header of our own keeps other pages in the same browser from pressing buttons.
  static int command(mg_connection* connection, void* data) {
    State& server = state(data);
    const mg_request_info* const request = mg_get_request_info(connection);
    if (!knows(connection, server.token) || mg_get_header(connection, "X-Waymark") == nullptr ||
        std::string_view(request->request_method) != "POST")
      return refuse(connection);
    constexpr std::array kNames{std::pair("/do/save", MonitorCommand::kSave),
                                std::pair("/do/mark", MonitorCommand::kMark),
                                std::pair("/do/stop", MonitorCommand::kStop)};
    for (const auto& [name, command] : kNames) {
      if (std::string_view(request->local_uri) != name) continue;
      {
        const std::lock_guard lock(server.mutex);
        if (server.commands.size() < kMostCommands) server.commands.push_back(command);
      }
      answer(connection, "200 OK", kPlain, "done\n");
      return 200;
    }
    answer(connection, "404 Not Found", kPlain, "There is no such button.\n");
    return 404;
  }
};

Monitor::Monitor(std::unique_ptr<Server> server) : server_(std::move(server)) {}

Result<std::unique_ptr<Monitor>> Monitor::start(const std::string& address, std::string page) {
  const auto place = split(address);
  if (!place) return Error{fmt::format("{}: the monitor's address is not HOST:PORT", address)};
  auto server = std::make_unique<Server>();
  server->page = std::move(page);
  const bool is_local = place->host == "127.0.0.1" || place->host == "localhost" || place->host == "[::1]";
  if (!is_local) server->token = random_token();
  const std::string host = place->host == "localhost" ? "127.0.0.1" : place->host;
  server->url = fmt::format("http://{}:{}/{}", place->host, place->port,
                            is_local ? "" : fmt::format("?token={}", server->token));
  const std::string listen = fmt::format("{}:{}", host, place->port);
  std::array<const char*, 9> options{
      "listening_ports",       listen.c_str(), "num_threads", "24", "request_timeout_ms", "5000",
      "keep_alive_timeout_ms", "500",          nullptr};
  const mg_callbacks callbacks{};
  server->context = mg_start(&callbacks, server.get(), options.data());
  if (server->context == nullptr)
    return Error{fmt::format("{}: the monitor cannot be opened there: is the port taken, the address that of "
                             "another machine?",
                             address),
                 Error::Kind::kFailed};
  mg_set_request_handler(server->context, "/", &MonitorPages::page, server.get());
  mg_set_request_handler(server->context, "/events", &MonitorPages::events, server.get());
  mg_set_request_handler(server->context, "/past", &MonitorPages::past, server.get());
  mg_set_request_handler(server->context, "/image", &MonitorPages::image, server.get());
  mg_set_request_handler(server->context, "/do", &MonitorPages::command, server.get());
  return std::unique_ptr<Monitor>(new Monitor(std::move(server)));
}

Monitor::~Monitor() {
  server_->stopping = true;
  server_->changed.notify_all();
  mg_stop(server_->context);
}

const std::string& Monitor::url() const { return server_->url; }

bool Monitor::is_watched() const { return server_->viewers > 0; }

void Monitor::show(std::string state) {
  {
    const std::lock_guard lock(server_->mutex);
    server_->state = std::move(state);
    ++server_->version;
  }
  server_->changed.notify_all();
}

void Monitor::show_past(std::string past) {
  const std::lock_guard lock(server_->mutex);
  server_->past = std::move(past);
}

void Monitor::show_image(std::shared_ptr<const std::string> image) {
  const std::lock_guard lock(server_->mutex);
  server_->image = std::move(image);
}

std::vector<MonitorCommand> Monitor::take_commands() {
  const std::lock_guard lock(server_->mutex);
  return std::exchange(server_->commands, {});
}

}  // namespace waymark::live
