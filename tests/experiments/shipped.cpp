#include "tests/experiments/shipped.h"

#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace haptrial::test {

std::filesystem::path shipped_definition() {
  return std::filesystem::path(HAPTRIAL_SOURCE_DIR) / "experiments" / "force_training.toml";
}

std::string read_text(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

std::string shipped_text() { return read_text(shipped_definition()); }

std::string shipped_with(const std::string& key, const std::string& line) {
  const std::string text = shipped_text();
  const std::regex whole_line("(^|\n)" + key + " *=[^\n]*");
  if (!std::regex_search(text, whole_line)) {
    throw std::invalid_argument("the shipped definition has no key " + key);
  }
  return std::regex_replace(text, whole_line, "$1" + line, std::regex_constants::format_first_only);
}

std::string shipped_without_noise() {
  std::string text = shipped_text();
  for (const char* key :
       {"visual_weber", "haptic_weber", "visual_memory_noise", "haptic_memory_noise", "haptic_bias",
        "bar_misjudgement", "calibration_loss", "forgetting", "production_bias", "timing_error",
        "force_noise", "tremor"}) {
    const std::regex median(std::string("(\n") + key + " *= \\{ median = )[0-9.]+");
    if (!std::regex_search(text, median)) {
      throw std::invalid_argument(std::string("the shipped definition has no key ") + key);
    }
    text = std::regex_replace(text, median, "$010.0");
  }
  return text;
}

}  // namespace haptrial::test
