#pragma once

#include <httplib.h>

#include <atomic>
#include <cstddef>
#include <string>

#include "experiments/server/connection.h"
#include "experiments/server/request_filter.h"

namespace haptrial::experiments {

/// The library's way to answer a request, over our connections: one request each, bounded in time
/// and size. The library's own listener is not used.
class BoundedServer final : public httplib::Server {
 public:
  /// @param max_body  of a request [bytes].  @param time  for a request
  BoundedServer(const StopEvent& stop, RefusalLog& log, std::size_t max_body,
                Connection::Duration time);
  ~BoundedServer() override;

  /// Listens once bound. @returns the socket
  int listening();
  void close_listener();

  /// Gives every refusal a sentence, and the log as well. Once, before it listens.
  void explain_refusals();

  /// Answers and closes. @param trusted  the client has shown the token
  void answer(int socket, bool trusted, const std::atomic<bool>& crowded);
  /// The connection that this thread answers; within a handler.
  static Connection& connection();

 private:
  struct Job;
  class SocketStream;
  void serve(Job& job);
  void explain_silence(Job& job, SocketStream& stream, const std::string& peer);
  static thread_local Job* current_;

  const StopEvent& stop_;
  RefusalLog& log_;
  std::size_t max_body_;
  Connection::Duration time_;
};

}  // namespace haptrial::experiments
