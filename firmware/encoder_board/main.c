// Wheel lines (docs/live.md) from two quadrature encoders, on an ATmega328P at 16 MHz (Arduino Uno or Nano).
//
// Left encoder: A on D2, B on D3. Right encoder: A on D4, B on D5. Forward rolling counts up where A leads B; swap
// the two wires of an encoder that counts down. 115200 baud on the USB port, 30 lines a second.
//
//   avr-gcc -mmcu=atmega328p -Os -Wall -Wextra -o main.elf main.c && avr-objcopy -O ihex main.elf main.hex
//   avrdude -p m328p -c arduino -P /dev/ttyACM0 -U flash:w:main.hex

#define F_CPU 16000000UL

#include <avr/interrupt.h>
#include <avr/io.h>
#include <stdint.h>
#include <util/atomic.h>

enum { kMsPerLine = 33 };

static volatile int32_t left_ticks, right_ticks;
static volatile uint32_t clock_ms;

// Change of the count by the states (A B) before and now, as 4 * before + now; 0 where both changed: one was missed.
static const int8_t kStep[16] = {0, -1, 1, 0, 1, 0, 0, -1, -1, 0, 0, 1, 0, 1, -1, 0};

// Any edge of D2 to D5, which are bits 2 to 5 of port D: A is the lower bit of each pair.
ISR(PCINT2_vect) {
  static uint8_t left_before, right_before;
  const uint8_t pins = PIND;
  const uint8_t left = (uint8_t)((pins >> 1 & 2) | (pins >> 3 & 1));
  const uint8_t right = (uint8_t)((pins >> 3 & 2) | (pins >> 5 & 1));
  left_ticks += kStep[left_before << 2 | left];
  right_ticks += kStep[right_before << 2 | right];
  left_before = left;
  right_before = right;
}

ISR(TIMER0_COMPA_vect) { ++clock_ms; }

static void set_up(void) {
  PORTD |= 0x3c;  // pull-ups
  PCMSK2 = 0x3c;
  PCICR = 1 << PCIE2;
  TCCR0A = 1 << WGM01;  // 16 MHz / 64 / 250: every millisecond
  TCCR0B = 1 << CS01 | 1 << CS00;
  OCR0A = 249;
  TIMSK0 = 1 << OCIE0A;
  UCSR0A = 1 << U2X0;  // 16 MHz / 8 / 17 = 117647 baud, 2.1 % off; without it 3.5 %
  UBRR0 = 16;
  UCSR0B = 1 << TXEN0;
  UCSR0C = 1 << UCSZ01 | 1 << UCSZ00;
  sei();
}

static void put(char c) {
  while (!(UCSR0A & 1 << UDRE0)) {
  }
  UDR0 = (uint8_t)c;
}

static uint8_t sum;  // of the line so far

static void put_summed(char c) {
  sum ^= (uint8_t)c;
  put(c);
}

static void put_digits(uint32_t value) {
  char digits[10];
  uint8_t count = 0;
  do {
    digits[count++] = (char)('0' + value % 10);
    value /= 10;
  } while (value > 0);
  while (count > 0) put_summed(digits[--count]);
}

static void put_unsigned(uint32_t value) {
  put_summed(' ');
  put_digits(value);
}

static void put_signed(int32_t value) {
  put_summed(' ');
  if (value < 0) put_summed('-');
  put_digits(value < 0 ? 0U - (uint32_t)value : (uint32_t)value);
}

static void put_line(uint32_t sequence, uint32_t now_ms, int32_t left, int32_t right) {
  static const char kHex[] = "0123456789ABCDEF";
  sum = 0;
  put_summed('E');
  put_unsigned(sequence);
  put_unsigned(now_ms);
  put_signed(left);
  put_signed(right);
  const uint8_t whole = sum;
  put('*');
  put(kHex[whole >> 4]);
  put(kHex[whole & 15]);
  put('\n');
}

int main(void) {
  set_up();
  uint32_t sequence = 0, next_ms = kMsPerLine;
  for (;;) {
    uint32_t now_ms;
    int32_t left, right;
    ATOMIC_BLOCK(ATOMIC_RESTORESTATE) {
      now_ms = clock_ms;
      left = left_ticks;
      right = right_ticks;
    }
    if ((int32_t)(now_ms - next_ms) < 0) continue;
    next_ms += kMsPerLine;
    put_line(sequence++, now_ms, left, right);
  }
}
