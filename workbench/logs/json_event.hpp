#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "waymark/core/event.hpp"
#include "waymark/core/result.hpp"

namespace waymark {

/// What a line of JSON tells, by the names of the log folder's columns (docs/log-format.md):
///
///     {"stamp_s":12.5,"left_rad":3.1,"right_rad":3.2}
///     {"stamp_s":12.5,"v_mps":0.3,"w_radps":0.1}
///     {"stamp_s":12.5,"v_mps":0.3,"steer_rad":0.1}
///     {"stamp_s":12.5,"x_m":1.0,"y_m":0.2,"theta_rad":0.1}
///     {"stamp_s":12.5,"w_radps":0.1}
///     {"stamp_s":12.5,"observations":[{"id":3,"range_m":1.2,"bearing_rad":0.4}]}
///
/// An observation without id is of an unknown landmark; range, bearing or both are measured, or u_px and
/// v_px; "covariance":[a,b,c] of [a b; b c], in the order and units of what is measured, may be added.
/// Without stamp_s it counts from its arrival.
struct JsonEvent {
  std::optional<Stamp> stamp;  ///< by the sender's clock
  EventContent content;
};

/// An error says in a few words what is wrong with the line.
[[nodiscard]] Result<JsonEvent> parse_json_event(std::string_view line);

/// The line that reads back as this event; without an end of line. Empty for images and truth.
[[nodiscard]] std::string to_json_event(Stamp stamp, const EventContent& content);

}  // namespace waymark
