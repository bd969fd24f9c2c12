#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace waymark::study {

/// Where a function is searched.
struct SearchBox {
  std::vector<double> start;
  std::vector<double> low;
  std::vector<double> high;
  std::vector<double> step;  ///< how far the first look goes
};

struct Maximum {
  std::vector<double> at;
  double value = 0.0;
  int evaluations = 0;
  bool stopped = false;  ///< the function gave nothing: the best until then
};

/// The largest value of `f` in the box that can be climbed to from its start, without derivatives: Powell's
/// BOBYQA (2009), begun anew where it ends until that finds no more, or Rowan's subplex (1990) in one
/// dimension. Small steps of `f`, as a gate makes them, do no harm. Ends where looks no farther apart than
/// `resolution` would gain next to nothing. `f` may give nothing to stop. The start counts: nothing worse is
/// returned.
[[nodiscard]] Maximum maximise(const std::function<std::optional<double>(const std::vector<double>&)>& f,
                               const SearchBox& box, double resolution);

}  // namespace waymark::study
