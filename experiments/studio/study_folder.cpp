#include "experiments/studio/study_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <sstream>
#include <system_error>

#include "core/base/error.h"
#include "core/base/file_text.h"
#include "core/base/fnv.h"
#include "core/base/whole_file.h"

namespace haptrial::experiments {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMostText = 2'000'000;  // of a definition [bytes]

std::string stamp_of(const std::string& text) { return fmt::format("{:016x}", fnv1a(text)); }

std::string stem_of(const std::string& definition) { return fs::path(definition).stem().string(); }

bool is_control(char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; }

/// @throws InputError for a name that might lead out, or that a command would take for an option.
void check_name(const std::string& name) {
  const auto refuse = [&](const char* why) {
    throw InputError(fmt::format("the name of a file {}; allowed: names within the folder", why));
  };
  if (name.empty() || name.size() > 1000) {
    refuse("is empty or too long");
  }
  if (std::ranges::any_of(name, is_control)) {
    refuse("has control characters");
  }
  if (name.front() == '/' || name.front() == '-') {
    refuse("begins with '/' or '-'");
  }
  for (const fs::path& part : fs::path(name)) {
    if (part.empty() || part.native().front() == '.') {
      refuse("has a part that is empty or begins with '.'");
    }
  }
}

/// Whether a file of TOML defines an experiment, be it with mistakes; a lab's file does not.
bool defines_experiment(const fs::path& file) {
  constexpr std::size_t kLooked = 100'000;
  static const std::regex kTable(
      R"(\s*(\[\s*["']?experiment\b(?!-)|["']?experiment["']?\s*[.=]).*)");
  try {
    std::istringstream lines(file_head(file, kLooked));
    for (std::string line; std::getline(lines, line);) {
      if (std::regex_match(line.substr(0, 200), kTable)) {
        return true;
      }
    }
    return false;
  } catch (const InputError&) {
    return false;
  }
}

/// Stems of definitions that begin with another one's: "pulls-002" beside "pulls".
std::vector<std::string> longer_stems(const std::vector<std::string>& definitions,
                                      const std::string& stem) {
  std::vector<std::string> longer;
  for (const std::string& definition : definitions) {
    if (const std::string other = stem_of(definition); other != stem && other.starts_with(stem)) {
      longer.push_back(other);
    }
  }
  return longer;
}

/// Whether a folder's name is a stem, or goes on behind it with '-'.
bool continues(const std::string& name, const std::string& stem) {
  return name == stem || name.starts_with(stem + "-");
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first ==
         folder.end();
}

}  // namespace

StudyFolder::StudyFolder(const fs::path& folder) {
  std::error_code error;
  root_ = fs::canonical(folder, error);
  if (error || !fs::is_directory(root_)) {
    throw InputError(
        fmt::format("{}: not a folder; give the folder of the definitions", folder.string()));
  }
}

fs::path StudyFolder::inside(const std::string& name) const {
  check_name(name);
  std::error_code error;
  const fs::path file = fs::canonical(root_ / name, error);
  if (error) {
    throw InputError(fmt::format("{}: {}", name, error.message()));
  }
  if (!lies_in(file, root_)) {
    throw InputError(fmt::format("{}: a symbolic link leads out of the folder", name));
  }
  return file;
}

bool StudyFolder::holds(const std::string& name) const {
  std::error_code error;
  const fs::path file = fs::canonical(root_ / name, error);
  return !error && lies_in(file, root_);
}

fs::path StudyFolder::definition(const std::string& name) const {
  const fs::path file = inside(name);
  if (!name.ends_with(".toml") || file.extension() != ".toml") {
    throw InputError(fmt::format("{}: not a definition; allowed: files that end in .toml", name));
  }
  return file;
}

std::vector<std::string> StudyFolder::definitions() const {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(root_)) {
    const std::string name = entry.path().filename().string();
    std::error_code ignored;
    if (name.ends_with(".toml") && name.front() != '.' &&
        name.find(".texts.") == std::string::npos && entry.is_regular_file(ignored) &&
        holds(name) && defines_experiment(entry.path())) {
      names.push_back(name);
    }
  }
  std::ranges::sort(names);
  return names;
}

std::string StudyFolder::sessions_of(const std::string& definition) {
  return "out/" + stem_of(definition);
}

std::vector<std::string> StudyFolder::session_folders(const std::string& definition) const {
  return folders_like(definition, "((-rehearsal)?-[0-9]{3,})?");
}

std::vector<std::string> StudyFolder::export_folders(const std::string& definition) const {
  return folders_like(definition, "((-rehearsal)?-[0-9]{3,})?-(csv|bids)-[0-9]{3,}");
}

std::vector<std::string> StudyFolder::folders_like(const std::string& definition,
                                                   const char* pattern) const {
  std::vector<std::string> names;
  const std::regex more(pattern);
  const std::string stem = stem_of(definition);
  const std::vector<std::string> longer = longer_stems(definitions(), stem);
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(root_ / "out", error)) {
    const std::string name = entry.path().filename().string();
    std::error_code ignored;
    if (name.starts_with(stem) && std::regex_match(name.substr(stem.size()), more) &&
        std::ranges::none_of(longer, [&](const auto& other) { return continues(name, other); }) &&
        entry.is_directory(ignored) && holds("out/" + name)) {
      names.push_back("out/" + name);
    }
  }
  std::ranges::sort(names);
  return names;
}

std::string StudyFolder::fresh_folder(const std::string& definition,
                                      const std::string& purpose) const {
  for (int number = 1;; ++number) {
    std::string name = fmt::format("out/{}-{}-{:03}", stem_of(definition), purpose, number);
    if (!fs::exists(fs::symlink_status(root_ / name))) {
      return name;
    }
  }
}

StampedText StudyFolder::read(const fs::path& file, std::uintmax_t most) const {
  std::error_code error;
  const std::uintmax_t size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  if (size > most) {
    throw InputError(fmt::format("{} has {} bytes; the studio reads files of at most {}",
                                 file.filename().string(), size, most));
  }
  std::string text = file_text(file);
  std::string stamp = stamp_of(text);
  return {std::move(text), std::move(stamp)};
}

std::string StudyFolder::save(const std::string& name, const std::string& text,
                              const std::string& stamp) const {
  const fs::path file = definition(name);
  const std::lock_guard lock(saving_);  // from the comparison to the new text
  if (read(file, kMostText).stamp != stamp) {
    throw InputError(fmt::format(
        "{} was changed by another program since it was read here; nothing was saved", name));
  }
  write_whole(file, text);
  return stamp_of(text);
}

}  // namespace haptrial::experiments
