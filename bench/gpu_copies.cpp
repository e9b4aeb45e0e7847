// SPDX-License-Identifier: Apache-2.0
#include "gpu_copies.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "gpu_report.hpp"
#include "saccade/core/clock.hpp"

namespace saccade::bench {

using internal::cuda::Buffer;

Result<CopyRates> check_copies(internal::cuda::Compute& device, bool quick) {
  const std::size_t bytes = std::size_t{quick ? 16U : 256U} << 20U;
  std::vector<std::uint8_t> host(bytes, 1);
  Buffer<std::uint8_t> from{device};
  Buffer<std::uint8_t> to{device};
  SACCADE_CHECK(from.reserve(bytes));
  SACCADE_CHECK(to.reserve(bytes));
  const auto gbs = [&](double ms, double times) { return times * static_cast<double>(bytes) / (1e6 * ms); };
  std::vector<double> sent;
  std::vector<double> read;
  std::vector<double> within;
  for (int round = 0; round < (quick ? 2 : 10); ++round) {
    Stopwatch clock;
    SACCADE_CHECK(device.copy_in(from.data(), host.data(), bytes));
    SACCADE_CHECK(device.finish());
    const double sent_ms = clock.lap_ms();
    SACCADE_CHECK(device.copy_within(to.data(), from.data(), bytes));
    SACCADE_CHECK(device.finish());
    const double within_ms = clock.lap_ms();
    SACCADE_CHECK(device.copy_out(host.data(), to.data(), bytes));
    SACCADE_CHECK(device.finish());
    const double read_ms = clock.lap_ms();
    if (round == 0) continue;  // memory is touched for the first time
    sent.push_back(gbs(sent_ms, 1.0));
    within.push_back(gbs(within_ms, 2.0));
    read.push_back(gbs(read_ms, 1.0));
  }
  const CopyRates rates{median(sent), median(read), median(within)};
  std::printf(" \"copies\": {\"mib\": %zu, \"to_gpu_gbs\": %.1f, \"from_gpu_gbs\": %.1f, \"memory_gbs\": %.1f},\n",
              bytes >> 20U, rates.to_gpu_gbs, rates.from_gpu_gbs, rates.memory_gbs);
  return rates;
}

LeastBytes& LeastBytes::operator+=(const LeastBytes& other) {
  sent += other.sent;
  read += other.read;
  memory += other.memory;
  return *this;
}

LeastBytes link_bytes(const GpuTraffic& before, const GpuTraffic& after) {
  LeastBytes bytes;
  bytes.sent = static_cast<double>(after.bytes_sent - before.bytes_sent);
  bytes.read = static_cast<double>(after.bytes_read - before.bytes_read);
  return bytes;
}

std::string share_of_rates(const CopyRates& rates, const LeastBytes& bytes, double took_ms) {
  const double memory_gbs = bytes.memory / (1e6 * took_ms);
  const double link_ms = bytes.sent / (1e6 * rates.to_gpu_gbs) + bytes.read / (1e6 * rates.from_gpu_gbs);
  std::array<char, 240> text{};
  std::snprintf(text.data(), text.size(),
                "\"least\": {\"sent_kib\": %.1f, \"read_kib\": %.1f, \"memory_kib\": %.1f, \"memory_gbs\": %.3f, "
                "\"share_of_memory_rate\": %.5f, \"share_of_time_for_link\": %.4f}",
                bytes.sent / 1024.0, bytes.read / 1024.0, bytes.memory / 1024.0, memory_gbs,
                memory_gbs / rates.memory_gbs, link_ms / took_ms);
  return text.data();
}

}  // namespace saccade::bench
