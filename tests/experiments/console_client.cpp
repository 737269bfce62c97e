#include "tests/experiments/console_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <stdexcept>

namespace haptrial::test {

RawClient::RawClient(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
    ::close(socket_);
    throw std::runtime_error("cannot connect");
  }
}

RawClient::~RawClient() { ::close(socket_); }

void RawClient::send(const std::string& text) {
  std::size_t sent = 0;
  while (sent < text.size()) {
    const ssize_t count = ::send(socket_, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (count <= 0) {
      return;  // the other side has closed; receive() tells
    }
    sent += static_cast<std::size_t>(count);
  }
}

std::string RawClient::receive(double seconds, const std::string& until) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::string all;
  while (std::chrono::steady_clock::now() < end) {
    pollfd watched{socket_, POLLIN, 0};
    if (::poll(&watched, 1, 10) <= 0) {
      continue;
    }
    std::array<char, 4096> piece;
    const ssize_t count = ::recv(socket_, piece.data(), piece.size(), 0);
    if (count <= 0) {
      closed_ = true;
      break;
    }
    all.append(piece.data(), static_cast<std::size_t>(count));
    if (!until.empty() && all.find(until) != std::string::npos) {
      break;
    }
  }
  return all;
}

std::string RawRequest::text() const {
  std::string out = method + " " + target + " HTTP/1.1\r\n";
  const auto add = [&out](const char* name, const std::optional<std::string>& value) {
    if (value) {
      out += std::string(name) + ": " + *value + "\r\n";
    }
  };
  add("Host", host);
  add("X-Haptrial-Token", token);
  if (method == "POST" || !body.empty()) {
    add("Content-Type", type);
    add("Content-Length", length ? length : std::to_string(body.size()));
  }
  return out + more + "\r\n" + body;
}

int status_of(const std::string& answer) {
  return answer.starts_with("HTTP/1.1 ") ? std::stoi(answer.substr(9, 3)) : 0;
}

}  // namespace haptrial::test
