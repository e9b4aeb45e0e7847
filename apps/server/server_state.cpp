// SPDX-License-Identifier: Apache-2.0
#include "server/server_state.hpp"

#include <utility>

#include "saccade/core/fnv1a.hpp"
#include "server/access.hpp"

namespace saccade::server {

std::shared_ptr<Connection> OpenConnections::find(ConnectionId id) {
  const std::lock_guard lock{mutex_};
  const auto found = connections_.find(id);
  return found == connections_.end() ? nullptr : found->second;
}

void OpenConnections::add(const std::shared_ptr<Connection>& connection) {
  const std::lock_guard lock{mutex_};
  connections_.emplace(connection->id(), connection);
}

void OpenConnections::remove(ConnectionId id) {
  const std::lock_guard lock{mutex_};
  connections_.erase(id);
}

ServerState::ServerState(ServerConfig server_config)
    : config{std::move(server_config)}, host_names{"localhost", "127.0.0.1", "::1"} {
  for (const std::string& name : config.host_names) host_names.insert(host_name(name));
  for (const PageFile& file : page_files()) {
    Fnv1a hash;
    for (const std::uint8_t byte : file.content) hash.add(std::uint64_t{byte});
    files.emplace(file.path, CachedFile{file, "\"" + hash.text() + "\""});
  }
}

bool ServerState::is_host(std::string_view header, const std::string& local_address) const {
  const std::string name = host_name(header);
  return !name.empty() && (host_names.contains(name) || name == local_address);
}

}  // namespace saccade::server
