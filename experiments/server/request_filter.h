#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace haptrial::experiments {

/// 128 random bits as 32 hexadecimal digits, from the operating system's entropy. Not from a seeded
/// stream: the seed stands in the session file, and who knows it could compute the token.
/// @throws RunError
std::string make_token();

/// Compares in a time that does not tell how many characters were right.
bool is_same_secret(const std::string& a, const std::string& b);

/// Head of a request before its body is read; empty fields were not sent.
struct RequestHead {
  std::string method;
  std::string path;
  std::string host;
  std::string origin;
  std::string fetch_site;    // Sec-Fetch-Site
  std::string token_header;  // X-Haptrial-Token
  std::string token_query;   // ?token=
  std::string content_type;
  std::string content_length;
  std::string transfer_encoding;
  std::string content_encoding;
  std::string range;
  int host_headers{1};
};

struct Refusal {
  int status{400};
  std::string reason;  // a sentence without its full stop
};

/// Decides who may talk to a server. The browser of the experimenter also shows other pages, so
/// the loopback address alone protects nothing:
///  - a foreign page that posts here is stopped by its Origin, and lacks the token's header;
///  - a name that is rebound to this address is stopped by its Host;
///  - there is no cookie that a browser would add by itself.
class RequestFilter {
 public:
  struct Place {
    std::string path;     // "/events"
    bool is_page{false};  // it is opened by its address
    bool reads{true};     // GET; else POST
  };
  struct Rules {
    std::string token;
    std::vector<std::string> hosts;  // "127.0.0.1:8080"
    std::size_t max_body{4096};      // [bytes]
    std::vector<Place> places;       // all that may be asked for
  };
  explicit RequestFilter(Rules rules) : rules_(std::move(rules)) {}

  /// @returns why the request is refused, or nothing. Any thread.
  std::optional<Refusal> judge(const RequestHead& head) const;

 private:
  /// Null if there is nothing.
  const Place* place_of(const std::string& path) const;
  std::string places() const;
  std::optional<Refusal> judge_sender(const RequestHead& head) const;
  std::optional<Refusal> judge_body(const RequestHead& head) const;
  Rules rules_;
};

/// Refused requests: all are counted, the first ones kept as sentences and passed on, so that an
/// attack fills neither memory nor the session file. Any thread.
class RefusalLog {
 public:
  static constexpr std::size_t kKept = 200;

  explicit RefusalLog(std::function<void(const std::string&)> listener)
      : listener_(std::move(listener)) {}
  /// @param sentence  made printable and cut to 300 characters.
  void add(const std::string& sentence);
  std::uint64_t count() const;
  std::vector<std::string> sentences() const;

 private:
  std::function<void(const std::string&)> listener_;
  mutable std::mutex mutex_;
  std::uint64_t count_{0};
  std::vector<std::string> sentences_;
};

}  // namespace haptrial::experiments
