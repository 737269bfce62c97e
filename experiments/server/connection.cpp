#include "experiments/server/connection.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include "core/base/error.h"

namespace haptrial::experiments {
namespace {

using Clock = std::chrono::steady_clock;

Clock::time_point after(Connection::Duration time) {
  return Clock::now() + std::chrono::duration_cast<Clock::duration>(time);
}

/// Rounded up, so that a wait never turns into a busy loop.
int milliseconds_until(Clock::time_point deadline) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now()).count();
  return static_cast<int>(std::clamp<std::int64_t>(left, 0, 60'000));
}

}  // namespace

StopEvent::StopEvent() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (descriptor_ < 0) {
    throw RunError(fmt::format("the server cannot make an event: {}", std::strerror(errno)));
  }
}

StopEvent::~StopEvent() { ::close(descriptor_); }

void StopEvent::set() noexcept {
  const std::uint64_t one = 1;
  // The pipe is never full: it is written once.
  [[maybe_unused]] const ssize_t written = ::write(descriptor_, &one, sizeof one);
}

Connection::Connection(int socket, const StopEvent& stop, const std::atomic<bool>& crowded,
                       std::size_t max_bytes, Duration time)
    : socket_(socket),
      stop_(stop.descriptor()),
      crowded_(crowded),
      max_bytes_(max_bytes),
      start_(Clock::now()),
      deadline_(after(time)) {}

void Connection::set_deadline(Duration time) { deadline_ = after(time); }

bool Connection::in_the_way() const {
  constexpr auto kGrace = std::chrono::milliseconds(50);
  return !trusted_ && crowded_.load(std::memory_order_relaxed) && Clock::now() > start_ + kGrace;
}

bool Connection::ready(short events) {
  constexpr int kSlice = 25;  // between two looks at the crowd [ms]
  std::array<pollfd, 2> watched{{{socket_, events, 0}, {stop_, POLLIN, 0}}};
  for (;;) {
    const int left = milliseconds_until(deadline_);
    const int count = ::poll(watched.data(), watched.size(), std::min(left, kSlice));
    const bool writable = (watched[0].revents & POLLOUT) != 0;
    if (count > 0 && watched[1].revents != 0 && !writable) {
      trouble_ = Trouble::kStopped;
    } else if (left == 0 || (events == POLLIN && in_the_way()) || (count < 0 && errno != EINTR)) {
      trouble_ = Trouble::kTooSlow;
    } else if (count <= 0) {
      continue;
    }
    return trouble_ == Trouble::kNone;
  }
}

bool Connection::fill() {
  if (received_ >= max_bytes_) {
    trouble_ = Trouble::kTooLarge;
    return false;
  }
  buffer_.resize(std::min<std::size_t>(2048, max_bytes_ - received_));
  used_ = 0;
  while (ready(POLLIN)) {
    const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (count > 0) {
      buffer_.resize(static_cast<std::size_t>(count));
      received_ += static_cast<std::size_t>(count);
      return true;
    }
    if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
      trouble_ = Trouble::kClosed;
      break;
    }
  }
  buffer_.clear();
  return false;
}

ssize_t Connection::read(char* data, std::size_t size) {
  if (trouble_ != Trouble::kNone) {
    return trouble_ == Trouble::kClosed ? 0 : -1;
  }
  if (used_ == buffer_.size() && !fill()) {
    return trouble_ == Trouble::kClosed ? 0 : -1;
  }
  const std::size_t count = std::min(size, buffer_.size() - used_);
  std::memcpy(data, buffer_.data() + used_, count);
  used_ += count;
  return static_cast<ssize_t>(count);
}

ssize_t Connection::write(const char* data, std::size_t size) {
  const Trouble before = trouble_;  // what came in may be bad; it still gets an answer
  trouble_ = Trouble::kNone;
  while (ready(POLLOUT)) {
    const ssize_t count = ::send(socket_, data, size, MSG_DONTWAIT | MSG_NOSIGNAL);
    if (count > 0) {
      trouble_ = before;
      return count;
    }
    if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
      trouble_ = Trouble::kClosed;
      break;
    }
  }
  return -1;
}

bool Connection::wait(Duration time) {
  std::array<pollfd, 2> watched{{{socket_, POLLRDHUP, 0}, {stop_, POLLIN, 0}}};
  const int count = ::poll(watched.data(), watched.size(), milliseconds_until(after(time)));
  return count == 0 || (count < 0 && errno == EINTR);
}

void Connection::finish() {
  ::shutdown(socket_, SHUT_WR);
  constexpr int kPieces = 16;
  std::array<char, 4096> rest;
  trouble_ = Trouble::kNone;
  set_deadline(Duration(0.2));
  for (int i = 0; i < kPieces && ready(POLLIN); ++i) {
    if (::recv(socket_, rest.data(), rest.size(), MSG_DONTWAIT) <= 0) {
      return;
    }
  }
}

namespace {

struct Peer {
  std::string address;
  int port{0};
};

Peer peer_of(int socket) {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  std::array<char, INET6_ADDRSTRLEN> text{};
  if (::getpeername(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) {
    return {};
  }
  if (address.ss_family == AF_INET6) {
    const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&address);
    ::inet_ntop(AF_INET6, &v6->sin6_addr, text.data(), text.size());
    return {fmt::format("[{}]", text.data()), ntohs(v6->sin6_port)};
  }
  const auto* v4 = reinterpret_cast<const sockaddr_in*>(&address);
  ::inet_ntop(AF_INET, &v4->sin_addr, text.data(), text.size());
  return {text.data(), ntohs(v4->sin_port)};
}

}  // namespace

std::string address_of(int socket) { return peer_of(socket).address; }

std::string Connection::peer() const {
  const Peer peer = peer_of(socket_);
  return peer.address.empty() ? "a client that has gone"
                              : fmt::format("{}:{}", peer.address, peer.port);
}

}  // namespace haptrial::experiments
