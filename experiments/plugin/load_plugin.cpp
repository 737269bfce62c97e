#include "experiments/plugin/load_plugin.h"

#include <dlfcn.h>
#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "analysis/scores/score.h"
#include "core/base/error.h"
#include "core/base/files/file_text.h"
#include "core/device/own_devices.h"
#include "core/scene/read/field_kinds.h"
#include "experiments/plugin/loaded/loaded_plugins.h"
#include "experiments/plugin/plugin.h"
#include "experiments/studies/registry.h"

namespace haptrial::experiments {
namespace fs = std::filesystem;
namespace {

constexpr const char* kEntry = "haptrial_plugin";

/// @throws std::invalid_argument for a line that is not "PATH | DEFAULT | MEANING"
void check_key_lines(std::string_view lines) {
  std::istringstream stream{std::string(lines)};
  for (std::string line; std::getline(stream, line);) {
    if (!line.empty() && std::count(line.begin(), line.end(), '|') != 2) {
      throw std::invalid_argument(
          fmt::format("'{}' says nothing of a key; allowed: PATH | DEFAULT | MEANING", line));
    }
  }
}

/// Into the registries of the program, with a list of what it was.
class Registries final : public PluginParts {
 public:
  void protocol(const Study& study) override {
    add_study(study);
    gives.push_back(fmt::format("protocol:{}", study.protocol().name()));
  }
  void device(const device::OwnDevice& device) override {
    device::add_own_device(device);
    gives.push_back("device:" + device.name);
  }
  void field(const scene::KindOfField& kind) override {
    scene::add_kind_of_field(kind);
    gives.push_back("field:" + kind.word);
  }
  void score(const analysis::Score& score) override {
    analysis::add_score(score);
    gives.push_back(fmt::format("score:{}", score.name()));
  }
  void key_words(const char* lines) override {
    check_key_lines(lines);
    words += lines;
    words += '\n';
  }
  std::vector<std::string> gives;
  std::string words;
};

std::string bytes_of(const fs::path& file) {
  std::error_code missing;
  if (!fs::exists(file, missing)) {
    throw InputError(
        fmt::format("--plugin: there is no file {}; name a shared object (.so)", file.string()));
  }
  return file_text(file);
}

std::string sha256_of(const std::string& bytes) {
  std::array<unsigned char, crypto_hash_sha256_BYTES> hash{};
  crypto_hash_sha256(hash.data(), reinterpret_cast<const unsigned char*>(bytes.data()),
                     bytes.size());
  std::string text;
  for (const unsigned char each : hash) {
    text += fmt::format("{:02x}", each);
  }
  return text;
}

/// Before any of its code runs: a constructor of another program's classes may do anything.
void check_bytes(const fs::path& file, const std::string& bytes) {
  if (!bytes.starts_with("\x7f"
                         "ELF")) {
    throw InputError(
        fmt::format("--plugin: {} is not a shared object; name a .so that was built "
                    "as docs/guide-plugin.md says",
                    file.string()));
  }
  const std::string_view mark = HAPTRIAL_PLUGIN_MARK;
  const std::size_t at = bytes.find(mark);
  if (at == std::string::npos) {
    throw InputError(
        fmt::format("--plugin: {} is no plug-in of haptrial: it has no entry {}() "
                    "(HAPTRIAL_PLUGIN in docs/guide-plugin.md)",
                    file.string(), kEntry));
  }
  const std::string built_for = bytes.c_str() + at + mark.size();
  if (built_for != plugin_abi()) {
    throw InputError(
        fmt::format("--plugin: {} was built for haptrial {}, and this is haptrial {}; build it "
                    "again",
                    file.string(), built_for, plugin_abi()));
  }
}

const PluginEntry& entry_of(const fs::path& file) {
  void* const handle = dlopen(fs::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) {
    const char* reason = dlerror();
    throw InputError(
        fmt::format("--plugin: {} cannot be loaded ({}); link what this program does "
                    "not have into it",
                    file.string(), reason != nullptr ? reason : "no reason given"));
  }
  using Entry = const PluginEntry*();
  auto* const entry = reinterpret_cast<Entry*>(dlsym(handle, kEntry));
  if (entry == nullptr || entry() == nullptr) {
    throw InputError(fmt::format("--plugin: {} is no plug-in of haptrial: it has no entry {}()",
                                 file.string(), kEntry));
  }
  return *entry();
}

/// Names and versions stand in session files, between blanks.
void check_word(const fs::path& file, const char* what, const std::string& word) {
  const bool good = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char each) {
    return std::isalnum(each) != 0 || each == '-' || each == '_' || each == '.';
  });
  if (!good) {
    throw InputError(
        fmt::format("--plugin: the {} of {} is '{}'; allowed: letters, digits, '-', "
                    "'_', '.'",
                    what, file.string(), word));
  }
}

void check_new(const fs::path& file, const std::string& name) {
  for (const LoadedPlugin& other : loaded_plugins()) {
    if (other.name == name) {
      throw InputError(
          fmt::format("--plugin: {} is the plug-in '{}', which {} is already; leave "
                      "out one of them",
                      file.string(), name, other.file));
    }
  }
}

}  // namespace

std::string plugin_abi() { return HAPTRIAL_PLUGIN_ABI; }

void load_plugin(const fs::path& file) {
  const std::string bytes = bytes_of(file);
  check_bytes(file, bytes);
  const PluginEntry& entry = entry_of(file);
  LoadedPlugin plugin{entry.name, entry.version, file.string(), sha256_of(bytes), {}, {}};
  check_word(file, "name", plugin.name);
  check_word(file, "version", plugin.version);
  check_new(file, plugin.name);
  Registries registries;
  try {
    entry.add(registries);
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("--plugin: {} cannot be added: {}", file.string(), error.what()));
  }
  plugin.gives = std::move(registries.gives);
  plugin.key_words = std::move(registries.words);
  note_plugin(std::move(plugin));
}

void load_plugins(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("HAPTRIAL_PLUGINS: there is no folder {}", folder.string()));
  }
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".so") {
      files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    load_plugin(file);
  }
}

}  // namespace haptrial::experiments
