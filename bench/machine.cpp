// SPDX-License-Identifier: Apache-2.0
// Peak rates of this machine with its widest vectors: the bounds for other measurements.
// Argument: threads. bytes_per_second, items_per_second: of all threads together.
#include <benchmark/benchmark.h>

#include <functional>
#include <numeric>
#include <vector>

#include "machine_kernels.hpp"
#include "saccade/core/executor.hpp"

namespace {

using namespace saccade;
using bench::Work;

constexpr std::size_t kMemory{std::size_t{1} << 26};  ///< floats, 256 MiB: more than any cache
constexpr std::size_t kCache{std::size_t{1} << 16};   ///< 256 KiB: within the second-level cache

/// Every thread does the work of its number at the same time; returns the operations of all.
double on_threads(const benchmark::State& state, const std::function<Work(std::size_t thread)>& work) {
  const auto threads = static_cast<std::size_t>(state.range(0));
  std::vector<double> operations(threads);
  Executor::with_threads(threads).parallel_for(threads, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Work done = work(i);
      benchmark::DoNotOptimize(done.value);
      operations[i] = static_cast<double>(done.operations);
    }
  });
  return std::accumulate(operations.begin(), operations.end(), 0.0);
}

void rate(benchmark::State& state, const char* name, double operations) {
  state.counters[name] = benchmark::Counter{operations, benchmark::Counter::kIsRate};
}

void read_memory(benchmark::State& state) {
  const std::vector<float> values(kMemory, 1.0F);
  const auto threads = static_cast<std::size_t>(state.range(0));
  const std::size_t share = kMemory / threads;
  double values_read{0.0};
  for (auto _ : state) {
    values_read += on_threads(
        state, [&](std::size_t thread) { return bench::sum_of(std::span{values}.subspan(thread * share, share)); });
  }
  rate(state, "bytes_per_second", sizeof(float) * values_read);
}

void read_cache(benchmark::State& state) {
  const std::vector<float> values(kCache, 1.0F);
  double values_read{0.0};
  for (auto _ : state) {
    values_read += on_threads(state, [&](std::size_t) {
      Work all;
      for (int i = 0; i < 200; ++i) {
        const Work done = bench::sum_of(values);
        all = {all.value + done.value, all.operations + done.operations};
      }
      return all;
    });
  }
  rate(state, "bytes_per_second", sizeof(float) * values_read);
}

void multiply_and_add(benchmark::State& state) {
  double operations{0.0};
  for (auto _ : state) operations += on_threads(state, [](std::size_t) { return bench::multiply_and_add(1 << 20); });
  rate(state, "items_per_second", operations);
}

void look_up(benchmark::State& state) {
  const std::vector<std::int32_t> table(kCache, 1);
  double operations{0.0};
  for (auto _ : state) operations += on_threads(state, [&](std::size_t) { return bench::look_up(table, 1 << 18); });
  rate(state, "items_per_second", operations);
}

void on_one_and_two(benchmark::internal::Benchmark* row) {
  row->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();
}
BENCHMARK(read_memory)->Apply(on_one_and_two);
BENCHMARK(read_cache)->Apply(on_one_and_two);
BENCHMARK(multiply_and_add)->Apply(on_one_and_two);
BENCHMARK(look_up)->Apply(on_one_and_two);

}  // namespace

BENCHMARK_MAIN();
