// SPDX-License-Identifier: Apache-2.0
#include "machine_kernels.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "machine_kernels.cpp"
#include "saccade/core/simd_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace saccade::bench::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;
using IntTag = hn::RebindToSigned<Tag>;
using V = hn::Vec<Tag>;
using I = hn::Vec<IntTag>;

Work sum_of(std::span<const float> values) {
  const Tag d;
  const std::size_t lanes = hn::Lanes(d);
  V a = hn::Zero(d);
  V b = hn::Zero(d);
  V c = hn::Zero(d);
  V e = hn::Zero(d);
  std::size_t i{0};
  for (; i + 4 * lanes <= values.size(); i += 4 * lanes) {
    const float* at = values.data() + i;
    a = hn::Add(a, hn::LoadU(d, at));
    b = hn::Add(b, hn::LoadU(d, at + lanes));
    c = hn::Add(c, hn::LoadU(d, at + 2 * lanes));
    e = hn::Add(e, hn::LoadU(d, at + 3 * lanes));
  }
  return {hn::GetLane(hn::SumOfLanes(d, hn::Add(hn::Add(a, b), hn::Add(c, e)))), i};
}

Work multiply_and_add(std::size_t rounds) {
  const Tag d;
  const V factor = hn::Set(d, 0.999F);
  const V addend = hn::Set(d, 0.001F);
  V a = hn::Iota(d, 0.0F);
  V b = hn::Iota(d, 1.0F);
  V c = hn::Iota(d, 2.0F);
  V e = hn::Iota(d, 3.0F);
  V f = hn::Iota(d, 4.0F);
  V g = hn::Iota(d, 5.0F);
  V h = hn::Iota(d, 6.0F);
  V k = hn::Iota(d, 7.0F);
  const auto step = [&](V& x) { x = hn::Add(hn::Mul(x, factor), addend); };
  for (std::size_t i = 0; i < rounds; ++i) {
    step(a);
    step(b);
    step(c);
    step(e);
    step(f);
    step(g);
    step(h);
    step(k);
  }
  const V sum = hn::Add(hn::Add(hn::Add(a, b), hn::Add(c, e)), hn::Add(hn::Add(f, g), hn::Add(h, k)));
  return {hn::GetLane(hn::SumOfLanes(d, sum)), rounds * 16 * hn::Lanes(d)};
}

Work look_up(std::span<const std::int32_t> table, std::size_t rounds) {
  const IntTag di;
  const I within = hn::Set(di, static_cast<std::int32_t>(table.size() - 1));
  const I step = hn::Set(di, 40503);  // odd: comes to every place
  I at = hn::Mul(hn::Iota(di, 1), hn::Set(di, 7919));
  I sum = hn::Zero(di);
  for (std::size_t i = 0; i < rounds; ++i) {
    for (int part = 0; part < 4; ++part) {
      at = hn::Add(at, step);
      sum = hn::Add(sum, hn::GatherIndex(di, table.data(), hn::And(at, within)));
    }
  }
  return {static_cast<float>(hn::GetLane(hn::SumOfLanes(di, sum))), rounds * 4 * hn::Lanes(di)};
}

}  // namespace
}  // namespace saccade::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace saccade::bench {
namespace {

HWY_EXPORT(sum_of);
HWY_EXPORT(multiply_and_add);
HWY_EXPORT(look_up);

}  // namespace

Work sum_of(std::span<const float> values) { return HWY_DYNAMIC_DISPATCH(sum_of)(values); }
Work multiply_and_add(std::size_t rounds) { return HWY_DYNAMIC_DISPATCH(multiply_and_add)(rounds); }
Work look_up(std::span<const std::int32_t> table, std::size_t rounds) {
  return HWY_DYNAMIC_DISPATCH(look_up)(table, rounds);
}

}  // namespace saccade::bench
#endif  // HWY_ONCE
