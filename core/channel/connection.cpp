#include "core/channel/connection.h"

#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "core/base/error.h"
#include "core/base/serial_port.h"

namespace haptrial::channel {
namespace {

constexpr int kConnectPatience = 2000;  // for a connection, and until bytes can be sent [ms]

/// Whether the file is ready for the event within the time [ms].
bool is_ready(int file, short event, int patience_ms) noexcept {
  pollfd wait{file, event, 0};
  return poll(&wait, 1, patience_ms) > 0;
}

int connect_to(const addrinfo& address) noexcept {
  const int file = socket(address.ai_family, address.ai_socktype | SOCK_NONBLOCK | SOCK_CLOEXEC,
                          address.ai_protocol);
  if (file < 0) {
    return -1;
  }
  int error = ::connect(file, address.ai_addr, address.ai_addrlen) == 0 ? 0 : errno;
  if (error == EINPROGRESS) {
    socklen_t size = sizeof(error);
    if (!is_ready(file, POLLOUT, kConnectPatience)) {
      error = ETIMEDOUT;
    } else if (getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &size) != 0) {
      error = errno;
    }
  }
  if (error != 0) {
    close(file);
    errno = error;
    return -1;
  }
  return file;
}

}  // namespace

Connection::Connection(Connection&& other) noexcept
    : form_(other.form_), name_(std::move(other.name_)), file_(std::exchange(other.file_, -1)) {}

Connection::~Connection() {
  if (file_ >= 0) {
    close(file_);
  }
}

void Connection::fail(const std::string& why) const {
  throw RunError(fmt::format("{}: {}", name_, why));
}

void Connection::connect(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_socktype = form_ == Form::kDatagrams ? SOCK_DGRAM : SOCK_STREAM;
  addrinfo* found = nullptr;
  const int failed = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found);
  if (failed != 0) {
    fail(fmt::format("the address is unknown ({})", gai_strerror(failed)));
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> addresses(found, freeaddrinfo);
  int error = 0;
  for (const addrinfo* each = found; each != nullptr && file_ < 0; each = each->ai_next) {
    file_ = connect_to(*each);
    error = errno;
  }
  if (file_ < 0) {
    fail(fmt::format("cannot be reached ({})", std::strerror(error)));
  }
}

Connection Connection::datagrams(const std::string& what, const std::string& host, int port) {
  Connection made(Form::kDatagrams, fmt::format("{} at {}:{}", what, host, port));
  made.connect(host, port);
  const int room = 1 << 20;  // bytes for the time in which this thread does not run
  setsockopt(made.file_, SOL_SOCKET, SO_RCVBUF, &room, sizeof(room));
  return made;
}

Connection Connection::stream(const std::string& what, const std::string& host, int port) {
  Connection made(Form::kStream, fmt::format("{} at {}:{}", what, host, port));
  made.connect(host, port);
  const int on = 1;
  setsockopt(made.file_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on));
  return made;
}

Connection Connection::serial(const std::string& what, const std::string& device, int baud) {
  Connection made(Form::kSerial, fmt::format("{} at {}", what, device));
  made.file_ = open_serial_port(device, baud);
  if (made.file_ < 0) {
    made.fail(errno == ENOTTY ? "that is no serial line"
                              : fmt::format("{}; connect it and check that you may use it (on "
                                            "Debian: group dialout)",
                                            std::strerror(errno)));
  }
  return made;
}

void Connection::send(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t sent = form_ == Form::kSerial
                             ? write(file_, bytes.data(), bytes.size())
                             : ::send(file_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent >= 0) {
      bytes = bytes.subspan(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN) {
      if (!is_ready(file_, POLLOUT, kConnectPatience)) {
        fail("takes no more bytes");
      }
    } else if (errno != EINTR) {
      fail(std::strerror(errno));
    }
  }
}

std::optional<std::size_t> Connection::receive(std::span<std::uint8_t> into,
                                               std::chrono::milliseconds patience) {
  if (!is_ready(file_, POLLIN, static_cast<int>(patience.count()))) {
    return std::nullopt;
  }
  const ssize_t count = form_ == Form::kSerial ? read(file_, into.data(), into.size())
                                               : recv(file_, into.data(), into.size(), 0);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
    return std::nullopt;
  }
  if (count < 0) {
    fail(std::strerror(errno));
  }
  if (count == 0 && form_ != Form::kDatagrams) {
    fail(form_ == Form::kSerial ? "was unplugged" : "closed the connection");
  }
  return static_cast<std::size_t>(count);
}

}  // namespace haptrial::channel
