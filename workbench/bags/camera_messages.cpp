#include "workbench/bags/camera_messages.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "workbench/bags/message_decoder.hpp"
#include "workbench/logs/text_lines.hpp"

namespace waymark::bag {
namespace {

bool is_finite(std::span<const double> values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

/// Of the eight coefficients that some drivers write the last three must do nothing.
Result<Distortion> read_distortion(std::string_view model, std::span<const double> D) {
  const bool is_plumb_bob = model == "plumb_bob" || model.empty();
  const bool does_nothing = std::ranges::all_of(D, [](double d) { return d == 0.0; });
  if (does_nothing) return Distortion{};
  if (!is_plumb_bob || D.size() < 4 || !is_finite(D))
    return Error{fmt::format(
        "its distortion_model {} with {} coefficients is not supported; only plumb_bob with 4 or 5 is",
        in_quotes(model), D.size())};
  return Distortion{.k1 = D[0], .k2 = D[1], .p1 = D[2], .p2 = D[3], .k3 = D.size() > 4 ? D[4] : 0.0};
}

}  // namespace

Result<CameraOptions> read_camera_info(const Topic& topic, std::string_view bytes, bool rectified) {
  auto message = MessageDecoder::make(topic, {{"width", "height", "K", "D", "P"}, {"distortion_model"}});
  if (!message) return message.error();
  if (auto done = message->decode(bytes); !done) return done.error();
  const auto K = message->numbers(2), P = message->numbers(4);
  if (K.size() != 9 || P.size() != 12 || !is_finite(K) || !is_finite(P))
    return Error{"its matrices are not those of a camera"};
  CameraOptions camera{.width_px = static_cast<int>(std::min<std::uint32_t>(message->size(0), 1u << 20)),
                       .height_px = static_cast<int>(std::min<std::uint32_t>(message->size(1), 1u << 20)),
                       .fu_px = rectified ? P[0] : K[0],
                       .fv_px = rectified ? P[5] : K[4],
                       .cu_px = rectified ? P[2] : K[2],
                       .cv_px = rectified ? P[6] : K[5]};
  if (camera.fu_px <= 0.0 || camera.fv_px <= 0.0)
    return Error{"the camera was never calibrated: its matrix is zero"};
  if (rectified) return camera;
  auto distortion = read_distortion(message->text(0), message->numbers(3));
  if (!distortion) return distortion.error();
  camera.distortion = *distortion;
  return camera;
}

std::string read_frame(const Topic& topic, std::string_view bytes, const std::string& field) {
  auto message = MessageDecoder::make(topic, {{}, {field}});
  if (!message || !message->decode(bytes)) return "";
  const auto texts = message->texts(0);
  return texts.empty() ? "" : plain_frame(texts.front());
}

}  // namespace waymark::bag
