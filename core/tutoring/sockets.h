#pragma once

#include <netinet/in.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <span>
#include <string>

namespace haptrial::tutoring {

/// A file descriptor that closes itself.
class Socket {
 public:
  Socket() = default;
  explicit Socket(int descriptor) noexcept : fd_(descriptor) {}
  Socket(Socket&& other) noexcept : fd_(other.release()) {}
  Socket& operator=(Socket&& other) noexcept;
  ~Socket();
  int get() const noexcept { return fd_; }
  int release() noexcept;

 private:
  int fd_{-1};
};

/// Address of the other side: "name:port" or "address:port", IPv4 or "[IPv6]:port".
struct Address {
  sockaddr_storage storage{};
  socklen_t size{0};
  std::uint16_t port() const noexcept;
  void set_port(std::uint16_t port) noexcept;
};
/// Whether both have the same number but for the port.
bool same_machine(const Address& a, const Address& b) noexcept;
/// @throws InputError for a text of another form, a port outside 1 to 65535 or an unknown name
Address address_of(const std::string& text);

/// Limit of a wait, and the callback that may end it before.
struct Patience {
  std::chrono::steady_clock::time_point until;
  std::function<void()> pulse;  // asked ten times a second; may throw
};

/// Bound to every address of this machine. @param port  0: any that is free
/// @throws RunError where the port is taken or may not be used
Socket listening(std::uint16_t port);
Socket datagram_socket(std::uint16_t port);
std::uint16_t port_of(const Socket& socket);

/// @throws RunError at the end of the patience, or where nobody listens there
Socket connected(const Address& address, const Patience& patience);
/// @returns an empty socket at the end of the patience.
Socket accepted(const Socket& listener, const Patience& patience, Address* from);

/// All bytes, or false where the other side closed, failed or took too long.
bool send_all(const Socket& socket, std::span<const unsigned char> bytes, const Patience& patience);
bool receive_all(const Socket& socket, std::span<unsigned char> bytes, const Patience& patience);

}  // namespace haptrial::tutoring
