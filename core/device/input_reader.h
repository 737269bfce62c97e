#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/device/input_file.h"

namespace haptrial::device {

/// Something that happened to an input device while it was read.
struct InputChange {
  bool back{false};  // else it was lost
  std::string why;   // of a loss
};

/// Reads an input device on a thread of its own. One that is lost is looked for again twice a
/// second.
class InputReader {
 public:
  /// Callbacks of the reader's user. After the constructor both are called on the reading thread.
  struct Use {
    std::string table;  // as InputFile has it
    /// Checks one that was opened. @throws InputError if it does not do
    std::function<void(InputFile&)> open;
    /// Called when something may have changed. Null: it is lost.
    std::function<void(const InputReports*)> show;
  };

  /// @throws InputError as InputFile and Use::open do
  InputReader(std::string path, Use use);
  InputReader(const InputReader&) = delete;
  InputReader& operator=(const InputReader&) = delete;

  /// Changes since the last call. Any thread but the servo thread.
  std::vector<InputChange> take_changes();
  const std::string& path() const { return path_; }

 private:
  void open();
  void read(const std::stop_token& stop);
  void lose();
  void try_again(const std::stop_token& stop);

  std::string path_;
  Use use_;
  std::unique_ptr<InputFile> file_;  // null while it is lost; the reading thread's
  std::mutex mutex_;
  std::vector<InputChange> changes_;
  std::jthread thread_;  // last: it uses the others
};

}  // namespace haptrial::device
