// The kernels of an EKF-SLAM step at 10 range-bearing observations (D = 20), by state size n = 3 + 2
// landmarks.
#include <array>

#include <benchmark/benchmark.h>

#include "waymark/core/aligned_array.hpp"
#include "waymark/kernels/add_scaled_rows.hpp"
#include "waymark/kernels/layout.hpp"
#include "waymark/kernels/symmetric_rows.hpp"
#include "waymark/kernels/symmetric_update.hpp"
#include "waymark/kernels/triangular_solve.hpp"

namespace waymark::kernels {
namespace {

constexpr std::size_t kD = 20;

// A well-conditioned step whose values stay of order one however often it is repeated.
struct Step {
  explicit Step(std::size_t size)
      : n(size), ld(padded_stride(size)), P(ld * n), W(ld * kD), x(ld), d(ld), L(kD * kD) {
    for (std::size_t i = 0; i < ld * n; ++i) P[i] = 1.0;
    for (std::size_t i = 0; i < ld * kD; ++i) W[i] = 1e-9;
    for (std::size_t i = 0; i < kD; ++i) L[i * kD + i] = 1.0;
  }

  std::size_t n, ld;
  AlignedArray<double> P, W, x, d, L;
};

void report_flops(benchmark::State& state, double flops) {
  state.counters["flop/s"] = benchmark::Counter(flops, benchmark::Counter::kIsIterationInvariantRate);
}

double update_flops(const Step& step) { return static_cast<double>(step.n * step.n * kD); }

void downdate(benchmark::State& state) {
  Step s(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) symmetric_downdate(s.P.data(), s.ld, s.n, s.W.data(), s.ld, kD, {0, s.n});
  report_flops(state, update_flops(s));
}

void downdate_plain(benchmark::State& state) {
  Step s(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    reference::symmetric_update(s.P.data(), s.ld, s.n, s.W.data(), s.ld, kD, nullptr, nullptr);
  }
  report_flops(state, update_flops(s));
}

void downdate_and_shear(benchmark::State& state) {
  Step s(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) {
    symmetric_update(s.P.data(), s.ld, s.n, s.W.data(), s.ld, kD, s.d.data(), s.x.data(), {0, s.n});
  }
  report_flops(state, update_flops(s));
}

void project_ten_landmarks(benchmark::State& state) {
  Step s(static_cast<std::size_t>(state.range(0)));
  const std::array<double, 10> H{1.0, 0.0, 1.0, -1.0, 0.0, 0.0, 1.0, 1.0, 0.0, -1.0};
  for (auto _ : state) {
    for (std::size_t k = 0; k < 10; ++k) {
      const std::size_t landmark = 3 + 2 * (k * (s.n - 5) / 20);
      const std::array<std::size_t, 5> rows{0, 1, 2, landmark, landmark + 1};
      project_rows(s.P.data(), s.ld, s.n, rows.data(), rows.size(), H.data(), 2, &s.W[2 * k * s.ld], s.ld);
    }
  }
}

void solve(benchmark::State& state) {
  Step s(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) triangular_solve(s.L.data(), kD, kD, s.W.data(), s.ld, s.n);
  report_flops(state, static_cast<double>(s.n * kD * kD));
}

void increment(benchmark::State& state) {
  Step s(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) add_scaled_rows(s.x.data(), s.W.data(), s.ld, kD, s.L.data(), s.n);
}

void carry_robot_rows(benchmark::State& state) {
  Step s(static_cast<std::size_t>(state.range(0)));
  const std::array<double, 9> F{1.0, 0.0, -1e-9, 0.0, 1.0, 1e-9, 0.0, 0.0, 1.0};
  for (auto _ : state) transform_leading_rows(s.P.data(), s.ld, s.n, F.data(), 3);
}

void sizes(benchmark::internal::Benchmark* bench) { bench->Arg(403)->Arg(2003)->Arg(4003); }

BENCHMARK(downdate)->Apply(sizes);
BENCHMARK(downdate_and_shear)->Apply(sizes);
BENCHMARK(downdate_plain)->Apply(sizes);
BENCHMARK(project_ten_landmarks)->Apply(sizes);
BENCHMARK(solve)->Apply(sizes);
BENCHMARK(increment)->Apply(sizes);
BENCHMARK(carry_robot_rows)->Apply(sizes);

}  // namespace
}  // namespace waymark::kernels
