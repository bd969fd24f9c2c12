#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "waymark/core/result.hpp"

namespace waymark::live {

/// A button that someone pressed.
enum class MonitorCommand : std::uint8_t { kSave, kMark, kStop };

/// A page that shows a session, on a small web server with threads of its own: one file for any browser,
/// which then asks for what changed. A viewer that reads slowly holds nobody up: it gets the newest state
/// when it can take one.
///
/// Bound to 127.0.0.1 or localhost everyone on this machine may look. Bound elsewhere, who looks has to know
/// the token, which is drawn at random and is part of url().
class Monitor {
 public:
  /// `address` is HOST:PORT; `page` the HTML. An error: the port is taken, or the address is none.
  [[nodiscard]] static Result<std::unique_ptr<Monitor>> start(const std::string& address, std::string page);
  ~Monitor();
  Monitor(const Monitor&) = delete;
  Monitor& operator=(const Monitor&) = delete;

  [[nodiscard]] const std::string& url() const;

  /// Whether anyone is looking: nothing need be made for nobody.
  [[nodiscard]] bool is_watched() const;

  /// The newest state, as JSON. Any thread; never blocks for longer than a copy.
  void show(std::string state);
  /// What a page needs once, when it is opened: what came before. JSON.
  void show_past(std::string past);
  /// The newest image, a JPEG or PNG file.
  void show_image(std::shared_ptr<const std::string> image);

  /// The buttons pressed since the last call.
  [[nodiscard]] std::vector<MonitorCommand> take_commands();

 private:
  friend struct MonitorPages;
  struct Server;
  explicit Monitor(std::unique_ptr<Server> server);

  std::unique_ptr<Server> server_;
};

}  // namespace waymark::live
