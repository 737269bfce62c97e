#include "core/device/input_reader.h"

#include <chrono>
#include <utility>

#include "core/base/error.h"

namespace haptrial::device {
namespace {

constexpr std::chrono::milliseconds kLook{50};    // for the end of the session
constexpr std::chrono::milliseconds kRetry{500};  // until a lost device is looked for again

}  // namespace

InputReader::InputReader(std::string path, Use use) : path_(std::move(path)), use_(std::move(use)) {
  open();
  thread_ = std::jthread([this](const std::stop_token& stop) { read(stop); });
}

std::vector<InputChange> InputReader::take_changes() {
  const std::lock_guard lock(mutex_);
  return std::exchange(changes_, {});
}

void InputReader::open() {
  auto file = std::make_unique<InputFile>(path_, use_.table);
  use_.open(*file);
  file_ = std::move(file);
  use_.show(&file_->reports());
}

void InputReader::read(const std::stop_token& stop) {
  while (!stop.stop_requested()) {
    if (file_ == nullptr) {
      try_again(stop);
    } else if (file_->wait(kLook)) {
      use_.show(&file_->reports());
    } else {
      lose();
    }
  }
}

void InputReader::lose() {
  use_.show(nullptr);
  const std::lock_guard lock(mutex_);
  changes_.push_back({false, file_->error()});
  file_.reset();
}

void InputReader::try_again(const std::stop_token& stop) {
  for (auto waited = kLook; waited <= kRetry && !stop.stop_requested(); waited += kLook) {
    std::this_thread::sleep_for(kLook);
  }
  try {
    open();
  } catch (const InputError&) {
    return;  // still away
  }
  const std::lock_guard lock(mutex_);
  changes_.push_back({true, ""});
}

}  // namespace haptrial::device
