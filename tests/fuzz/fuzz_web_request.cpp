// SPDX-License-Identifier: Apache-2.0
// Feeds what reads the parts of HTTP requests: target, host, origin and subprotocols, a line each.
#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "server/access.hpp"

namespace {

void require(bool condition) {
  if (!condition) std::abort();
}

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::string_view rest{reinterpret_cast<const char*>(data), size};
  std::array<std::string_view, 4> lines;
  for (std::string_view& line : lines) {
    line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
  }
  const auto& [target, host, origin, subprotocols] = lines;
  if (const auto parsed = saccade::server::parse_target(target)) {
    require(parsed->path.starts_with('/') && std::none_of(parsed->path.begin(), parsed->path.end(), is_control));
    const std::string header = saccade::server::attachment(parsed->path);
    require(std::none_of(header.begin(), header.end(), is_control));
  }
  const std::string name = saccade::server::host_name(host);
  require(name.size() <= host.size() && name.find_first_of("/@ \r\"") == std::string::npos);
  if (saccade::server::is_origin_of(origin, host)) require(origin.size() > host.size());
  const std::string_view value = saccade::server::offered_token(subprotocols);
  require(value.empty() || (value.data() >= subprotocols.data() && value.size() < subprotocols.size()));
  require(!saccade::server::is_same_token(host, target) || host == target);
  return 0;
}
