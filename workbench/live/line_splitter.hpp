#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace waymark::live {

/// Cuts bytes, as they come in, into lines. A line of more than `kLongest` bytes is passed over up to its
/// end.
class LineSplitter {
 public:
  static constexpr std::size_t kLongest = 65536;

  /// Gives each line that has ended, without its end; valid during the call.
  template <class Take>
  void add(std::string_view bytes, const Take& take) {
    while (!bytes.empty()) {
      const std::size_t end = bytes.find('\n');
      begun_.append(bytes.substr(0, end));
      if (begun_.size() > kLongest) {
        too_long_ = true;
        begun_.clear();
      }
      if (end == std::string_view::npos) return;
      bytes.remove_prefix(end + 1);
      if (!begun_.empty() && begun_.back() == '\r') begun_.pop_back();
      if (too_long_) ++passed_over_;
      if (!too_long_ && !begun_.empty()) take(std::string_view(begun_));
      too_long_ = false;
      begun_.clear();
    }
  }

  /// A line that was begun is not continued: its connection has ended.
  void forget() {
    begun_.clear();
    too_long_ = false;
  }

  [[nodiscard]] std::int64_t passed_over() const { return passed_over_; }

 private:
  std::string begun_;
  bool too_long_ = false;
  std::int64_t passed_over_ = 0;
};

}  // namespace waymark::live
