#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

// A plain C interface.
extern "C" {
#include <simavr/avr_ioport.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
}

#include "workbench/live/line_splitter.hpp"
#include "workbench/live/wheel_line.hpp"

namespace waymark::live {
namespace {

constexpr double kClock_hz = 16e6;

/// The board's program, run by an emulator of its processor.
class Board {
 public:
  Board() {
    elf_firmware_t firmware{};
    EXPECT_EQ(elf_read_firmware(WAYMARK_FIRMWARE, &firmware), 0);
    avr_ = avr_make_mcu_by_name("atmega328p");
    avr_init(avr_);
    avr_->frequency = static_cast<std::uint32_t>(kClock_hz);
    avr_load_firmware(avr_, &firmware);
    std::uint32_t flags = 0;  // not to this program's standard output
    avr_ioctl(avr_, AVR_IOCTL_UART_GET_FLAGS('0'), &flags);
    flags &= ~static_cast<std::uint32_t>(AVR_UART_FLAG_STDIO);
    avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    avr_irq_register_notify(
        avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT),
        [](avr_irq_t*, std::uint32_t value, void* board) {
          const char c = static_cast<char>(value);
          auto& self = *static_cast<Board*>(board);
          self.lines_.add({&c, 1}, [&](std::string_view line) { self.texts_.emplace_back(line); });
        },
        this);
  }
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;
  ~Board() { avr_terminate(avr_); }

  void run_for(double time_s) {
    const auto end = avr_->cycle + static_cast<avr_cycle_count_t>(time_s * kClock_hz);
    while (avr_->cycle < end) avr_run(avr_);
  }

  /// The phase of an encoder, which counts forward: A leads B.
  void set_encoder(int pin_a, int phase) {
    set_pin(pin_a, phase == 1 || phase == 2);
    set_pin(pin_a + 1, phase == 2 || phase == 3);
  }

  [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }

 private:
  void set_pin(int pin, bool high) {
    avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ('D'), pin), high ? 1 : 0);
  }

  avr_t* avr_ = nullptr;
  LineSplitter lines_;
  std::vector<std::string> texts_;
};

TEST(Firmware, TellsWhatTheEncodersCount) {
  Board board;
  board.set_encoder(2, 0);
  board.set_encoder(4, 0);
  board.run_for(0.05);
  int left = 0, right = 0;
  for (int i = 0; i < 600; ++i) {  // 1000 edges a second on the left, 500 backwards on the right
    board.set_encoder(2, ++left & 3);
    if (i % 2 == 0) board.set_encoder(4, --right & 3);
    board.run_for(1e-3);
  }
  board.run_for(0.1);
  std::vector<WheelLine> lines;
  for (const std::string& text : board.texts()) {
    const auto line = parse_wheel_line(text);
    ASSERT_TRUE(line) << text;
    lines.push_back(*line);
  }
  ASSERT_GT(lines.size(), 18U);
  EXPECT_EQ(lines.back().left_ticks - lines.front().left_ticks, 600);
  EXPECT_EQ(lines.back().right_ticks - lines.front().right_ticks, -300);
  for (std::size_t i = 1; i < lines.size(); ++i) {
    EXPECT_EQ(lines[i].sequence, lines[i - 1].sequence + 1);
    EXPECT_NEAR(lines[i].clock_ms - lines[i - 1].clock_ms, 33.0, 1.0);
  }
}

}  // namespace
}  // namespace waymark::live
