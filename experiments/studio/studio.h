#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace haptrial::experiments {

struct StudioOptions {
  std::filesystem::path folder{"."};                         // of the definitions
  std::string program{"/proc/self/exe"};                     // runs the commands
  std::filesystem::path libraries{"/usr/share/javascript"};  // where CodeMirror may be
  int port{0};                                               // 0: any that is free
  double request_time{20.0};  // a request, or the sending of an answer, that takes longer is cut
                              // off [s]
  std::function<void(const std::string&)> on_refusal{};
};

/// A page on this machine in which a study lives from its draft to its report. All that it does is
/// one of the program's commands, run as a child process in the folder; all that it shows is what
/// they print and write. The page is behind the guard of experiments/server, on the loopback
/// address alone.
class Studio {
 public:
  /// Serves when it returns. @throws InputError for a folder or port that is not allowed; RunError
  /// if the port is taken.
  explicit Studio(const StudioOptions& options);
  /// Kills what still runs and hangs up.
  ~Studio();
  Studio(const Studio&) = delete;
  Studio& operator=(const Studio&) = delete;

  std::string url() const;  // with the token
  int port() const;
  const std::string& token() const;
  std::uint64_t refused() const;
  std::vector<std::string> refusals() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// The studio's page with its styles and scripts as they stand in the source; built in.
std::string_view studio_page_template();

}  // namespace haptrial::experiments
