#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tests/support/free_port.h"
#include "tests/support/local_socket.h"

namespace haptrial::test {

/// A record as a sensor sends it.
struct RdtRecord {
  std::uint32_t sequence{0};
  std::uint32_t status{0};
  std::array<std::int32_t, 6> counts{};
};

/// A force-torque sensor that speaks RDT (ATI Net F/T, manual 9620-05-NET FT, section 9): it hears
/// requests, answers each start with one record, and sends what the test says.
class StandInRdt {
 public:
  /// @param first  sequence of the record that answers a start
  explicit StandInRdt(std::uint32_t first = 1)
      : first_(first), file_(open_local_socket(SOCK_DGRAM, port_)), thread_([this] { listen(); }) {}
  ~StandInRdt() {
    over_.store(true);
    thread_.join();
    ::close(file_);
  }
  StandInRdt(const StandInRdt&) = delete;
  StandInRdt& operator=(const StandInRdt&) = delete;

  std::uint16_t port() const { return port_; }
  /// The commands of all requests so far; 0xFFFF stands for a datagram that is no request.
  std::vector<int> commands() const {
    const std::lock_guard lock(mutex_);
    return commands_;
  }
  /// Whether it answers a start.
  void set_answering(bool answering) { answering_.store(answering); }

  void send(std::span<const RdtRecord> records) {
    std::vector<std::uint32_t> words;
    for (const RdtRecord& record : records) {
      words.push_back(htonl(record.sequence));
      words.push_back(htonl(7 * record.sequence));  // its internal samples
      words.push_back(htonl(record.status));
      for (const std::int32_t counts : record.counts) {
        words.push_back(htonl(static_cast<std::uint32_t>(counts)));
      }
    }
    send_bytes(words.data(), 4 * words.size());
  }
  void send(const RdtRecord& record) { send(std::span(&record, 1)); }
  void send_bytes(const void* bytes, std::size_t size) {
    const std::lock_guard lock(mutex_);
    ::sendto(file_, bytes, size, 0, reinterpret_cast<const sockaddr*>(&client_), sizeof(client_));
  }

 private:
  void listen() {
    while (!over_.load()) {
      if (!is_readable(file_, 20)) {
        continue;
      }
      std::array<std::uint8_t, 64> bytes{};
      sockaddr_in from{};
      socklen_t size = sizeof(from);
      const ssize_t count = ::recvfrom(file_, bytes.data(), bytes.size(), 0,
                                       reinterpret_cast<sockaddr*>(&from), &size);
      const bool is_request = count == 8 && bytes[0] == 0x12 && bytes[1] == 0x34;
      const int command = is_request ? bytes[2] << 8 | bytes[3] : 0xFFFF;
      {
        const std::lock_guard lock(mutex_);
        commands_.push_back(command);
        client_ = from;
      }
      if ((command == 2 || command == 3) && answering_.load()) {
        send(RdtRecord{first_});
      }
    }
  }

  std::uint32_t first_;
  std::uint16_t port_{free_port()};
  int file_;
  std::atomic<bool> over_{false};
  std::atomic<bool> answering_{true};
  mutable std::mutex mutex_;
  std::vector<int> commands_;
  sockaddr_in client_{};
  std::thread thread_;
};

/// Answers every HTTP request with one page, like the web server of such a sensor.
class StandInPage {
 public:
  explicit StandInPage(std::string body)
      : body_(std::move(body)),
        file_(open_local_socket(SOCK_STREAM, port_)),
        thread_([this] { serve(); }) {}
  ~StandInPage() {
    over_.store(true);
    thread_.join();
    ::close(file_);
  }
  StandInPage(const StandInPage&) = delete;
  StandInPage& operator=(const StandInPage&) = delete;

  std::uint16_t port() const { return port_; }

 private:
  void serve() {
    while (!over_.load()) {
      if (!is_readable(file_, 20)) {
        continue;
      }
      const int client = ::accept(file_, nullptr, nullptr);
      std::string request;
      std::array<char, 1024> bytes{};
      while (request.find("\r\n\r\n") == std::string::npos) {
        const ssize_t count = ::recv(client, bytes.data(), bytes.size(), 0);
        if (count <= 0) {
          break;
        }
        request.append(bytes.data(), static_cast<std::size_t>(count));
      }
      const bool known = request.rfind("GET /netftapi2.xml ", 0) == 0;
      const std::string answer =
          std::string("HTTP/1.1 ") + (known ? "200 OK" : "404 Not Found") +
          "\r\nContent-Type: text/xml\r\nConnection: close\r\nContent-Length: " +
          std::to_string(body_.size()) + "\r\n\r\n" + body_;
      ::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
      ::close(client);
    }
  }

  std::string body_;
  std::uint16_t port_{free_port()};
  int file_;
  std::atomic<bool> over_{false};
  std::thread thread_;
};

}  // namespace haptrial::test
