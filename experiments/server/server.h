#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::experiments {

struct ServerOptions {
  std::string address{"127.0.0.1"};  // numeric, of one network interface
  int port{0};                       // 0: any that is free
  bool allow_remote{false};          // other addresses than loopback
  double events_per_second{15.0};    // to each page
  double request_time{2.0};          // a request, or the sending of an answer, that takes longer
                                     // is cut off [s]
  int workers{8};                    // requests at a time of those who have not shown the token
  int own_workers{4};                // requests at a time of those who have, beside event streams
  int event_streams{4};              // pages at a time
  int waiting{32};                   // connections that may wait for a worker
  std::size_t max_body{4096};        // of a request [bytes]
  /// Gets a sentence for each of the first refusals (RefusalLog); on a thread of the server.
  std::function<void(const std::string&)> on_refusal;
};

struct WebRequest {
  std::string path;                          // "/ask"
  std::map<std::string, std::string> query;  // without the token
  std::string body;                          // "" of a GET
};

struct WebAnswer {
  int status{200};  // 400 and above: a refusal, whose body is a sentence
  std::string type{"application/json"};
  std::string body;
  std::map<std::string, std::string> headers{};  // in place of those that every answer has
};

/// @param reason  a sentence without its full stop
WebAnswer refusal(int status, const std::string& reason);
/// A page with a nonce of its own and the policy that allows nothing else (access.h).
/// @param more_policy  what the page may do besides, such as "frame-src 'self'"
WebAnswer page_answer(std::string_view html, std::string_view more_policy = {});

/// The next event of one page as one line of JSON.
using WebEvents = std::function<std::string()>;

/// An address of a server and what is there; one of `answer` and `events`. Both are called on
/// several threads at once. An InputError of `answer` is a refusal with status 400, a RunError one
/// with status 503.
struct WebRoute {
  enum class Kind { kPage, kRead, kPost };
  std::string path;
  Kind kind{Kind::kRead};
  std::function<WebAnswer(const WebRequest&)> answer{};
  std::function<WebEvents()> events{};  // events of a page that is opened now
};

/// HTTP for pages of this program, on threads of its own: only who shows the token, names the
/// server's own Host and comes from no other page is answered (RequestFilter). Who shows the token
/// is served by threads that nobody else can occupy. Connections, their time and their size are
/// bounded. The HTTP library makes the process ignore SIGPIPE.
class GuardedServer {
 public:
  /// Serves when it returns.
  /// @throws InputError for an address or option that is not allowed; RunError if the port is
  /// taken.
  GuardedServer(ServerOptions options, std::vector<WebRoute> routes);
  /// Hangs up on every client; waits for answers that are being made.
  ~GuardedServer();
  GuardedServer(const GuardedServer&) = delete;
  GuardedServer& operator=(const GuardedServer&) = delete;

  /// Address of a page with the token. @param path  "/"
  std::string url(std::string_view path = "/") const;
  int port() const;
  const std::string& token() const;

  /// Requests that were refused, and the first ones in a sentence each. Any thread.
  std::uint64_t refused() const;
  std::vector<std::string> refusals() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace haptrial::experiments
