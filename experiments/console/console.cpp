#include "experiments/console/console.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <atomic>
#include <cstring>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "core/base/error.h"
#include "experiments/console/console_address.h"
#include "experiments/console/console_connection.h"
#include "experiments/console/console_door.h"
#include "experiments/console/console_guard.h"
#include "experiments/console/console_messages.h"
#include "experiments/console/console_page.h"

namespace haptrial::experiments {
namespace {

using Seconds = Connection::Duration;

constexpr std::size_t kMaxHead = 8192;
constexpr std::size_t kMaxBody = 4096;
constexpr std::size_t kSilent = 256;  // connections that have said nothing
const Seconds kLastWord(0.2);         // for a client that was cut off to take its answer

/// Job of a worker; the library's handlers run inside it.
struct Job {
  Connection& connection;
  bool refused{false};
};
thread_local Job* t_job = nullptr;

/// The answer to a client that was cut off, or 0.
int status_of(Connection::Trouble trouble) {
  return trouble == Connection::Trouble::kTooLarge  ? 431
         : trouble == Connection::Trouble::kTooSlow ? 408
                                                    : 0;
}

const char* sentence_of(int status) {
  return status == 431   ? "the request is too large"
         : status == 408 ? "the request took too long"
         : status >= 500 ? "the console failed on this request"
                         : "the request is malformed";
}

class SocketStream final : public httplib::Stream {
 public:
  explicit SocketStream(Connection& connection) : connection_(connection) {}
  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* data, std::size_t size) override { return connection_.read(data, size); }
  ssize_t write(const char* data, std::size_t size) override {
    return connection_.write(data, size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return connection_.socket(); }

 private:
  Connection& connection_;
};

/// The library's way to answer a request, over our connections: one request each, bounded in time
/// and size. The library's own listener is not used.
class BoundedServer final : public httplib::Server {
 public:
  BoundedServer(const StopEvent& stop, RefusalLog& log, Seconds time)
      : stop_(stop), log_(log), time_(time) {}
  ~BoundedServer() override { close_listener(); }

  /// Listens once bound. The library lets five wait to be accepted; the sixth would try again after
  /// a second.
  int listening() {
    constexpr int kWaiting = 4096;
    ::listen(svr_sock_, kWaiting);
    return svr_sock_;
  }
  void close_listener() {
    const socket_t socket = svr_sock_.exchange(INVALID_SOCKET);
    if (socket != INVALID_SOCKET) {
      ::close(socket);
    }
  }

  /// Answers and closes. @param trusted  it has shown the token
  void answer(int socket, bool trusted, const std::atomic<bool>& crowded) {
    Connection connection(socket, stop_, crowded, kMaxHead + kMaxBody, time_);
    if (trusted) {
      connection.trust();
    }
    Job job{connection};
    t_job = &job;
    serve(connection, job);
    t_job = nullptr;
    ::close(socket);
  }

 private:
  void serve(Connection& connection, Job& job) {
    const std::string peer = connection.peer();
    SocketStream stream(connection);
    bool closed = false;
    process_request(stream, true, closed, nullptr);
    if (!job.refused && connection.received() > 0) {
      explain(connection, stream, peer);
    }
    if (connection.trouble() != Connection::Trouble::kStopped) {
      connection.finish();
    }
  }

  /// A request that the library gave up on without a word.
  void explain(Connection& connection, SocketStream& stream, const std::string& peer) {
    const int status = status_of(connection.trouble());
    if (status == 0) {
      return;  // it went by itself, or all is well
    }
    log_.add(fmt::format("{}: {}: {}", peer, status, sentence_of(status)));
    connection.set_deadline(kLastWord);
    const std::string answer =
        fmt::format("HTTP/1.1 {0} Refused\r\nContent-Length: {1}\r\nConnection: close\r\n\r\n{2}\n",
                    status, std::strlen(sentence_of(status)) + 1, sentence_of(status));
    stream.write(answer.data(), answer.size());
  }

  const StopEvent& stop_;
  RefusalLog& log_;
  Seconds time_;
};

RequestHead head_of(const httplib::Request& request) {
  RequestHead head;
  head.method = request.method;
  head.path = request.path;
  head.host = request.get_header_value("Host");
  head.origin = request.get_header_value("Origin");
  head.fetch_site = request.get_header_value("Sec-Fetch-Site");
  head.token_header = request.get_header_value("X-Haptrial-Token");
  head.token_query = request.get_param_value("token");
  head.content_type = request.get_header_value("Content-Type");
  head.content_length = request.get_header_value("Content-Length");
  head.transfer_encoding = request.get_header_value("Transfer-Encoding");
  head.content_encoding = request.get_header_value("Content-Encoding");
  head.range = request.get_header_value("Range");
  head.host_headers = static_cast<int>(request.get_header_value_count("Host"));
  return head;
}

std::vector<std::string> names_of(const protocols::AuxiliaryPages& sides) {
  const std::set<std::string, std::less<>> own{"events", "picture", "ask", "note", "answer"};
  std::vector<std::string> names;
  for (const auto& side : sides) {
    const std::string name(side->name());
    const bool letters = !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
      return (c >= 'a' && c <= 'z') || c == '_';
    });
    if (!letters || own.contains(name) ||
        std::find(names.begin(), names.end(), name) != names.end()) {
      throw std::invalid_argument(fmt::format(
          "a page beside the console cannot be named '{}': names are of letters a to z and '_', "
          "none twice and none of the console's own",
          name));
    }
    names.push_back(name);
  }
  return names;
}

void check_options(const ConsoleOptions& o) {
  const auto require = [](bool good, const char* what) {
    if (!good) {
      throw InputError(what);
    }
  };
  require(o.port >= 0 && o.port <= 65535, "the console's port must be 0 to 65535");
  require(o.events_per_second >= 1 && o.events_per_second <= 60,
          "the console's events per second must be 1 to 60");
  require(o.request_time > 0 && o.request_time <= 60, "the console's request time must be > 0 s");
  require(o.workers >= 1 && o.workers <= 256, "the console's workers must be 1 to 256");
  require(o.event_streams >= 1 && o.event_streams <= 256,
          "the console's event streams must be 1 to 256");
  require(o.waiting >= 1, "the console's waiting connections must be 1 or more");
}

}  // namespace

class Console::Implementation {
 public:
  Implementation(SessionControl& control, ConsoleOptions options)
      : control_(control),
        options_(std::move(options)),
        token_(make_token()),
        log_(options_.on_refusal),
        server_(stop_, log_, Seconds(options_.request_time)) {
    check_options(options_);
    const bool loopback = check_console_address(options_.address, options_.allow_remote);
    set_up_server();
    port_ = bind();
    names_ = console_hosts(options_.address, loopback, port_);
    gate_.emplace(RequestFilter::Rules{token_, names_, kMaxBody, names_of(options_.sides)});
    constexpr int kForRequests = 4;  // beside the event streams
    ours_.emplace(options_.event_streams + kForRequests, options_.waiting);
    others_.emplace(options_.workers, options_.waiting);
    door_.emplace(
        server_.listening(), stop_,
        HttpListener::Rules{token_, kSilent, Seconds(options_.request_time)},
        HttpListener::Handlers{[this](int socket, bool trusted) { admit(socket, trusted); },
                               [this](int socket) { turn_away(socket); }});
  }

  ~Implementation() {
    stop_.set();
    door_.reset();
    server_.close_listener();  // tells the library's event streams that it is over
    others_.reset();
    ours_.reset();
  }

  std::string url() const { return fmt::format("http://{}/?token={}", names_.front(), token_); }
  std::string side_url(std::string_view name) const {
    return fmt::format("http://{}/{}?token={}", names_.front(), name, token_);
  }
  int port() const { return port_; }
  const std::string& token() const { return token_; }
  const RefusalLog& log() const { return log_; }

 private:
  int bind() {
    int port = options_.port;
    const bool bound = port == 0 ? (port = server_.bind_to_any_port(options_.address)) > 0
                                 : server_.bind_to_port(options_.address, port);
    if (!bound) {
      throw RunError(
          fmt::format("the console cannot listen at {} port {}: the address is not of this "
                      "machine, or the port is taken",
                      options_.address, options_.port));
    }
    return port;
  }

  /// Hands a connection to the workers of those who have shown the token, which nobody else can
  /// occupy, or to the others.
  void admit(int socket, bool trusted) {
    Workers& workers = trusted ? *ours_ : *others_;
    const std::atomic<bool>& crowded = workers.crowded();
    if (!workers.enqueue(
            [this, socket, trusted, &crowded] { server_.answer(socket, trusted, crowded); })) {
      turn_away(socket);
      ::close(socket);
    }
  }
  void turn_away(int socket) {
    const std::string address = address_of(socket);
    log_.add(fmt::format("{}: 503: too many connections",
                         address.empty() ? "a client that has gone" : address));
  }

  void set_up_server();
  void answer(const httplib::Request& request, httplib::Response& response);
  static void send_page(httplib::Response& response, std::string_view html);
  using MakeEvent = std::function<std::string()>;
  void send_events(httplib::Response& response, MakeEvent make);
  MakeEvent status_events();
  void serve(const std::shared_ptr<protocols::AuxiliaryPage>& side);
  static void take(httplib::Response& response, const std::function<void()>& action);
  void send_picture(httplib::Response& response);
  void send_mirror(httplib::Response& response);
  static void refuse(httplib::Response& response, int status, const std::string& reason);

  SessionControl& control_;
  ConsoleOptions options_;
  std::string token_;
  RefusalLog log_;
  StopEvent stop_;
  std::atomic<int> streams_{0};
  int port_{0};
  std::vector<std::string> names_;
  std::optional<RequestFilter> gate_;
  BoundedServer server_;
  std::optional<Workers> ours_;    // who has shown the token
  std::optional<Workers> others_;  // everybody else
  std::optional<HttpListener> door_;
};

void Console::Implementation::refuse(httplib::Response& response, int status,
                                     const std::string& reason) {
  response.status = status;
  response.set_content(reason + "\n", "text/plain");
}

void Console::Implementation::set_up_server() {
  // The socket does not set SO_REUSEPORT, with which another program of this user could share the
  // port.
  server_.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    ::fcntl(socket, F_SETFD, FD_CLOEXEC);
  });
  server_.set_tcp_nodelay(true);
  server_.set_payload_max_length(kMaxBody);
  server_.set_default_headers({{"Cache-Control", "no-store"},
                               {"Referrer-Policy", "no-referrer"},
                               {"X-Content-Type-Options", "nosniff"},
                               {"X-Frame-Options", "DENY"},
                               {"Cross-Origin-Opener-Policy", "same-origin"},
                               {"Cross-Origin-Resource-Policy", "same-origin"}});
  // Judged before the body is read.
  server_.set_pre_routing_handler([this](const auto& request, auto& response) {
    if (const auto refusal = gate_->judge(head_of(request))) {
      refuse(response, refusal->status, refusal->reason);
      return httplib::Server::HandlerResponse::Handled;
    }
    t_job->connection.trust();
    return httplib::Server::HandlerResponse::Unhandled;
  });
  const httplib::Server::Handler handler = [this](const auto& request, auto& response) {
    answer(request, response);
  };
  server_.Get("/", handler).Get("/events", handler).Post("/ask", handler).Post("/note", handler);
  server_.Get("/picture", handler).Get("/mirror", handler).Post("/answer", handler);
  for (const std::shared_ptr<protocols::AuxiliaryPage>& side : options_.sides) {
    serve(side);
  }
  server_.set_error_handler(httplib::Server::Handler([this](const auto& request, auto& response) {
    if (response.body.empty()) {
      const int cut_off = status_of(t_job->connection.trouble());
      const int status = cut_off != 0 ? cut_off : response.status;
      refuse(response, status, sentence_of(status));
      t_job->connection.set_deadline(kLastWord);
    }
    t_job->refused = true;
    // The token is not in the path, so it does not reach the log.
    log_.add(fmt::format("{}: {} {}: {}: {}", t_job->connection.peer(), request.method,
                         request.path.substr(0, 80), response.status,
                         response.body.substr(0, response.body.size() - 1)));
  }));
}

void Console::Implementation::answer(const httplib::Request& request, httplib::Response& response) {
  if (request.path == "/") {
    return send_page(response, console_page_template());
  }
  if (request.path == "/events") {
    return send_events(response, status_events());
  }
  if (request.path == "/picture") {
    return send_picture(response);
  }
  if (request.path == "/mirror") {
    return send_mirror(response);
  }
  take(response, [&] {
    if (request.path == "/ask") {
      control_.ask(parse_request(request.body));
    } else if (request.path == "/answer") {
      auto [number, text] = parse_answer(request.body);
      control_.answer(number, std::move(text));
    } else {
      const ConsoleNote note = parse_note(request.body);
      control_.note(note.text, note.bad_trial);
    }
  });
}

/// Answers a request whose body asks for something.
void Console::Implementation::take(httplib::Response& response,
                                   const std::function<void()>& action) {
  try {
    action();
    response.set_content("{\"accepted\":true}\n", "application/json");
  } catch (const InputError& error) {
    refuse(response, 400, error.what());
  }
}

void Console::Implementation::serve(const std::shared_ptr<protocols::AuxiliaryPage>& side) {
  using httplib::Request;
  using httplib::Response;
  const std::string at = fmt::format("/{}", side->name());
  server_.Get(at, [side](const Request&, Response& out) { send_page(out, side->html()); });
  server_.Get(at + "/events",
              [this, side](const Request&, Response& out) { send_events(out, side->events()); });
  server_.Post(at + "/ask", [side](const Request& request, Response& out) {
    take(out, [&] { side->ask(request.body); });
  });
}

void Console::Implementation::send_page(httplib::Response& response, std::string_view html) {
  const std::string nonce = make_token();
  response.set_header("Content-Security-Policy", console_page_policy(nonce));
  response.set_content(console_page(html, nonce), "text/html; charset=utf-8");
}

/// Sends the picture of the page that is asked at the moment.
void Console::Implementation::send_picture(httplib::Response& response) {
  const auto picture = control_.status().asked.picture;
  if (!picture) {
    return refuse(response, 404, "no picture is shown now");
  }
  response.set_content(*picture, "image/png");
}

/// Sends what the participant sees.
void Console::Implementation::send_mirror(httplib::Response& response) {
  try {
    const std::string picture = control_.mirror();
    if (picture.empty()) {
      return refuse(response, 404, "the participant has no window");
    }
    response.set_content(picture, "image/png");
  } catch (const RunError& error) {
    refuse(response, 503, error.what());
  }
}

Console::Implementation::MakeEvent Console::Implementation::status_events() {
  return [this] { return status_json(control_.status(), log_.count()); };
}

void Console::Implementation::send_events(httplib::Response& response, MakeEvent make) {
  if (streams_.fetch_add(1) >= options_.event_streams) {
    streams_.fetch_sub(1);
    return refuse(response, 503, fmt::format("{} pages are open already", options_.event_streams));
  }
  const Seconds period(1.0 / options_.events_per_second);
  const Seconds patience(options_.request_time);
  // All in one call: between two, a server that closes would leave out how the session ended.
  response.set_chunked_content_provider(
      "text/event-stream",
      [period, patience, make = std::move(make)](std::size_t, httplib::DataSink& sink) {
        Connection& connection = t_job->connection;
        const auto send = [&](std::string_view before) {
          connection.set_deadline(patience);  // for a page that no longer reads
          const std::string event = fmt::format("{}data: {}\n\n", before, make());
          return sink.write(event.data(), event.size());
        };
        bool open = send("retry: 500\n");
        for (bool goes_on = true; open && goes_on;) {
          goes_on = connection.wait(period);
          open = send("");
        }
        return false;
      },
      [this](bool) { streams_.fetch_sub(1); });
}

Console::Console(SessionControl& control, ConsoleOptions options)
    : implementation_(std::make_unique<Implementation>(control, std::move(options))) {}

Console::~Console() = default;

std::string Console::url() const { return implementation_->url(); }
std::string Console::side_url(std::string_view name) const {
  return implementation_->side_url(name);
}
int Console::port() const { return implementation_->port(); }
const std::string& Console::token() const { return implementation_->token(); }
std::uint64_t Console::refused() const { return implementation_->log().count(); }
std::vector<std::string> Console::refusals() const { return implementation_->log().sentences(); }

}  // namespace haptrial::experiments
