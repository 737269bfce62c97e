#include "experiments/studies/experiment.h"

#include <fmt/format.h>

#include <array>
#include <fstream>
#include <string_view>
#include <system_error>

#include "core/base/definition/table.h"
#include "core/base/error.h"
#include "experiments/studies/registry.h"
#include "protocols/definition/lab_file.h"

namespace haptrial::experiments {
namespace {

void refuse_session(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return;  // a pipe would wait here; load_with_lab() refuses it
  }
  std::array<char, 8> first{};
  std::ifstream(file, std::ios::binary).read(first.data(), first.size());
  if (std::string_view(first.data(), first.size()) == "\x89HDF\r\n\x1a\n") {
    throw InputError(file.string() + ": is a session file; give a definition (.toml)");
  }
}

Experiment read(Table& root, std::string_view file_name, const std::filesystem::path* folder) {
  Experiment experiment;
  experiment.study = &study_of(root);
  experiment.definition = experiment.study->protocol().read(root, file_name, folder);
  experiment.study->read_analysis(root, folder != nullptr);
  protocols::check_markers(root, *experiment.definition);
  root.finish();
  return experiment;
}

}  // namespace

Experiment load_experiment(const std::filesystem::path& file) {
  const std::filesystem::path folder = file.parent_path();
  refuse_session(file);
  Table root = protocols::load_with_lab(file);
  Experiment experiment = read(root, file.string(), &folder);
  experiment.study->protocol().load(*experiment.definition, folder);
  return experiment;
}

Experiment parse_experiment(std::string_view text, std::string_view file_name) {
  Table root = Table::parse(text, file_name);
  return read(root, file_name, nullptr);
}

std::vector<std::string> warnings_of(const Experiment& experiment) {
  std::vector<std::string> warnings = experiment.definition->warnings();
  for (std::string& warning : experiment.study->analysis_warnings(*experiment.definition)) {
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

void print_warnings(const Experiment& experiment) {
  for (const std::string& warning : warnings_of(experiment)) {
    fmt::print("warning: {}\n", warning);
  }
}

}  // namespace haptrial::experiments
