#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "waymark/core/result.hpp"
#include "waymark/slam/odometer.hpp"

#include "workbench/run/config.hpp"

namespace waymark::study {

/// A config key that is tuned. What cannot be negative is searched by its logarithm, over six decades at
/// most; anything else as it is.
struct TuneKey {
  std::string name;
  double start = 0.0;
  double low = 0.0;
  double high = 0.0;
  bool by_factor = true;

  /// Between the value of the key and where the search looks for it.
  [[nodiscard]] double to_search(double value) const;
  [[nodiscard]] double to_value(double at) const;
  /// How far the first look goes in the search: to twice the value.
  [[nodiscard]] double first_step() const;
};

/// The value as text, to four digits: what is tried is what a config file will say.
[[nodiscard]] std::string tuned_text(double value);

/// Settings "key=value" of a point in the search.
[[nodiscard]] std::vector<std::string> assignments(const std::vector<TuneKey>& keys,
                                                   const std::vector<double>& at);

/// The named keys, starting where `config` has them. Refused: what is no key, no real number, has to do with
/// the input, or begins at 0, from where no factor leads away.
[[nodiscard]] Result<std::vector<TuneKey>> tune_keys(const Config& config,
                                                     const std::vector<std::string>& names);

/// The odometry of a log in words; none: it has none.
[[nodiscard]] std::string_view describe(std::optional<OdometryKind> kind);

/// The noise of that odometry and of what is observed, as far as it is not 0: a part of the model that is
/// switched off stays off.
[[nodiscard]] std::vector<std::string> default_tune_keys(const Config& config,
                                                         std::optional<OdometryKind> odometry);

}  // namespace waymark::study
