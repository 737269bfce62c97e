#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "experiments/server/connection.h"

namespace haptrial::experiments {

/// A fixed number of threads and a bounded queue.
class Workers {
 public:
  Workers(int threads, int waiting);
  ~Workers();  // ends when every task that it took is done
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// @returns false, without the task, when the queue is full.
  bool enqueue(std::function<void()> task);
  /// Set while tasks wait.
  const std::atomic<bool>& crowded() const { return crowded_; }

 private:
  void work();

  const std::size_t waiting_;
  std::atomic<bool> crowded_{false};
  std::mutex mutex_;
  std::condition_variable come_;
  std::deque<std::function<void()>> tasks_;
  bool ended_{false};
  std::vector<std::thread> threads_;
};

/// Whether what came of a request so far shows the token, in its header or its address.
bool shows_token(const std::string& text, const std::string& token);

/// Takes connections in on a thread of its own that does nothing else, so that a flood finds no
/// queue to fill, and sorts them by their first bytes: who shows the token is let in ahead of
/// everybody else. Who says nothing costs a descriptor and no thread. When too many say nothing,
/// the oldest of the address that has most of them goes.
class HttpListener {
 public:
  struct Rules {
    std::string token;
    std::size_t silent{256};             // connections that have said nothing yet, at most
    Connection::Duration patience{2.0};  // with one that says nothing [s]
  };
  /// Callbacks on the door's thread; `admit` takes the socket over, `refuse` leaves it.
  struct Handlers {
    std::function<void(int socket, bool trusted)> admit;
    std::function<void(int socket)> refuse;
  };

  /// @param listening  a socket; it and `stop` outlive the door.
  HttpListener(int listening, const StopEvent& stop, Rules rules, Handlers handlers);
  ~HttpListener();  // once `stop` is set
  HttpListener(const HttpListener&) = delete;
  HttpListener& operator=(const HttpListener&) = delete;

 private:
  struct Client {
    int socket;
    std::string address;
    std::chrono::steady_clock::time_point came;
  };
  void run();
  void take_in();
  void sort_out(const std::vector<bool>& spoke);
  void make_room();
  /// @returns whether it has gone, to a worker or for good.
  bool see_to(const Client& client);

  int listening_;
  int stop_;
  Rules rules_;
  Handlers handlers_;
  std::vector<Client> clients_;  // in the order in which they came
  std::thread thread_;
};

}  // namespace haptrial::experiments
