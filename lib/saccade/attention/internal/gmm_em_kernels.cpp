// SPDX-License-Identifier: Apache-2.0
#include "saccade/attention/internal/gmm_em_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "saccade/attention/internal/gmm_em_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<double, kMixtureLanes>;
using V = hn::Vec<Tag>;

HWY_INLINE V set(double value) { return hn::Set(Tag{}, value); }

/// Returns e^x for x ≤ 0, within 1e-14 of its value; below -700 that of -700.
HWY_INLINE V exp_of(V x) {
  constexpr double kRound{0x1.8p52};  // added, it leaves the nearest whole number in the lowest bits
  constexpr double kLn2High{0x1.62e42feep-1};
  constexpr double kLn2Low{0x1.a39ef35793c76p-33};
  constexpr std::array kInverseFactorials{
      1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0, 1.0 / 720.0,
      1.0 / 120.0,      1.0 / 24.0,      1.0 / 6.0,      0.5,           1.0,          1.0};
  x = hn::Max(x, set(-700.0));
  const V shifted = hn::Add(hn::Mul(x, set(std::numbers::log2e)), set(kRound));
  const V n = hn::Sub(shifted, set(kRound));
  const V r = hn::Sub(hn::Sub(x, hn::Mul(n, set(kLn2High))), hn::Mul(n, set(kLn2Low)));
  V p = set(kInverseFactorials[0]);
  for (std::size_t i = 1; i < kInverseFactorials.size(); ++i) p = hn::Add(hn::Mul(p, r), set(kInverseFactorials[i]));
  const hn::RebindToSigned<Tag> di;
  return hn::BitCast(Tag{}, hn::Add(hn::BitCast(di, p), hn::ShiftLeft<52>(hn::BitCast(di, shifted))));
}

struct Difference {
  V x, y, z, t;
};

HWY_INLINE Difference difference(const MixtureSamples& samples, const MixtureDensity& density, std::size_t at) {
  const Tag d;
  return {hn::Sub(hn::LoadU(d, samples.planes[0].data() + at), set(density.mean[0])),
          hn::Sub(hn::LoadU(d, samples.planes[1].data() + at), set(density.mean[1])),
          hn::Sub(hn::LoadU(d, samples.planes[2].data() + at), set(density.mean[2])),
          hn::Sub(hn::LoadU(d, samples.planes[3].data() + at), set(density.mean[3]))};
}

/// Working memory for one block of samples and all Gaussians.
struct Workspace {
  std::vector<double> values;      ///< kMixtureBlock per Gaussian: log densities, then their exponentials
  std::vector<double> bounds;      ///< per Gaussian: upper bound of its log density in the block
  std::vector<std::size_t> order;  ///< Gaussians by decreasing bound; only the first `near` matter
  std::size_t near{0};
  alignas(64) std::array<double, kMixtureBlock> largest{};
  alignas(64) std::array<double, kMixtureBlock> total{};
};

void order_by_bound(const MixtureSamples& samples, std::span<const MixtureDensity> mixture, std::size_t begin,
                    Workspace& work) {
  const double* const times = samples.planes[3].data() + begin;
  const auto [first, last] = std::minmax_element(times, times + kMixtureBlock);
  for (std::size_t k = 0; k < mixture.size(); ++k) {
    const double away = std::max({*first - mixture[k].mean[3], mixture[k].mean[3] - *last, 0.0});
    work.bounds[k] = mixture[k].log_scale - 0.5 * away * away * mixture[k].time_precision;
    work.order[k] = k;
  }
  std::sort(work.order.begin(), work.order.end(), [&](std::size_t a, std::size_t b) {
    return work.bounds[a] != work.bounds[b] ? work.bounds[a] > work.bounds[b] : a < b;
  });
}

/// Computes log densities of one Gaussian, and updates the largest ones; returns the smallest of these.
HWY_INLINE double add_log_densities(const MixtureSamples& samples, const MixtureDensity& density, std::size_t begin,
                                    double* values, double* largest) {
  const Tag d;
  const std::array<double, 10>& W = density.W;
  V smallest = set(HUGE_VAL);
  for (std::size_t i = 0; i < kMixtureBlock; i += hn::Lanes(d)) {
    const Difference v = difference(samples, density, begin + i);
    const V a = hn::Mul(set(W[0]), v.x);
    const V b = hn::Add(hn::Mul(set(W[1]), v.x), hn::Mul(set(W[2]), v.y));
    const V c = hn::Add(hn::Add(hn::Mul(set(W[3]), v.x), hn::Mul(set(W[4]), v.y)), hn::Mul(set(W[5]), v.z));
    const V e = hn::Add(hn::Add(hn::Mul(set(W[6]), v.x), hn::Mul(set(W[7]), v.y)),
                        hn::Add(hn::Mul(set(W[8]), v.z), hn::Mul(set(W[9]), v.t)));
    const V squares = hn::Add(hn::Add(hn::Mul(a, a), hn::Mul(b, b)), hn::Add(hn::Mul(c, c), hn::Mul(e, e)));
    const V value = hn::Sub(set(density.log_scale), hn::Mul(set(0.5), squares));
    hn::StoreU(value, d, values + i);
    const V now = hn::Max(hn::LoadU(d, largest + i), value);
    hn::StoreU(now, d, largest + i);
    smallest = hn::Min(smallest, now);
  }
  return hn::GetLane(hn::MinOfLanes(d, smallest));
}

/// Computes the near Gaussians' values, and `largest`, of a block.
void log_densities(const MixtureSamples& samples, std::span<const MixtureDensity> mixture, std::size_t begin,
                   Workspace& work) {
  constexpr double kNothing{-40.0};
  order_by_bound(samples, mixture, begin, work);
  work.largest.fill(-HUGE_VAL);
  double floor = -HUGE_VAL;
  for (work.near = 0; work.near < mixture.size(); ++work.near) {
    const std::size_t k = work.order[work.near];
    if (work.bounds[k] < floor + kNothing) break;
    floor = add_log_densities(samples, mixture[k], begin, work.values.data() + k * kMixtureBlock, work.largest.data());
  }
}

/// Computes exponentials relative to the largest density, and their sums.
void exponentials(Workspace& work) {
  const Tag d;
  work.total.fill(0.0);
  for (std::size_t n = 0; n < work.near; ++n) {
    double* const values = work.values.data() + work.order[n] * kMixtureBlock;
    for (std::size_t i = 0; i < kMixtureBlock; i += hn::Lanes(d)) {
      const V e = exp_of(hn::Sub(hn::LoadU(d, values + i), hn::Load(d, work.largest.data() + i)));
      hn::StoreU(e, d, values + i);
      hn::Store(hn::Add(hn::Load(d, work.total.data() + i), e), d, work.total.data() + i);
    }
  }
}

/// Adds the moments of one Gaussian in a block; `inverse` is 1 / total, and 0 beyond the last sample.
HWY_INLINE void add_moments(const MixtureSamples& samples, const MixtureDensity& density, std::size_t begin,
                            const double* values, const double* inverse, MixtureMoments& moments) {
  const Tag d;
  for (std::size_t lane = 0; lane < kMixtureLanes; lane += hn::Lanes(d)) {
    const auto sum = [&moments, lane](std::size_t i) HWY_ATTR { return moments.lanes[i].data() + lane; };
    V s0 = hn::Load(d, sum(0)), s1 = hn::Load(d, sum(1)), s2 = hn::Load(d, sum(2)), s3 = hn::Load(d, sum(3));
    V s4 = hn::Load(d, sum(4)), s5 = hn::Load(d, sum(5)), s6 = hn::Load(d, sum(6)), s7 = hn::Load(d, sum(7));
    V s8 = hn::Load(d, sum(8)), s9 = hn::Load(d, sum(9)), s10 = hn::Load(d, sum(10)), s11 = hn::Load(d, sum(11));
    V s12 = hn::Load(d, sum(12)), s13 = hn::Load(d, sum(13)), s14 = hn::Load(d, sum(14));
    for (std::size_t i = lane; i < kMixtureBlock; i += kMixtureLanes) {
      const Difference v = difference(samples, density, begin + i);
      const V r = hn::Mul(hn::LoadU(d, values + i), hn::Load(d, inverse + i));
      const V rx = hn::Mul(r, v.x), ry = hn::Mul(r, v.y), rz = hn::Mul(r, v.z), rt = hn::Mul(r, v.t);
      s0 = hn::Add(s0, r);
      s1 = hn::Add(s1, rx);
      s2 = hn::Add(s2, ry);
      s3 = hn::Add(s3, rz);
      s4 = hn::Add(s4, rt);
      s5 = hn::Add(s5, hn::Mul(rx, v.x));
      s6 = hn::Add(s6, hn::Mul(ry, v.x));
      s7 = hn::Add(s7, hn::Mul(ry, v.y));
      s8 = hn::Add(s8, hn::Mul(rz, v.x));
      s9 = hn::Add(s9, hn::Mul(rz, v.y));
      s10 = hn::Add(s10, hn::Mul(rz, v.z));
      s11 = hn::Add(s11, hn::Mul(rt, v.x));
      s12 = hn::Add(s12, hn::Mul(rt, v.y));
      s13 = hn::Add(s13, hn::Mul(rt, v.z));
      s14 = hn::Add(s14, hn::Mul(rt, v.t));
    }
    hn::Store(s0, d, sum(0)), hn::Store(s1, d, sum(1)), hn::Store(s2, d, sum(2)), hn::Store(s3, d, sum(3));
    hn::Store(s4, d, sum(4)), hn::Store(s5, d, sum(5)), hn::Store(s6, d, sum(6)), hn::Store(s7, d, sum(7));
    hn::Store(s8, d, sum(8)), hn::Store(s9, d, sum(9)), hn::Store(s10, d, sum(10)), hn::Store(s11, d, sum(11));
    hn::Store(s12, d, sum(12)), hn::Store(s13, d, sum(13)), hn::Store(s14, d, sum(14));
  }
}

/// Returns Σ largest + log total over the samples of a block; turns `total` into its inverse.
double finish_block(std::size_t samples, Workspace& work) {
  constexpr std::size_t kFactors{8};  // totals lie in [1, Gaussians]: their product stays small
  double log_likelihood{0.0};
  for (std::size_t i = 0; i < samples; i += kFactors) {
    double product{1.0};
    for (std::size_t j = i; j < std::min(i + kFactors, samples); ++j) {
      log_likelihood += work.largest[j];
      product *= work.total[j];
    }
    log_likelihood += std::log(product);
  }
  for (double& total : work.total) total = 1.0 / total;
  std::fill(work.total.begin() + static_cast<std::ptrdiff_t>(samples), work.total.end(), 0.0);
  return log_likelihood;
}

double expect(const MixtureSamples& samples, std::span<const MixtureDensity> mixture,
              std::span<MixtureMoments> moments) {
  Workspace work;
  work.values.resize(mixture.size() * kMixtureBlock);
  work.bounds.resize(mixture.size());
  work.order.resize(mixture.size());
  double log_likelihood{0.0};
  for (std::size_t begin = 0; begin < samples.count; begin += kMixtureBlock) {
    log_densities(samples, mixture, begin, work);
    exponentials(work);
    log_likelihood += finish_block(std::min(kMixtureBlock, samples.count - begin), work);
    for (std::size_t n = 0; n < work.near; ++n) {
      const std::size_t k = work.order[n];
      add_moments(samples, mixture[k], begin, work.values.data() + k * kMixtureBlock, work.total.data(), moments[k]);
    }
  }
  return log_likelihood;
}

}  // namespace
}  // namespace saccade::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade {
namespace {

HWY_EXPORT(expect);

}  // namespace

double MixtureMoments::sum(std::size_t i) const {
  const std::array<double, kMixtureLanes>& v = lanes[i];
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

double expect_mixture(const MixtureSamples& samples, std::span<const MixtureDensity> mixture,
                      std::span<MixtureMoments> moments) {
  return HWY_DYNAMIC_DISPATCH(expect)(samples, mixture, moments);
}

}  // namespace saccade
#endif  // HWY_ONCE
