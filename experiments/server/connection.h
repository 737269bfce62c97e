#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// A non-blocking event that wakes every connection when the server closes.
class StopEvent {
 public:
  /// @throws RunError when the system has no descriptor left.
  StopEvent();
  ~StopEvent();
  StopEvent(const StopEvent&) = delete;
  StopEvent& operator=(const StopEvent&) = delete;
  void set() noexcept;
  int descriptor() const noexcept { return descriptor_; }

 private:
  int descriptor_;
};

/// Address of the other side without its port, such as "127.0.0.1"; empty once it is gone.
std::string address_of(int socket);

/// One accepted socket with a deadline and a limit on what it may send, so that a slow or talkative
/// client costs a bounded time and memory. Not thread-safe; closed by whoever accepted it.
class Connection {
 public:
  enum class Trouble { kNone, kTooLarge, kTooSlow, kClosed, kStopped };
  using Duration = std::chrono::duration<double>;

  /// @param crowded  others wait: a client that has not been trusted then gets 50 ms at most, so
  ///                 that those who only occupy the server cannot keep an emergency stop out.
  Connection(int socket, const StopEvent& stop, const std::atomic<bool>& crowded,
             std::size_t max_bytes, Duration time);

  /// Notes that the peer has shown the token.
  void trust() { trusted_ = true; }

  /// @returns bytes read (at least 1), 0 when the peer closed, -1 with trouble().
  ssize_t read(char* data, std::size_t size);
  /// @returns bytes written (at least 1) or -1 with trouble(). Once the server closes, only what
  /// the peer takes at once is written: a last word.
  ssize_t write(const char* data, std::size_t size);
  /// Waits without reading. @returns false when the peer or the server has gone.
  bool wait(Duration time);
  /// Sets the time that the peer has from now on.
  void set_deadline(Duration time);
  /// Lets the peer read what was written before the socket is closed: says that no more comes and
  /// throws away a bounded rest of what it still sends.
  void finish();

  Trouble trouble() const { return trouble_; }
  std::size_t received() const { return received_; }
  int socket() const { return socket_; }
  std::string peer() const;  // "127.0.0.1:40312"

 private:
  /// @returns whether `events` came before the deadline.
  bool ready(short events);
  bool in_the_way() const;
  bool fill();

  int socket_;
  int stop_;
  const std::atomic<bool>& crowded_;
  std::size_t max_bytes_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point deadline_;
  std::vector<char> buffer_;
  std::size_t used_{0};  // of buffer_
  std::size_t received_{0};
  bool trusted_{false};
  Trouble trouble_{Trouble::kNone};
};

}  // namespace haptrial::experiments
