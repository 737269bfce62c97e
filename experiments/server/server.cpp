#include "experiments/server/server.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <httplib.h>

#include <atomic>
#include <optional>
#include <utility>

#include "core/base/error.h"
#include "experiments/server/access.h"
#include "experiments/server/bounded_server_internal.h"
#include "experiments/server/connection.h"
#include "experiments/server/listener.h"
#include "experiments/server/request_filter.h"

namespace haptrial::experiments {
namespace {

using Seconds = Connection::Duration;

constexpr std::size_t kSilent = 256;  // connections that have said nothing

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

WebRequest request_of(const httplib::Request& request) {
  WebRequest out{request.path, {}, request.body};
  for (const auto& [name, value] : request.params) {
    if (name != "token") {
      out.query[name] = value;
    }
  }
  return out;
}

void check_server_options(const ServerOptions& o) {
  const auto require = [](bool good, const char* what) {
    if (!good) {
      throw InputError(what);
    }
  };
  require(o.port >= 0 && o.port <= 65535, "the page's port must be 0 to 65535");
  require(o.events_per_second >= 1 && o.events_per_second <= 60,
          "the page's events per second must be 1 to 60");
  require(o.request_time > 0 && o.request_time <= 60, "the page's request time must be > 0 s");
  require(o.workers >= 1 && o.workers <= 256, "the page's workers must be 1 to 256");
  require(o.event_streams >= 1 && o.event_streams <= 256,
          "the page's event streams must be 1 to 256");
  require(o.waiting >= 1, "the page's waiting connections must be 1 or more");
}

std::vector<RequestFilter::Place> places_of(const std::vector<WebRoute>& routes) {
  std::vector<RequestFilter::Place> places;
  for (const WebRoute& route : routes) {
    places.push_back(
        {route.path, route.kind == WebRoute::Kind::kPage, route.kind != WebRoute::Kind::kPost});
  }
  return places;
}

WebAnswer answer_of(const WebRoute& route, const WebRequest& request) {
  try {
    return route.answer(request);
  } catch (const InputError& error) {
    return refusal(400, error.what());
  } catch (const RunError& error) {
    return refusal(503, error.what());
  }
}

void fill(httplib::Response& response, const WebAnswer& answer) {
  response.status = answer.status;
  for (const auto& [name, value] : answer.headers) {
    response.headers.erase(name);
    response.set_header(name, value);
  }
  response.set_content(answer.body, answer.type);
}

}  // namespace

WebAnswer refusal(int status, const std::string& reason) {
  return {status, "text/plain; charset=utf-8", reason + "\n"};
}

WebAnswer page_answer(std::string_view html, std::string_view more_policy) {
  const std::string nonce = make_token();
  std::string policy = page_policy(nonce);
  if (!more_policy.empty()) {
    policy += fmt::format("; {}", more_policy);
  }
  return {200,
          "text/html; charset=utf-8",
          page_with_nonce(html, nonce),
          {{"Content-Security-Policy", policy}}};
}

class GuardedServer::Implementation {
 public:
  Implementation(ServerOptions options, std::vector<WebRoute> routes)
      : options_(std::move(options)),
        token_(make_token()),
        log_(options_.on_refusal),
        server_(stop_, log_, options_.max_body, Seconds(options_.request_time)) {
    check_server_options(options_);
    const bool loopback = check_server_address(options_.address, options_.allow_remote);
    set_up();
    RequestFilter::Rules rules{token_, {}, options_.max_body, places_of(routes)};
    for (WebRoute& route : routes) {
      serve(std::move(route));
    }
    port_ = bind();
    names_ = server_hosts(options_.address, loopback, port_);
    rules.hosts = names_;
    filter_.emplace(std::move(rules));
    own_.emplace(options_.event_streams + options_.own_workers, options_.waiting);
    others_.emplace(options_.workers, options_.waiting);
    listener_.emplace(
        server_.listening(), stop_,
        HttpListener::Rules{token_, kSilent, Seconds(options_.request_time)},
        HttpListener::Handlers{[this](int socket, bool trusted) { admit(socket, trusted); },
                               [this](int socket) { turn_away(socket); }});
  }

  ~Implementation() {
    stop_.set();
    listener_.reset();
    server_.close_listener();  // tells the library's event streams that it is over
    others_.reset();
    own_.reset();
  }

  std::string url(std::string_view path) const {
    return fmt::format("http://{}{}?token={}", names_.front(), path, token_);
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
          fmt::format("the page cannot be served at {} port {}: the address is not of this "
                      "machine, or the port is taken",
                      options_.address, options_.port));
    }
    return port;
  }

  /// Hands a connection to the workers of those who have shown the token, which nobody else can
  /// occupy, or to the others.
  void admit(int socket, bool trusted) {
    Workers& workers = trusted ? *own_ : *others_;
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

  void set_up();
  void serve(WebRoute route);
  void send_events(httplib::Response& response, WebEvents make);

  ServerOptions options_;
  std::string token_;
  RefusalLog log_;
  StopEvent stop_;
  std::atomic<int> streams_{0};
  int port_{0};
  std::vector<std::string> names_;
  std::optional<RequestFilter> filter_;
  BoundedServer server_;
  std::optional<Workers> own_;     // for those who have shown the token
  std::optional<Workers> others_;  // for everybody else
  std::optional<HttpListener> listener_;
};

void GuardedServer::Implementation::set_up() {
  // The socket does not set SO_REUSEPORT, with which another program of this user could share the
  // port.
  server_.set_socket_options([](socket_t socket) {
    const int yes = 1;
    ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    ::fcntl(socket, F_SETFD, FD_CLOEXEC);
  });
  server_.set_tcp_nodelay(true);
  server_.set_payload_max_length(options_.max_body);
  server_.set_default_headers({{"Cache-Control", "no-store"},
                               {"Referrer-Policy", "no-referrer"},
                               {"X-Content-Type-Options", "nosniff"},
                               {"X-Frame-Options", "DENY"},
                               {"Cross-Origin-Opener-Policy", "same-origin"},
                               {"Cross-Origin-Resource-Policy", "same-origin"}});
  // Judged before the body is read.
  server_.set_pre_routing_handler([this](const auto& request, auto& response) {
    if (const auto refused = filter_->judge(head_of(request))) {
      fill(response, refusal(refused->status, refused->reason));
      return httplib::Server::HandlerResponse::Handled;
    }
    server_.connection().trust();
    return httplib::Server::HandlerResponse::Unhandled;
  });
  server_.explain_refusals();
}

void GuardedServer::Implementation::serve(WebRoute route) {
  const std::string path = route.path;
  const bool posts = route.kind == WebRoute::Kind::kPost;
  const httplib::Server::Handler handler = [this, route = std::move(route)](
                                               const httplib::Request& request,
                                               httplib::Response& response) {
    if (route.events) {
      return send_events(response, route.events());
    }
    fill(response, answer_of(route, request_of(request)));
    server_.connection().set_deadline(Seconds(options_.request_time));
  };
  posts ? server_.Post(path, handler) : server_.Get(path, handler);
}

void GuardedServer::Implementation::send_events(httplib::Response& response, WebEvents make) {
  if (streams_.fetch_add(1) >= options_.event_streams) {
    streams_.fetch_sub(1);
    return fill(response,
                refusal(503, fmt::format("{} pages are open already", options_.event_streams)));
  }
  const Seconds period(1.0 / options_.events_per_second);
  const Seconds patience(options_.request_time);
  // All in one call: between two, a server that closes would leave out how the session ended.
  response.set_chunked_content_provider(
      "text/event-stream",
      [this, period, patience, make = std::move(make)](std::size_t, httplib::DataSink& sink) {
        Connection& connection = server_.connection();
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
        if (open) {
          sink.done();  // of a stream that just breaks off a browser may drop the last event
        }
        return open;
      },
      [this](bool) { streams_.fetch_sub(1); });
}

GuardedServer::GuardedServer(ServerOptions options, std::vector<WebRoute> routes)
    : implementation_(std::make_unique<Implementation>(std::move(options), std::move(routes))) {}

GuardedServer::~GuardedServer() = default;

std::string GuardedServer::url(std::string_view path) const { return implementation_->url(path); }
int GuardedServer::port() const { return implementation_->port(); }
const std::string& GuardedServer::token() const { return implementation_->token(); }
std::uint64_t GuardedServer::refused() const { return implementation_->log().count(); }
std::vector<std::string> GuardedServer::refusals() const {
  return implementation_->log().sentences();
}

}  // namespace haptrial::experiments
