#include "tests/support/free_port.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <stdexcept>

namespace haptrial::test {
namespace {

bool is_free(int type, std::uint16_t port) {
  const int fd = ::socket(AF_INET, type | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  const bool bound = ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  ::close(fd);
  return bound;
}

}  // namespace

std::uint16_t free_port() {
  // Linux gives ports from 32768 on by itself; each process begins at a place of its own below.
  constexpr int kFirst = 12000;
  constexpr int kPorts = 20000;
  constexpr int kOfAProcess = 16;
  static std::atomic<int> next{0};
  for (int i = 0; i < kPorts; ++i) {
    const int place = (kOfAProcess * static_cast<int>(::getpid() % kPorts) + next++) % kPorts;
    const auto port = static_cast<std::uint16_t>(kFirst + place);
    if (is_free(SOCK_STREAM, port) && is_free(SOCK_DGRAM, port)) {
      return port;
    }
  }
  throw std::runtime_error("no free port");
}

}  // namespace haptrial::test
