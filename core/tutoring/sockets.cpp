#include "core/tutoring/sockets.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <utility>

#include "core/base/error.h"

namespace haptrial::tutoring {
namespace {

sockaddr* generic(Address& address) { return reinterpret_cast<sockaddr*>(&address.storage); }
const sockaddr* generic(const Address& address) {
  return reinterpret_cast<const sockaddr*>(&address.storage);
}

/// IPv6, which speaks with IPv4 too, unless the machine has only the latter.
int family() {
  static const int found = [] {
    const Socket probe(::socket(AF_INET6, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    return probe.get() >= 0 ? AF_INET6 : AF_INET;
  }();
  return found;
}

Socket bound(int type, std::uint16_t port) {
  Socket socket(::socket(family(), type | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  Address any;  // zeros: every address of the machine
  any.storage.ss_family = static_cast<sa_family_t>(family());
  any.size = family() == AF_INET6 ? sizeof(sockaddr_in6) : sizeof(sockaddr_in);
  any.set_port(port);
  const int yes = 1;
  const int no = 0;
  if (family() == AF_INET6) {
    setsockopt(socket.get(), IPPROTO_IPV6, IPV6_V6ONLY, &no, sizeof(no));
  }
  if (type == SOCK_STREAM) {
    setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  }
  if (socket.get() < 0 || ::bind(socket.get(), generic(any), any.size) != 0) {
    throw RunError(fmt::format("port {} cannot be used: {}", port, std::strerror(errno)));
  }
  return socket;
}

/// @returns whether `what` came before the patience ended
bool wait_for(int fd, short what, const Patience& patience) {
  using namespace std::chrono;
  constexpr milliseconds kPulse(100);
  while (true) {
    const auto left = duration_cast<milliseconds>(patience.until - steady_clock::now());
    if (left <= milliseconds(0)) {
      return false;
    }
    pollfd watched{fd, what, 0};
    const int count = ::poll(&watched, 1, static_cast<int>(std::min(left, kPulse).count()));
    if (count > 0) {
      return true;
    }
    if (count < 0 && errno != EINTR) {
      return false;
    }
    if (patience.pulse) {
      patience.pulse();
    }
  }
}

}  // namespace

Socket& Socket::operator=(Socket&& other) noexcept {
  if (this != &other) {
    if (fd_ >= 0) {
      ::close(fd_);
    }
    fd_ = other.release();
  }
  return *this;
}

Socket::~Socket() {
  if (fd_ >= 0) {
    ::close(fd_);
  }
}

int Socket::release() noexcept { return std::exchange(fd_, -1); }

std::uint16_t Address::port() const noexcept {
  return ntohs(storage.ss_family == AF_INET6
                   ? reinterpret_cast<const sockaddr_in6*>(&storage)->sin6_port
                   : reinterpret_cast<const sockaddr_in*>(&storage)->sin_port);
}

void Address::set_port(std::uint16_t port) noexcept {
  if (storage.ss_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6*>(&storage)->sin6_port = htons(port);
  } else {
    reinterpret_cast<sockaddr_in*>(&storage)->sin_port = htons(port);
  }
}

bool same_machine(const Address& a, const Address& b) noexcept {
  Address with_port = b;
  with_port.set_port(a.port());
  return a.size == b.size && std::memcmp(&a.storage, &with_port.storage, a.size) == 0;
}

Address address_of(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  std::string host = colon == std::string::npos ? "" : text.substr(0, colon);
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  unsigned port = 0;
  const char* end = text.data() + text.size();
  const char* begin = text.data() + (colon == std::string::npos ? text.size() : colon + 1);
  const auto read = std::from_chars(begin, end, port);
  if (host.empty() || read.ptr != end || begin == end || port < 1 || port > 65535) {
    throw InputError(fmt::format(
        "the other side's address is '{}'; allowed: NAME:PORT with a port from 1 to 65535", text));
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_family = family();
  hints.ai_flags = family() == AF_INET6 ? AI_V4MAPPED | AI_ALL : 0;
  addrinfo* found = nullptr;
  if (::getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0 || found == nullptr) {
    throw InputError(fmt::format("no machine is known by the name '{}'", host));
  }
  Address address;
  std::memcpy(&address.storage, found->ai_addr, found->ai_addrlen);
  address.size = found->ai_addrlen;
  ::freeaddrinfo(found);
  address.set_port(static_cast<std::uint16_t>(port));
  return address;
}

Socket listening(std::uint16_t port) {
  Socket socket = bound(SOCK_STREAM, port);
  constexpr int kWaiting = 8;
  if (::listen(socket.get(), kWaiting) != 0) {
    throw RunError(fmt::format("port {} cannot be used: {}", port, std::strerror(errno)));
  }
  return socket;
}

Socket datagram_socket(std::uint16_t port) { return bound(SOCK_DGRAM, port); }

std::uint16_t port_of(const Socket& socket) {
  Address own;
  own.size = sizeof(own.storage);
  ::getsockname(socket.get(), generic(own), &own.size);
  return own.port();
}

Socket connected(const Address& address, const Patience& patience) {
  Socket socket(::socket(address.storage.ss_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  int error = ::connect(socket.get(), generic(address), address.size) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    error = ETIMEDOUT;
    if (wait_for(socket.get(), POLLOUT, patience)) {
      socklen_t size = sizeof(error);
      ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
    }
  }
  if (error != 0) {
    throw RunError(fmt::format("the other side cannot be reached at port {}: {}", address.port(),
                               std::strerror(error)));
  }
  const int yes = 1;
  ::setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
  return socket;
}

Socket accepted(const Socket& listener, const Patience& patience, Address* from) {
  while (wait_for(listener.get(), POLLIN, patience)) {
    from->size = sizeof(from->storage);
    Socket socket(
        ::accept4(listener.get(), generic(*from), &from->size, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (socket.get() >= 0) {
      return socket;
    }
  }
  return {};
}

bool send_all(const Socket& socket, std::span<const unsigned char> bytes,
              const Patience& patience) {
  while (!bytes.empty()) {
    const ssize_t sent = ::send(socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (errno != EAGAIN || !wait_for(socket.get(), POLLOUT, patience)) {
      return false;
    }
  }
  return true;
}

bool receive_all(const Socket& socket, std::span<unsigned char> bytes, const Patience& patience) {
  while (!bytes.empty()) {
    const ssize_t got = ::recv(socket.get(), bytes.data(), bytes.size(), 0);
    if (got > 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(got));
    } else if (got == 0 || errno != EAGAIN || !wait_for(socket.get(), POLLIN, patience)) {
      return false;
    }
  }
  return true;
}

}  // namespace haptrial::tutoring
