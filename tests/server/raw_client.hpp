// SPDX-License-Identifier: Apache-2.0
#pragma once
// RawClient: a socket that says to the server whatever a test likes, well formed or not.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace saccade::test {

inline constexpr std::string_view kToken{"a-token-for-tests"};

/// How a WebSocket begins its messages' kinds.
enum class Opcode : std::uint8_t { continuation = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

struct Frame {
  Opcode opcode{Opcode::continuation};
  bool last{true};
  std::string payload;

  /// Returns the code of a closing frame; 0 without one.
  [[nodiscard]] int close_code() const {
    if (opcode != Opcode::close || payload.size() < 2) return 0;
    return static_cast<unsigned char>(payload[0]) * 256 + static_cast<unsigned char>(payload[1]);
  }
};

struct Answer {
  int status{0};  ///< 0: the server closed the socket without one
  std::string head;
  std::string body;
};

/// A client's frame, under a mask of zeros unless it is to lack one.
inline std::string frame(Opcode opcode, std::string_view payload, bool last = true, bool masked = true) {
  std::string bytes;
  bytes += static_cast<char>((last ? 0x80 : 0) | static_cast<int>(opcode));
  const int mask = masked ? 0x80 : 0;
  const std::size_t size = payload.size();
  const auto append = [&bytes, size](int count) {
    for (int i = count - 1; i >= 0; --i) bytes += static_cast<char>((size >> (8U * static_cast<unsigned>(i))) & 0xffU);
  };
  if (size < 126) {
    bytes += static_cast<char>(mask | static_cast<int>(size));
  } else if (size < 65536) {
    bytes += static_cast<char>(mask | 126);
    append(2);
  } else {
    bytes += static_cast<char>(mask | 127);
    append(8);
  }
  if (masked) bytes.append(4, '\0');
  return bytes.append(payload);
}

class RawClient {
 public:
  /// @param receive_bytes of the kernel's buffer; 0: as it likes.
  explicit RawClient(std::uint16_t port, int receive_bytes = 0) : port_{port} {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (receive_bytes > 0) ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &receive_bytes, sizeof receive_bytes);
    const int on{1};
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      throw std::runtime_error{"cannot connect"};
    }
  }
  RawClient(RawClient&& other) noexcept
      : port_{other.port_}, socket_{std::exchange(other.socket_, -1)}, read_{std::move(other.read_)} {}
  RawClient& operator=(RawClient&&) = delete;
  ~RawClient() { close(); }

  void close() {
    if (socket_ >= 0) ::close(std::exchange(socket_, -1));
  }
  /// The server sees a broken connection, not an end.
  void reset() {
    const linger hard{1, 0};
    ::setsockopt(socket_, SOL_SOCKET, SO_LINGER, &hard, sizeof hard);
    close();
  }

  /// False once the server takes no more.
  bool send(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
  }
  /// As much as goes without waiting.
  [[nodiscard]] std::size_t send_some(std::string_view bytes) const {
    const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return sent > 0 ? static_cast<std::size_t>(sent) : 0U;
  }
  /// False at the server's end, or when nothing comes for as long.
  bool receive(std::chrono::milliseconds patience = std::chrono::seconds{30}) {
    pollfd waits{socket_, POLLIN, 0};
    if (::poll(&waits, 1, static_cast<int>(patience.count())) <= 0) return false;
    static thread_local std::array<char, 1U << 16U> bytes;
    const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
    if (count <= 0) return false;
    read_.append(bytes.data(), static_cast<std::size_t>(count));
    return true;
  }

  /// Tells whether the server has ended the socket, after everything that it sent.
  [[nodiscard]] bool is_ended() {
    while (receive(std::chrono::milliseconds{0})) {
    }
    pollfd waits{socket_, POLLIN, 0};
    return ::poll(&waits, 1, 0) > 0;
  }

  [[nodiscard]] std::string host() const { return "localhost:" + std::to_string(port_); }
  /// The header line with which a client shows the token.
  [[nodiscard]] static std::string token_line(std::string_view token = kToken) {
    return "Saccade-Token: " + std::string{token} + "\r\n";
  }

  /// Whole header lines besides Host and the token's.
  Answer get(const std::string& target, const std::string& headers = "") {
    return ask("GET " + target + " HTTP/1.1\r\nHost: " + host() + "\r\n" + token_line() + headers + "\r\n");
  }
  Answer ask(const std::string& request) {
    send(request);
    return read_answer(request.starts_with("HEAD "));
  }
  Answer read_answer(bool head_only = false) {
    std::size_t end{0};
    while ((end = read_.find("\r\n\r\n")) == std::string::npos) {
      if (!receive()) return {};
    }
    Answer answer;
    answer.head = read_.substr(0, end + 2);
    read_.erase(0, end + 4);
    answer.status = std::stoi(answer.head.substr(answer.head.find(' ')));
    const std::size_t length_at = answer.head.find("Content-Length: ");
    const std::size_t length =
        head_only || length_at == std::string::npos ? 0 : std::stoul(answer.head.substr(length_at + 16));
    while (read_.size() < length && receive()) {
    }
    answer.body = read_.substr(0, length);
    read_.erase(0, length);
    return answer;
  }

  [[nodiscard]] std::string upgrade_request(const std::string& headers) const {
    return "GET /socket HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
           "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
           headers + "\r\n";
  }
  /// 101, or why not.
  int upgrade() { return ask(upgrade_request("Host: " + host() + "\r\n" + token_line())).status; }

  bool send_message(std::string_view payload) const { return send(frame(Opcode::binary, payload)); }
  /// Nothing at the server's end.
  std::optional<Frame> read_frame(std::chrono::milliseconds patience = std::chrono::seconds{30}) {
    const auto have = [this, patience](std::size_t bytes) {
      while (read_.size() < bytes) {
        if (!receive(patience)) return false;
      }
      return true;
    };
    if (!have(2)) return std::nullopt;
    const auto byte = [this](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(read_[i])); };
    Frame read;
    read.last = (byte(0) & 0x80U) != 0;
    read.opcode = static_cast<Opcode>(byte(0) & 0x0fU);
    std::size_t length = byte(1) & 0x7fU;
    std::size_t head{2};
    if (length >= 126) {
      const std::size_t count = length == 126 ? 2 : 8;
      head += count;
      if (!have(head)) return std::nullopt;
      length = 0;
      for (std::size_t i = 0; i < count; ++i) length = length * 256 + byte(2 + i);
    }
    if (!have(head + length)) return std::nullopt;
    read.payload = read_.substr(head, length);
    read_.erase(0, head + length);
    return read;
  }
  /// The next message, its fragments joined; the payload of what closes with its code in front. Pings are answered.
  std::optional<Frame> read_message(std::chrono::milliseconds patience = std::chrono::seconds{30}) {
    Frame whole;
    bool begun{false};
    for (;;) {
      auto next = read_frame(patience);
      if (!next || next->opcode == Opcode::close) return next;
      if (next->opcode == Opcode::ping) send(frame(Opcode::pong, next->payload));
      if (next->opcode == Opcode::ping || next->opcode == Opcode::pong) continue;
      if (!std::exchange(begun, true)) whole.opcode = next->opcode;
      whole.payload += next->payload;
      if (next->last) return whole;
    }
  }
  /// The code with which the server closes, after whatever else it sends; 0: it closes without one.
  int read_close_code() {
    while (auto next = read_frame()) {
      if (next->opcode == Opcode::close) return next->close_code();
    }
    return 0;
  }

 private:
  std::uint16_t port_;
  int socket_{-1};
  std::string read_;
};

}  // namespace saccade::test
