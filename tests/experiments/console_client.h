#pragma once

#include <limits>
#include <optional>
#include <string>

namespace haptrial::test {

/// A socket to a port of the loopback interface, without any HTTP of its own: what a hostile client
/// has.
class RawClient {
 public:
  explicit RawClient(int port);
  ~RawClient();
  RawClient(const RawClient&) = delete;
  RawClient& operator=(const RawClient&) = delete;

  void send(const std::string& text);
  static constexpr double kForever = std::numeric_limits<double>::infinity();
  /// All that comes until the other side closes, `seconds` have passed or `until` has come.
  std::string receive(double seconds, const std::string& until = "");
  bool closed() const { return closed_; }  // seen by receive()

 private:
  int socket_;
  bool closed_{false};
};

/// A request as text; every field may be overwritten or left out.
struct RawRequest {
  std::string method{"POST"};
  std::string target{"/ask"};
  std::optional<std::string> host;
  std::optional<std::string> token;
  std::optional<std::string> type{"application/json"};
  std::string more;  // further header lines, each with its line end
  std::string body{R"({"request":"pause"})"};
  std::optional<std::string> length;  // of the body, where it is not the true one

  std::string text() const;
};

/// The status of an answer, or 0 where the connection was closed without one.
int status_of(const std::string& answer);

}  // namespace haptrial::test
