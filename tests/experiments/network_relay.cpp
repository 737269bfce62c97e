#include "tests/experiments/network_relay.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <queue>
#include <random>
#include <stdexcept>
#include <vector>

#include "tests/support/free_port.h"

namespace haptrial::test {
namespace {

using Clock = std::chrono::steady_clock;

sockaddr_in local(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

int bound(int type, std::uint16_t port) {
  const int fd = ::socket(AF_INET, type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const sockaddr_in address = local(port);
  if (::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    ::close(fd);
    return -1;
  }
  return fd;
}

/// Hands bytes on until one side closes. @returns false then
bool pump(int from, int to) {
  std::array<char, 4096> bytes;
  const ssize_t got = ::recv(from, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got > 0) {
    return ::send(to, bytes.data(), static_cast<std::size_t>(got), MSG_NOSIGNAL) == got;
  }
  return got < 0 && errno == EAGAIN;
}

struct Datagram {
  Clock::time_point due;
  std::uint64_t order;
  bool to_host;
  std::vector<char> bytes;
  bool operator<(const Datagram& other) const {  // the next one is on top of the heap
    return due != other.due ? due > other.due : order > other.order;
  }
};

/// One way through the network.
class Direction {
 public:
  Direction(const RelayConditions& c, std::uint64_t seed, bool to_host)
      : c_(c), random_(seed), to_host_(to_host) {}

  /// @returns whether it gets through
  bool take(const std::vector<char>& bytes, std::priority_queue<Datagram>& waiting) {
    std::uniform_real_distribution<double> one(0.0, 1.0);
    const bool lost = one(random_) < c_.loss;
    const int copies = one(random_) < c_.duplication ? 2 : 1;
    for (int i = 0; i < copies && !lost; ++i) {
      const double extra = -c_.jitter * std::log1p(-one(random_));
      auto due = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                    std::chrono::duration<double>(c_.delay + extra));
      if (one(random_) >= c_.reordering) {
        due = last_ = std::max(due, last_);
      }
      waiting.push({due, ++order_, to_host_, bytes});
    }
    return !lost;
  }

 private:
  RelayConditions c_;
  std::mt19937_64 random_;
  bool to_host_;
  Clock::time_point last_;
  std::uint64_t order_{0};
};

}  // namespace

NetworkRelay::NetworkRelay(std::uint16_t to, const RelayConditions& conditions, std::uint64_t seed)
    : to_(to), conditions_(conditions), seed_(seed), port_(free_port()) {
  listener_ = bound(SOCK_STREAM, port_);
  guest_ = bound(SOCK_DGRAM, port_);
  host_ = bound(SOCK_DGRAM, 0);
  if (listener_ < 0 || guest_ < 0 || host_ < 0 || ::listen(listener_, 4) != 0) {
    throw std::runtime_error("the relay has no ports");
  }
  thread_ = std::thread([this] { run(); });
}

NetworkRelay::~NetworkRelay() {
  stop_ = true;
  thread_.join();
  for (const int fd : {listener_, guest_, host_}) {
    ::close(fd);
  }
}

void NetworkRelay::run() {
  Direction there(conditions_, seed_, true);
  Direction back(conditions_, seed_ + 1, false);
  std::priority_queue<Datagram> waiting;
  sockaddr_in guest{};
  int from_guest = -1;  // connections
  int to_host = -1;
  std::array<char, 2048> buffer;
  while (!stop_) {
    std::array<pollfd, 5> watched{{{listener_, POLLIN, 0},
                                   {guest_, POLLIN, 0},
                                   {host_, POLLIN, 0},
                                   {from_guest, POLLIN, 0},
                                   {to_host, POLLIN, 0}}};
    const timespec look{0, 200'000};
    ::ppoll(watched.data(), watched.size(), &look, nullptr);
    if (from_guest < 0 && (watched[0].revents & POLLIN) != 0) {
      from_guest = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      to_host = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      const sockaddr_in host = local(to_);
      if (::connect(to_host, reinterpret_cast<const sockaddr*>(&host), sizeof(host)) != 0) {
        ::close(from_guest);
        ::close(to_host);
        from_guest = to_host = -1;
      }
    } else if (from_guest >= 0 && !(pump(from_guest, to_host) && pump(to_host, from_guest))) {
      ::close(from_guest);
      ::close(to_host);
      from_guest = to_host = -1;
    }
    const auto take = [&](int fd, Direction& way, sockaddr_in* from) {
      while (true) {
        sockaddr_in address{};
        socklen_t size = sizeof(address);
        const ssize_t got = ::recvfrom(fd, buffer.data(), buffer.size(), MSG_DONTWAIT,
                                       reinterpret_cast<sockaddr*>(&address), &size);
        if (got < 0) {
          return;
        }
        if (from != nullptr) {
          *from = address;
        }
        const std::vector<char> bytes(buffer.begin(), buffer.begin() + got);
        ++(!cut_ && way.take(bytes, waiting) ? passed_ : lost_);
      }
    };
    take(guest_, there, &guest);
    take(host_, back, nullptr);
    while (!waiting.empty() && waiting.top().due <= Clock::now()) {
      const Datagram& next = waiting.top();
      const sockaddr_in to = next.to_host ? local(to_) : guest;
      ::sendto(next.to_host ? host_ : guest_, next.bytes.data(), next.bytes.size(), 0,
               reinterpret_cast<const sockaddr*>(&to), sizeof(to));
      waiting.pop();
    }
  }
  for (const int fd : {from_guest, to_host}) {
    if (fd >= 0) {
      ::close(fd);
    }
  }
}

}  // namespace haptrial::test
