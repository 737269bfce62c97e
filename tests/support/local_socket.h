#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace haptrial::test {

/// A socket at a port of this machine, for stand-ins of instruments. @param type  SOCK_DGRAM, or
/// SOCK_STREAM, which then listens
inline int open_local_socket(int type, std::uint16_t port) {
  const int file = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
  const int on = 1;
  ::setsockopt(file, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  if (::bind(file, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      (type == SOCK_STREAM && ::listen(file, 4) != 0)) {
    ::close(file);
    throw std::runtime_error("a port of this machine cannot be used");
  }
  return file;
}

/// Whether something can be read within the time [ms].
inline bool is_readable(int file, int patience_ms) {
  pollfd wait{file, POLLIN, 0};
  return ::poll(&wait, 1, patience_ms) > 0;
}

}  // namespace haptrial::test
