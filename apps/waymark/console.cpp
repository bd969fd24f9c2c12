#include "console.hpp"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
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
  if (drawn_) fmt::print(stderr, "\r\033[K");
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
  fmt::print(stderr, "\r\033[K{} [{}{}] {:3.0f} %{}", what_, std::string(filled, '#'),
             std::string(kWidth - filled, '.'), 100.0 * done, left);
  std::fflush(stderr);
}

void catch_interrupts() {
  interrupt_count = 0;
  std::signal(SIGINT, on_interrupt);
  std::signal(SIGTERM, on_interrupt);
}

bool interrupted() { return interrupt_count != 0; }

}  // namespace waymark::app
