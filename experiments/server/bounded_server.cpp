#include <fmt/format.h>

#include <cstring>

#include "experiments/server/bounded_server_internal.h"

namespace haptrial::experiments {
namespace {

constexpr std::size_t kMaxHead = 8192;
const Connection::Duration kLastWord(0.2);  // for a client that was cut off to take its answer

/// The answer to a client that was cut off, or 0.
int status_of(Connection::Trouble trouble) {
  return trouble == Connection::Trouble::kTooLarge  ? 431
         : trouble == Connection::Trouble::kTooSlow ? 408
                                                    : 0;
}

const char* sentence_of_status(int status) {
  return status == 431   ? "the request is too large"
         : status == 408 ? "the request took too long"
         : status >= 500 ? "the server failed on this request"
                         : "the request is malformed";
}

}  // namespace

/// Job of a worker; the library's handlers run inside it.
struct BoundedServer::Job {
  Connection& connection;
  bool refused{false};
};

thread_local BoundedServer::Job* BoundedServer::current_ = nullptr;

class BoundedServer::SocketStream final : public httplib::Stream {
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

BoundedServer::BoundedServer(const StopEvent& stop, RefusalLog& log, std::size_t max_body,
                             Connection::Duration time)
    : stop_(stop), log_(log), max_body_(max_body), time_(time) {}

BoundedServer::~BoundedServer() { close_listener(); }

int BoundedServer::listening() {
  // The library lets five wait to be accepted; the sixth would try again after a second.
  constexpr int kWaiting = 4096;
  ::listen(svr_sock_, kWaiting);
  return svr_sock_;
}

void BoundedServer::close_listener() {
  const socket_t socket = svr_sock_.exchange(INVALID_SOCKET);
  if (socket != INVALID_SOCKET) {
    ::close(socket);
  }
}

Connection& BoundedServer::connection() { return current_->connection; }

void BoundedServer::answer(int socket, bool trusted, const std::atomic<bool>& crowded) {
  Connection connection(socket, stop_, crowded, kMaxHead + max_body_, time_);
  if (trusted) {
    connection.trust();
  }
  Job job{connection};
  current_ = &job;
  serve(job);
  current_ = nullptr;
  ::close(socket);
}

void BoundedServer::serve(Job& job) {
  const std::string peer = job.connection.peer();
  SocketStream stream(job.connection);
  bool closed = false;
  process_request(stream, true, closed, nullptr);
  if (!job.refused && job.connection.received() > 0) {
    explain_silence(job, stream, peer);
  }
  if (job.connection.trouble() != Connection::Trouble::kStopped) {
    job.connection.finish();
  }
}

/// A request that the library gave up on without a word.
void BoundedServer::explain_silence(Job& job, SocketStream& stream, const std::string& peer) {
  const int status = status_of(job.connection.trouble());
  if (status == 0) {
    return;  // the client went by itself, or all is well
  }
  const char* sentence = sentence_of_status(status);
  log_.add(fmt::format("{}: {}: {}", peer, status, sentence));
  job.connection.set_deadline(kLastWord);
  const std::string answer =
      fmt::format("HTTP/1.1 {0} Refused\r\nContent-Length: {1}\r\nConnection: close\r\n\r\n{2}\n",
                  status, std::strlen(sentence) + 1, sentence);
  stream.write(answer.data(), answer.size());
}

void BoundedServer::explain_refusals() {
  set_error_handler(httplib::Server::Handler([this](const auto& request, auto& response) {
    Connection& connection = current_->connection;
    if (response.body.empty()) {
      const int cut_off = status_of(connection.trouble());
      response.status = cut_off != 0 ? cut_off : response.status;
      response.set_content(std::string(sentence_of_status(response.status)) + "\n", "text/plain");
      connection.set_deadline(kLastWord);
    }
    current_->refused = true;
    // The token is not in the path, so it does not reach the log.
    log_.add(fmt::format("{}: {} {}: {}: {}", connection.peer(), request.method,
                         request.path.substr(0, 80), response.status,
                         response.body.substr(0, response.body.size() - 1)));
  }));
}

}  // namespace haptrial::experiments
