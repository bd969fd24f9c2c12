#include "waymark/fastslam/range_calibration.hpp"

#include <algorithm>
#include <cmath>

#include "waymark/core/random.hpp"

namespace waymark::fastslam {
namespace {

// A scale is not believed to be below this, whatever a move says.
constexpr float kMinScale = 0.1F;

// Far from the streams of particles that start somewhere else: see FastSlam's constructor.
constexpr std::uint64_t kStep = std::uint64_t{1} << 40;

Spread spread_of(const AlignedArray<float>& column, std::span<const double> weights) {
  Spread spread;
  for (std::size_t i = 0; i < weights.size(); ++i) spread.mean += weights[i] * static_cast<double>(column[i]);
  double variance = 0.0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double d = static_cast<double>(column[i]) - spread.mean;
    variance += weights[i] * d * d;
  }
  spread.sigma = std::sqrt(variance);
  return spread;
}

}  // namespace

RangeCalibration::RangeCalibration(const LandmarkSensor& sensor, std::uint64_t seed, ParticleBlocks& blocks)
    : blocks_(blocks),
      scale_(sensor.errors.shares_range() ? blocks.capacity() : 0),
      offset_m_(scale_.size()),
      factor_(scale_.size()) {
  const SensorErrors& e = sensor.errors;
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    RandomStream random(seed, StreamPurpose::kInitialisation, kStep, static_cast<std::uint32_t>(i));
    scale_[i] = static_cast<float>(1.0 + e.shared_range_sigma_ratio * random.normal());
    offset_m_[i] = static_cast<float>(e.shared_range_sigma_m * random.normal());
  }
  refresh();
}

kernels::RangeErrors RangeCalibration::columns() const {
  if (!is_estimated()) return {};
  return {offset_m_.data(), factor_.data()};
}

void RangeCalibration::refresh() {
  for (std::size_t i = 0; i < scale_.size(); ++i) {
    scale_[i] = std::max(scale_[i], kMinScale);
    factor_[i] = 1.0F / scale_[i];
  }
}

void RangeCalibration::replace_by_ancestors(std::span<const std::int32_t> ancestors) {
  if (!is_estimated()) return;
  blocks_.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto from = static_cast<std::size_t>(ancestors[i]);
      for (auto* column : {&scale_, &offset_m_, &factor_}) (*column)[i] = (*column)[from];
    }
  });
}

Spread RangeCalibration::scale(std::span<const double> weights) const { return spread_of(scale_, weights); }

Spread RangeCalibration::offset_m(std::span<const double> weights) const {
  return spread_of(offset_m_, weights);
}

}  // namespace waymark::fastslam
