#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "waymark/core/stamp.hpp"

namespace waymark::live {

/// Cuts a stream of motion JPEG, as it comes in, into images: those of a multipart answer of a web server, or
/// JPEG files one behind the other. An image ends where its own segments say (ITU T.81, annex B), so that no
/// length or boundary between images need be right.
class MjpegSplitter {
 public:
  static constexpr std::size_t kLargest = 16'000'000;  ///< of one image, bytes

  struct Frame {
    std::string jpeg;
    std::optional<Duration> stamp;  ///< X-Timestamp of its part, by the sender's clock
  };

  void add(std::string_view bytes) { bytes_.append(bytes); }

  /// The next image that is complete.
  [[nodiscard]] std::optional<Frame> next();

  /// Images that broke off or are damaged.
  [[nodiscard]] std::int64_t damaged() const { return damaged_; }

  /// What was begun is not continued: its connection has ended.
  void forget();

 private:
  [[nodiscard]] bool find_start();
  void give_up_image();
  [[nodiscard]] std::optional<std::size_t> find_end();

  std::string bytes_;         // from the start of an image on, where `started_`
  std::size_t position_ = 0;  // up to which they were looked at
  bool started_ = false;
  bool in_scan_ = false;  // in entropy-coded data, which have no length
  std::optional<Duration> stamp_;
  std::int64_t damaged_ = 0;
};

}  // namespace waymark::live
