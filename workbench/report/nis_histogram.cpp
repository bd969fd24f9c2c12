#include "workbench/report/nis_histogram.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "waymark/core/chi2.hpp"

namespace waymark {
namespace {

constexpr int kBins = 24;
constexpr double kShown = 0.998;  // part of the expected distribution that the bins cover

int most_frequent_dof(std::span<const int> dof) {
  std::map<int, std::size_t> counts;
  for (const int value : dof) {
    if (value >= 1) ++counts[value];
  }
  const auto most = std::max_element(counts.begin(), counts.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return most == counts.end() ? 0 : most->first;
}

// Tenths: bin borders are read by people.
double bin_width_for(int dof) { return std::ceil(10.0 * chi2_quantile(kShown, dof) / kBins) / 10.0; }

}  // namespace

NisHistogram nis_histogram(std::span<const double> nis, std::span<const int> dof) {
  NisHistogram histogram;
  histogram.dof = most_frequent_dof(dof);
  if (histogram.dof == 0) return histogram;
  const double width = histogram.bin_width = bin_width_for(histogram.dof);
  histogram.density.resize(kBins);
  double counted = 0.0;
  for (std::size_t i = 0; i < nis.size(); ++i) {
    if (dof[i] != histogram.dof || !(nis[i] >= 0.0)) continue;
    counted += 1.0;
    if (nis[i] < kBins * width) histogram.density[static_cast<std::size_t>(nis[i] / width)] += 1.0;
  }
  for (double& value : histogram.density) value /= std::max(1.0, counted) * width;
  for (int k = 0; k < kBins; ++k) {
    const double mass = chi2_cdf((k + 1) * width, histogram.dof) - chi2_cdf(k * width, histogram.dof);
    histogram.expected.push_back(mass / width);
  }
  return histogram;
}

}  // namespace waymark
