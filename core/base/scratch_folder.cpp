#include "core/base/scratch_folder.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include "core/base/error.h"

namespace haptrial {
namespace fs = std::filesystem;

ScratchFolder::ScratchFolder(std::string_view what) {
  std::string name = (fs::temp_directory_path() / fmt::format("haptrial-{}-XXXXXX", what)).string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw RunError(fmt::format("{}: could not be made: {}", name, std::strerror(errno)));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace haptrial
