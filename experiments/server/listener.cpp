#include "experiments/server/listener.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <map>
#include <utility>

#include "experiments/server/request_filter.h"

namespace haptrial::experiments {

using Clock = std::chrono::steady_clock;

Workers::Workers(int threads, int waiting) : waiting_(static_cast<std::size_t>(waiting)) {
  for (int i = 0; i < threads; ++i) {
    threads_.emplace_back([this] { work(); });
  }
}

Workers::~Workers() {
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
  }
  come_.notify_all();
  for (std::thread& thread : threads_) {
    thread.join();
  }
}

bool Workers::enqueue(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    if (tasks_.size() >= waiting_) {
      return false;
    }
    tasks_.push_back(std::move(task));
    crowded_ = true;
  }
  come_.notify_one();
  return true;
}

void Workers::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    come_.wait(lock, [this] { return ended_ || !tasks_.empty(); });
    if (tasks_.empty()) {
      return;
    }
    const auto task = std::move(tasks_.front());
    tasks_.pop_front();
    crowded_ = !tasks_.empty();
    lock.unlock();
    task();
    lock.lock();
  }
}

bool shows_token(const std::string& text, const std::string& token) {
  constexpr std::string_view kWord = "oken";  // of X-Haptrial-Token: and of ?token=
  for (auto at = text.find(kWord); at != std::string::npos; at = text.find(kWord, at + 1)) {
    const auto from = text.find_first_not_of(":= ", at + kWord.size());
    if (from != std::string::npos && is_same_secret(text.substr(from, token.size()), token)) {
      return true;
    }
  }
  return false;
}

HttpListener::HttpListener(int listening, const StopEvent& stop, Rules rules, Handlers handlers)
    : listening_(listening),
      stop_(stop.descriptor()),
      rules_(std::move(rules)),
      handlers_(std::move(handlers)) {
  ::fcntl(listening_, F_SETFL, ::fcntl(listening_, F_GETFL) | O_NONBLOCK);
  thread_ = std::thread([this] { run(); });
}

HttpListener::~HttpListener() {
  thread_.join();
  for (const Client& client : clients_) {
    ::close(client.socket);
  }
}

void HttpListener::run() {
  constexpr int kSlice = 25;  // between two looks at the time [ms]
  std::vector<pollfd> watched;
  std::vector<bool> spoke;
  for (;;) {
    watched = {{stop_, POLLIN, 0}, {listening_, POLLIN, 0}};
    for (const Client& client : clients_) {
      watched.push_back({client.socket, POLLIN, 0});
    }
    ::poll(watched.data(), watched.size(), clients_.empty() ? -1 : kSlice);
    if (watched[0].revents != 0) {
      return;
    }
    spoke.assign(clients_.size(), false);
    for (std::size_t i = 0; i < clients_.size(); ++i) {
      spoke[i] = watched[i + 2].revents != 0;
    }
    sort_out(spoke);
    if (watched[1].revents != 0) {
      take_in();
    }
  }
}

void HttpListener::sort_out(const std::vector<bool>& spoke) {
  const auto patience = std::chrono::duration_cast<Clock::duration>(rules_.patience);
  const auto now = Clock::now();
  std::vector<Client> stay;
  for (std::size_t i = 0; i < clients_.size(); ++i) {
    const Client& client = clients_[i];
    if (spoke[i] && see_to(client)) {
      continue;
    }
    if (now - client.came > patience) {  // browsers open some ahead of need: no refusal
      ::close(client.socket);
      continue;
    }
    stay.push_back(client);
  }
  clients_ = std::move(stay);
}

bool HttpListener::see_to(const Client& client) {
  std::array<char, 2048> first;
  const ssize_t count = ::recv(client.socket, first.data(), first.size(), MSG_PEEK | MSG_DONTWAIT);
  if (count < 0 && (errno == EAGAIN || errno == EINTR)) {
    return false;
  }
  if (count <= 0) {
    ::close(client.socket);
    return true;
  }
  const std::string text(first.data(), static_cast<std::size_t>(count));
  handlers_.admit(client.socket, shows_token(text, rules_.token));
  return true;
}

void HttpListener::take_in() {
  constexpr int kAtOnce = 64;  // before it looks again who has spoken
  for (int i = 0; i < kAtOnce; ++i) {
    const int socket = ::accept4(listening_, nullptr, nullptr, SOCK_CLOEXEC);
    if (socket < 0) {
      if ((errno == EMFILE || errno == ENFILE) && !clients_.empty()) {
        make_room();
        continue;
      }
      return;
    }
    Client client{socket, address_of(socket), Clock::now()};
    if (see_to(client)) {
      continue;
    }
    if (clients_.size() >= rules_.silent) {
      make_room();
    }
    clients_.push_back(std::move(client));
  }
}

void HttpListener::make_room() {
  std::map<std::string, int> of_address;
  for (const Client& client : clients_) {
    ++of_address[client.address];
  }
  const auto most =
      std::max_element(of_address.begin(), of_address.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  const auto oldest = std::find_if(clients_.begin(), clients_.end(), [&](const Client& client) {
    return client.address == most->first;
  });
  handlers_.refuse(oldest->socket);
  ::close(oldest->socket);
  clients_.erase(oldest);
}

}  // namespace haptrial::experiments
