#pragma once

#include <cstdint>
#include <string>

namespace waymark {

/// How many of the 16 bits of its samples a camera uses. Sensors of 10 or 12 bits are often stored in 16 with
/// the upper ones at 0: taken for 16 bits their images would be black. The bits are those of the usual
/// converters (8, 10, 12, 14 or 16), the fewest that hold every sample of the images so far. They never
/// become fewer, so that the grey values of a sequence do not flicker.
class UsedBits {
 public:
  /// The right shift that takes the samples of an image to 8 bits, if `largest` is the largest of them.
  int shift(std::uint16_t largest);

  /// "uses 10 of 16 bits (largest value 1013)"; empty: no image came, or all 16 are used.
  [[nodiscard]] std::string note() const;

 private:
  int bits_ = 0;
  std::uint16_t largest_ = 0;
};

}  // namespace waymark
