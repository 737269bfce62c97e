#include "core/base/parallel.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace haptrial {

int threads_or_all(int threads) {
  return threads > 0 ? threads : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

struct SharedWork::Impl {
  Impl(std::size_t items, std::function<Work()> maker) : count(items), make(std::move(maker)) {}
  void take_items();
  void keep_failure(std::size_t item);

  std::size_t count;
  std::function<Work()> make;
  std::atomic<std::size_t> next{0};
  std::mutex lock;  // the four below
  std::condition_variable left;
  std::size_t running{0};  // threads
  std::size_t failed_item{0};
  std::exception_ptr failure;
  std::vector<std::jthread> threads;  // last: ends before what it uses
};

void SharedWork::Impl::take_items() {
  if (next.load() >= count) {
    return;
  }
  Work work;
  for (std::size_t item; (item = next.fetch_add(1)) < count;) {
    try {
      if (!work) {
        work = make();
      }
      work(item);
    } catch (...) {
      keep_failure(item);
    }
  }
}

void SharedWork::Impl::keep_failure(std::size_t item) {
  next.store(count);
  const std::lock_guard guard(lock);
  if (!failure || item < failed_item) {
    failed_item = item;
    failure = std::current_exception();
  }
}

SharedWork::SharedWork(std::size_t count, int threads, std::function<Work()> make)
    : impl_(std::make_unique<Impl>(count, std::move(make))) {
  const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 0)));
  for (std::size_t i = 0; i < wanted; ++i) {
    {
      const std::lock_guard guard(impl_->lock);
      ++impl_->running;
    }
    impl_->threads.emplace_back([impl = impl_.get()] {
      impl->take_items();
      const std::lock_guard guard(impl->lock);
      --impl->running;
      impl->left.notify_all();
    });
  }
}

SharedWork::~SharedWork() { impl_->next.store(impl_->count); }

void SharedWork::help() { impl_->take_items(); }

bool SharedWork::ended_within(std::chrono::milliseconds time) {
  std::unique_lock guard(impl_->lock);
  return impl_->left.wait_for(guard, time, [this] { return impl_->running == 0; });
}

void SharedWork::finish() {
  impl_->threads.clear();  // joins
  if (impl_->failure) {
    std::rethrow_exception(impl_->failure);
  }
}

void parallel_for(std::size_t count, int threads, const std::function<void(std::size_t)>& work) {
  SharedWork shared(count, std::max(threads, 1) - 1, [&work] { return std::ref(work); });
  shared.help();
  shared.finish();
}

}  // namespace haptrial
