#include "workbench/study/maximise.hpp"

#include <cmath>
#include <memory>

#include <nlopt.h>

namespace waymark::study {
namespace {

constexpr int kMaxRestarts = 3;
// What a restart must gain to be worth another.
constexpr double kWorthwhile = 0.1;

struct Destroy {
  void operator()(nlopt_opt opt) const { nlopt_destroy(opt); }
};
using Optimizer = std::unique_ptr<nlopt_opt_s, Destroy>;

/// What NLopt calls, and the best that it has seen.
struct Search {
  const std::function<std::optional<double>(const std::vector<double>&)>* f = nullptr;
  Maximum best;
  nlopt_opt optimizer = nullptr;

  double look(const std::vector<double>& at) {
    const auto value = (*f)(at);
    if (!value) {
      best.stopped = true;
      if (optimizer != nullptr) nlopt_force_stop(optimizer);
      return -HUGE_VAL;
    }
    ++best.evaluations;
    if (best.at.empty() || *value > best.value) best.at = at, best.value = *value;
    return *value;
  }
};

double look(unsigned count, const double* at, double* /*gradient*/, void* search) {
  return static_cast<Search*>(search)->look({at, at + count});
}

Optimizer make_optimizer(const SearchBox& box, double resolution) {
  const auto dimension = static_cast<unsigned>(box.start.size());
  Optimizer optimizer(nlopt_create(dimension == 1 ? NLOPT_LN_SBPLX : NLOPT_LN_BOBYQA, dimension));
  nlopt_set_lower_bounds(optimizer.get(), box.low.data());
  nlopt_set_upper_bounds(optimizer.get(), box.high.data());
  nlopt_set_xtol_abs1(optimizer.get(), resolution);
  nlopt_set_maxeval(optimizer.get(), 60 + 40 * static_cast<int>(dimension));
  return optimizer;
}

/// Once from where the best is.
void climb(const SearchBox& box, double scale, double resolution, Search& search) {
  const Optimizer optimizer = make_optimizer(box, resolution);
  std::vector<double> steps = box.step;
  for (double& step : steps) step *= scale;
  nlopt_set_initial_step(optimizer.get(), steps.data());
  nlopt_set_max_objective(optimizer.get(), look, &search);
  search.optimizer = optimizer.get();
  std::vector<double> at = search.best.at;
  double value = 0.0;
  nlopt_optimize(optimizer.get(), at.data(), &value);  // whatever ends it, the best is kept
  search.optimizer = nullptr;
}

}  // namespace

Maximum maximise(const std::function<std::optional<double>(const std::vector<double>&)>& f,
                 const SearchBox& box, double resolution) {
  Search search{&f, {}, nullptr};
  search.look(box.start);
  if (search.best.stopped) return {box.start, 0.0, 0, true};
  for (int restart = 0; restart <= kMaxRestarts && !search.best.stopped; ++restart) {
    const double before = search.best.value;
    climb(box, restart == 0 ? 1.0 : 0.3, resolution, search);
    if (restart > 0 && search.best.value < before + kWorthwhile) break;
  }
  return search.best;
}

}  // namespace waymark::study
