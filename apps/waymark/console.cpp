#include "console.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>
#include <utility>

#include <fmt/format.h>

namespace waymark::app {
namespace {

volatile std::sig_atomic_t interrupt_count = 0;

void on_interrupt(int signal) {
  interrupt_count = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

ProgressBar::ProgressBar(std::string what, const Verbosity& verbosity)
    : what_(std::move(what)), visible_(!verbosity.quiet && isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (drawn_) print_error("\r\033[K");
}

void ProgressBar::show(double fraction) {
  constexpr int kWidth = 30;
  const auto now = Clock::now();
  if (!visible_ || now - last_ < std::chrono::milliseconds(100)) return;
  last_ = now;
  drawn_ = true;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const double spent_s = std::chrono::duration<double>(now - start_).count();
  const auto filled = static_cast<std::size_t>(done * kWidth);
  const std::string left = done > 0.02 ? fmt::format(", {:.0f} s left", spent_s * (1.0 - done) / done) : "";
  print_error(fmt::format("\r\033[K{} [{}{}] {:3.0f} %{}", what_, std::string(filled, '#'),
                          std::string(kWidth - filled, '.'), 100.0 * done, left));
}

void print_error(std::string_view text) noexcept {
  static_cast<void>(std::fwrite(text.data(), 1, text.size(), stderr));
  static_cast<void>(std::fflush(stderr));
}

void reserve_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) == -1)
      static_cast<void>(::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY));
}

std::string output_failure() {
  const bool is_flushed = std::fflush(stdout) == 0;
  const int code = errno;
  if (is_flushed && std::ferror(stdout) == 0) return "";
  return "cannot write to standard output" +
         (is_flushed ? std::string() : ": " + std::generic_category().message(code));
}

void catch_interrupts() {
  interrupt_count = 0;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

bool interrupted() { return interrupt_count != 0; }

}  // namespace waymark::app
