// Code that runs, records, shows and exports sessions knows protocols only through their interface.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>
#include <vector>

namespace haptrial::seam_test {
namespace {

namespace fs = std::filesystem;
using testing::IsEmpty;
using testing::SizeIs;

const fs::path kRoot = HAPTRIAL_SOURCE_DIR;

std::vector<std::string> names_in(std::string text) {
  // Examples in texts of help are no names: "haptrial run experiments/force_training.toml".
  text = std::regex_replace(text, std::regex(R"((experiments|out|results)/force_training[\w./-]*)"),
                            "");
  static const std::regex name(
      R"(force_training|bone_drilling|construct_validity|\b(Force|Bone)(Definition|Trials|Replay|Training|Study)\w*|\bDrilling[A-Z]\w*|\bBoneDrilling\w*|core/bone\b)"
      R"(|core/subject/drilling|core/render/bone)");
  std::vector<std::string> found;
  for (std::sregex_iterator it(text.begin(), text.end(), name), end; it != end; ++it) {
    found.push_back(it->str());
  }
  return found;
}

TEST(SeamTest, ANameIsFound) {
  EXPECT_THAT(names_in("if (definition.protocol == \"bone_drilling\") {"), SizeIs(1));
  EXPECT_THAT(names_in("#include \"protocols/force_training/force_trials.h\""), SizeIs(1));
  EXPECT_THAT(names_in("const auto& d = dynamic_cast<const BoneDefinition&>(definition);"),
              SizeIs(1));
  EXPECT_THAT(names_in("haptrial run experiments/force_training.toml --subject P01"), IsEmpty());
}

TEST(SeamTest, NothingThatServesEveryProtocolNamesOne) {
  constexpr std::array kFolders{"core/base",
                                "core/realtime",
                                "core/device",
                                "core/record/table",
                                "core/record/rows",
                                "core/record/hdf5",
                                "core/record/read",
                                "core/record/recovery",
                                "core/stimulus",
                                "core/stream",
                                "core/render/gl",
                                "core/render/flat",
                                "protocols/interface",
                                "analysis/exchange",
                                "analysis/quality",
                                "experiments/control",
                                "experiments/screen",
                                "experiments/server",
                                "experiments/console",
                                "experiments/runner",
                                "experiments/study",
                                "experiments/command",
                                "experiments/command/sessions",
                                "experiments/command/analysis"};
  for (const char* folder : kFolders) {
    int files = 0;
    for (const auto& entry : fs::directory_iterator(kRoot / folder)) {
      const fs::path kind = entry.path().extension();
      if (kind == ".h" || kind == ".cpp") {
        std::ifstream in(entry.path());
        const std::string text(std::istreambuf_iterator<char>(in), {});
        EXPECT_THAT(names_in(text), IsEmpty()) << entry.path();
        ++files;
      }
    }
    EXPECT_GT(files, 0) << folder;
  }
}

}  // namespace
}  // namespace haptrial::seam_test
