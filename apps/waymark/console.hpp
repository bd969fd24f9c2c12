#pragma once

#include <chrono>
#include <string>
#include <string_view>

namespace waymark::app {

/// How much to say and in which form; the same flags on every command.
struct Verbosity {
  bool quiet = false;
  bool json = false;

  /// Text for people goes to standard output unless something else was asked for.
  [[nodiscard]] bool talks() const { return !quiet && !json; }
};

/// A bar on a terminal's standard error, redrawn at most ten times a second; nothing in a pipe.
class ProgressBar {
 public:
  ProgressBar(std::string what, const Verbosity& verbosity);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double fraction);

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  bool visible_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_{};
};

/// To standard error. That it is closed or full is no reason to end otherwise: nothing is thrown.
void print_error(std::string_view text) noexcept;

/// Keeps the numbers of standard streams that are closed from the files that are opened next, which would get
/// what is meant for the streams. Writing to such a stream fails as before.
void reserve_standard_streams();

/// Why standard output did not take everything that was printed; empty: it did.
[[nodiscard]] std::string output_failure();

/// Whether the user pressed Ctrl-C since catch_interrupts(). A second Ctrl-C ends the program at once.
void catch_interrupts();
[[nodiscard]] bool interrupted();

}  // namespace waymark::app
