// SPDX-License-Identifier: Apache-2.0
#include "server/server_state.hpp"

#include <algorithm>
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
  if (config.foxglove_only) return;
  for (const PageFile& file : page_files()) {
    Fnv1a hash;
    for (const std::uint8_t byte : file.content) hash.add(std::uint64_t{byte});
    files.emplace(file.path, CachedFile{file, "\"" + hash.text() + "\""});
  }
}

ConnectionSlot ServerState::take_seat() {
  if (web_sockets >= config.max_connections) return nullptr;
  ++web_sockets;
  return {&web_sockets, [](std::atomic<std::size_t>* taken) { --*taken; }};
}

bool ServerState::make_room() {
  const auto least = std::min_element(sessions.begin(), sessions.end(),
                                      [](const auto& a, const auto& b) { return a.second->rank() < b.second->rank(); });
  if (least == sessions.end() || least->second->rank().has_token) return false;
  const std::shared_ptr<Session> session = least->second;  // it removes itself
  session->stop();
  return true;
}

void ServerState::ask_data(std::function<void()> work) {
  if (std::exchange(data_asked, true)) return data_waiting.push_back(std::move(work));
  service_thread.post(data_account, std::move(work));
}

void ServerState::data_answered() {
  data_asked = !data_waiting.empty();
  if (!data_asked) return;
  service_thread.post(data_account, std::move(data_waiting.front()));
  data_waiting.pop_front();
}

bool ServerState::is_host(std::string_view header, const std::string& local_address) const {
  const std::string name = host_name(header);
  return !name.empty() && (host_names.contains(name) || name == local_address);
}

}  // namespace saccade::server
