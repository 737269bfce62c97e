#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace haptrial::channel {

/// An open socket or serial line to an instrument; it is closed when it is destroyed. One thread,
/// which may wait. All members throw RunError in one sentence if the instrument is lost.
class Connection {
 public:
  /// @param what  the instrument in sentences: "RDT sensor"
  static Connection datagrams(const std::string& what, const std::string& host, int port);
  static Connection stream(const std::string& what, const std::string& host, int port);
  static Connection serial(const std::string& what, const std::string& device, int baud);
  ~Connection();
  Connection(Connection&& other) noexcept;
  Connection& operator=(Connection&&) = delete;

  /// The instrument and where it is: "RDT sensor at 192.168.1.1:49152".
  const std::string& name() const { return name_; }
  void send(std::span<const std::uint8_t> bytes);
  /// Receives one datagram, or what a stream or line has. A longer datagram is cut.
  /// @returns the number of bytes; nothing if none came within `patience`
  std::optional<std::size_t> receive(std::span<std::uint8_t> into,
                                     std::chrono::milliseconds patience);

 private:
  enum class Form : std::uint8_t { kDatagrams, kStream, kSerial };
  Connection(Form form, std::string name) : form_(form), name_(std::move(name)) {}
  void connect(const std::string& host, int port);
  [[noreturn]] void fail(const std::string& why) const;

  Form form_;
  std::string name_;
  int file_{-1};
};

}  // namespace haptrial::channel
