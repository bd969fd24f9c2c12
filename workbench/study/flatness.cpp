#include "workbench/study/flatness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <Eigen/Core>

#include "waymark/core/cholesky.hpp"

namespace waymark::study {
namespace {

constexpr double kFall = 2.0;
constexpr double kPartOfFirstStep = 0.1;  // of a key's first step in the search
constexpr int kMostSteps = 9;
constexpr int kMaxInwards = 4;

/// One side of one key, followed outwards.
struct Side {
  std::vector<std::pair<double, double>> points;  // distance, fall; growing
  double reach = 0.0;                             // where it has fallen by kFall, or ends
  bool open = true;
};

double limit(const TuneKey& key, double at, int sign) {
  return std::abs(key.to_search(sign > 0 ? key.high : std::max(key.low, key.by_factor ? 1e-300 : key.low)) -
                  at);
}

/// Where a fall that grows with the square of the distance passes kFall between two points.
double crossing(const std::pair<double, double>& before, const std::pair<double, double>& after) {
  const auto root = [](double fall) { return std::sqrt(std::max(fall, 0.0)); };
  const double part = (std::sqrt(kFall) - root(before.second)) / (root(after.second) - root(before.second));
  return std::lerp(before.first, after.first, std::clamp(part, 0.0, 1.0));
}

/// Finds the reach of a side from its points.
void close(Side& side) {
  const auto fallen = [](const auto& point) { return point.second >= kFall; };
  const auto after = std::ranges::find_if(side.points, fallen);
  side.open = after == side.points.end();
  side.reach = side.open ? side.points.back().first : crossing(*std::prev(after), *after);
}

class Explorer {
 public:
  Explorer(const TuneProblem& problem, const TunePoint& optimum, const TuneLog::KeepGoing& keep_going)
      : problem_(problem), optimum_(optimum), keep_going_(keep_going) {}

  [[nodiscard]] std::optional<TuneScore> score(const TunePoint& at) const {
    ThreadPool alone(1);
    return problem_.score(at, {}, keep_going_, alone);
  }

  [[nodiscard]] TunePoint beside(std::size_t key, double distance) const {
    TunePoint at = optimum_;
    at[key] += distance;
    return at;
  }

  [[nodiscard]] std::optional<Side> follow(std::size_t key, int sign, double value) const {
    const double end = limit(problem_.keys()[key], optimum_[key], sign);
    Side side{{{0.0, 0.0}}, end, true};
    const auto look = [&](double distance) {
      const auto there = score(beside(key, sign * distance));
      if (there) side.points.emplace_back(distance, value - problem_.value(problem_.total(*there)));
      return there.has_value();
    };
    double distance = std::min(end, kPartOfFirstStep * problem_.keys()[key].first_step());
    double inwards = distance;
    for (int step = 0; step < kMostSteps && distance > side.points.back().first; ++step) {
      if (!look(distance)) return std::nullopt;
      if (side.points.back().second >= kFall) break;
      distance = std::min(end, 2.0 * distance);
    }
    for (int step = 0; step < kMaxInwards && side.points.size() > 1 && side.points[1].second >= kFall;
         ++step) {
      inwards *= 0.5;
      if (!look(inwards)) return std::nullopt;
      std::ranges::sort(side.points);
    }
    close(side);
    return side;
  }

 private:
  const TuneProblem& problem_;
  const TunePoint& optimum_;
  const TuneLog::KeepGoing& keep_going_;
};

using Sides = std::vector<std::array<Side, 2>>;  // below, above

/// Points of the quadratic: for each key one below and one above, for each pair of keys both up and both
/// down.
struct Quadratic {
  std::vector<std::size_t> keys;  // that have an end on both sides
  Eigen::VectorXd steps;
  std::vector<TuneScore> singles;  // 2 p: below, above
  std::vector<TuneScore> pairs;    // in the order of (i, j > i): both down, both up

  [[nodiscard]] std::size_t count() const { return keys.size(); }
};

std::vector<TunePoint> points_of(const Quadratic& quadratic, const TunePoint& optimum) {
  std::vector<TunePoint> points;
  const auto add = [&](std::initializer_list<std::size_t> moved, double sign) {
    points.push_back(optimum);
    for (const std::size_t i : moved)
      points.back()[quadratic.keys[i]] += sign * quadratic.steps[static_cast<Eigen::Index>(i)];
  };
  for (std::size_t i = 0; i < quadratic.count(); ++i)
    for (const double sign : {-1.0, 1.0}) add({i}, sign);
  for (std::size_t i = 0; i < quadratic.count(); ++i)
    for (std::size_t j = i + 1; j < quadratic.count(); ++j)
      for (const double sign : {-1.0, 1.0}) add({i, j}, sign);
  return points;
}

/// -d2 value / d at^2.
Eigen::MatrixXd curvature(const TuneProblem& problem, const Quadratic& quadratic, double value) {
  const auto n = static_cast<Eigen::Index>(quadratic.count());
  const auto fall = [&](const TuneScore& score) { return value - problem.value(problem.total(score)); };
  Eigen::VectorXd both(n);  // sum of the falls below and above
  for (Eigen::Index i = 0; i < n; ++i)
    both[i] = fall(quadratic.singles[static_cast<std::size_t>(2 * i)]) +
              fall(quadratic.singles[static_cast<std::size_t>(2 * i + 1)]);
  const Eigen::VectorXd& h = quadratic.steps;
  Eigen::MatrixXd H = both.cwiseQuotient(h.cwiseAbs2()).asDiagonal();
  std::size_t pair = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i + 1; j < n; ++j, ++pair)
      H(i, j) = H(j, i) =
          (fall(quadratic.pairs[2 * pair]) + fall(quadratic.pairs[2 * pair + 1]) - both[i] - both[j]) /
          (2.0 * h[i] * h[j]);
  return H;
}

/// Covariance of the slope: sum over the blocks of the outer products of their slopes, less the mean.
Eigen::MatrixXd slope_covariance(const Quadratic& quadratic) {
  const auto n = static_cast<Eigen::Index>(quadratic.count());
  std::vector<Eigen::VectorXd> slopes;
  for (std::size_t log = 0; log < quadratic.singles.front().size(); ++log)
    for (std::size_t block = 0; block < kTuneBlocks; ++block) {
      Eigen::VectorXd& slope = slopes.emplace_back(n);
      for (Eigen::Index i = 0; i < n; ++i) {
        const auto below = static_cast<std::size_t>(2 * i);
        slope[i] = (quadratic.singles[below + 1][log][block].log_likelihood -
                    quadratic.singles[below][log][block].log_likelihood) /
                   (2.0 * quadratic.steps[i]);
      }
    }
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(n);
  for (const auto& slope : slopes) mean += slope / static_cast<double>(slopes.size());
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(n, n);
  for (const auto& slope : slopes) J += (slope - mean) * (slope - mean).transpose();
  return J * static_cast<double>(slopes.size()) / static_cast<double>(slopes.size() - 1);
}

/// By how much the reach along one key grows for the sake of the other keys and of observations that depend
/// on each other; ones where the quadratic is no hill.
Eigen::VectorXd growth(const TuneProblem& problem, const Quadratic& quadratic, double value) {
  const auto n = static_cast<Eigen::Index>(quadratic.count());
  const Eigen::MatrixXd H = curvature(problem, quadratic, value);
  const Cholesky cholesky(H);
  if (!cholesky.is_positive_definite()) return Eigen::VectorXd::Ones(n);
  const Eigen::MatrixXd P = cholesky.solve(Eigen::MatrixXd(Eigen::MatrixXd::Identity(n, n)));
  Eigen::VectorXd variances = P.diagonal();
  if (problem.by() == TuneBy::kLikelihood)
    variances = variances.cwiseMax((P * slope_covariance(quadratic) * P).diagonal());
  return variances.cwiseProduct(H.diagonal()).cwiseSqrt().cwiseMax(1.0);
}

KeyFlatness flatness_of(const TuneKey& key, double at, const std::array<Side, 2>& sides, double growth) {
  KeyFlatness flatness;
  flatness.low = at - std::min(limit(key, at, -1), growth * sides[0].reach);
  flatness.high = at + std::min(limit(key, at, 1), growth * sides[1].reach);
  flatness.open_low = sides[0].open;
  flatness.open_high = sides[1].open;
  for (const auto& [distance, fall] : sides[0].points) flatness.slice.emplace_back(at - distance, -fall);
  for (const auto& [distance, fall] : sides[1].points)
    if (distance > 0.0) flatness.slice.emplace_back(at + distance, -fall);
  std::ranges::sort(flatness.slice);
  return flatness;
}

/// Where a side rose instead of falling.
void note_best(const Sides& sides, const TunePoint& optimum, Flatness& flatness) {
  for (std::size_t key = 0; key < sides.size(); ++key)
    for (std::size_t side = 0; side < 2; ++side)
      for (const auto& [distance, fall] : sides[key][side].points)
        if (-fall > flatness.gained) {
          flatness.gained = -fall;
          flatness.best = optimum;
          flatness.best[key] += side == 0 ? -distance : distance;
        }
}

/// Calls job(i) for all of them on several threads; false if any said no.
template <class Job>
bool run_all(std::size_t count, int threads, const Job& job) {
  std::vector<char> done(count);
  ThreadPool(threads).run(static_cast<int>(count), [&](int i) {
    done[static_cast<std::size_t>(i)] = job(static_cast<std::size_t>(i)) ? 1 : 0;
  });
  return std::ranges::all_of(done, [](char each) { return each != 0; });
}

Quadratic make_quadratic(const Sides& sides) {
  Quadratic quadratic;
  std::vector<double> steps;
  for (std::size_t key = 0; key < sides.size(); ++key)
    if (!sides[key][0].open && !sides[key][1].open) {
      quadratic.keys.push_back(key);
      steps.push_back(std::min(sides[key][0].reach, sides[key][1].reach));
    }
  quadratic.steps = Eigen::Map<Eigen::VectorXd>(steps.data(), static_cast<Eigen::Index>(steps.size()));
  return quadratic;
}

}  // namespace

std::optional<Flatness> find_flatness(const TuneProblem& problem, const TunePoint& optimum, int threads,
                                      const TuneLog::KeepGoing& keep_going) {
  const Explorer explorer(problem, optimum, keep_going);
  const auto centre = explorer.score(optimum);
  if (!centre) return std::nullopt;
  const double value = problem.value(problem.total(*centre));
  Sides sides(optimum.size());
  const bool followed = run_all(2 * sides.size(), threads, [&](std::size_t i) {
    auto side = explorer.follow(i / 2, i % 2 == 0 ? -1 : 1, value);
    if (side) sides[i / 2][i % 2] = *std::move(side);
    return side.has_value();
  });
  if (!followed) return std::nullopt;
  Quadratic quadratic = make_quadratic(sides);
  const auto points = points_of(quadratic, optimum);
  std::vector<TuneScore> scores(points.size());
  const bool scored = run_all(points.size(), threads, [&](std::size_t i) {
    auto score = explorer.score(points[i]);
    if (score) scores[i] = *std::move(score);
    return score.has_value();
  });
  if (!scored) return std::nullopt;
  const auto singles = static_cast<std::ptrdiff_t>(2 * quadratic.count());
  quadratic.singles.assign(scores.begin(), scores.begin() + singles);
  quadratic.pairs.assign(scores.begin() + singles, scores.end());
  Eigen::VectorXd grown = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(optimum.size()));
  if (quadratic.count() > 0) {
    const Eigen::VectorXd of_quadratic = growth(problem, quadratic, value);
    for (std::size_t i = 0; i < quadratic.count(); ++i)
      grown[static_cast<Eigen::Index>(quadratic.keys[i])] = of_quadratic[static_cast<Eigen::Index>(i)];
  }
  Flatness flatness{{}, optimum, 0.0};
  for (std::size_t key = 0; key < optimum.size(); ++key)
    flatness.keys.push_back(
        flatness_of(problem.keys()[key], optimum[key], sides[key], grown[static_cast<Eigen::Index>(key)]));
  note_best(sides, optimum, flatness);
  return flatness;
}

}  // namespace waymark::study
