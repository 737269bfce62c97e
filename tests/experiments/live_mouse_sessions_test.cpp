// Every shipped definition at a mouse and a window: it begins, the person ends it by Escape or the
// window's close button, it is resumed, the experimenter ends it, and its file is whole.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/registry.h"
#include "tests/experiments/command.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"

namespace haptrial::experiments::live_mouse_sessions_test {
namespace {

namespace fs = std::filesystem;
using test::VirtualDisplay;

fs::path definition_of(const std::string& name) {
  return fs::path(HAPTRIAL_SOURCE_DIR "/experiments") / (name + ".toml");
}

/// Those in the folder of shipped definitions, without files of texts.
std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(HAPTRIAL_SOURCE_DIR "/experiments")) {
    const std::string name = entry.path().stem().string();
    if (entry.path().extension() == ".toml" && name.find('.') == std::string::npos) {
      names.push_back(name);
    }
  }
  std::sort(names.begin(), names.end());
  return names;
}

class MouseSessionTest : public testing::TestWithParam<std::string> {
 protected:
  std::string run(const std::string& more) const {
    const auto d = load_experiment(definition_of(GetParam())).definition;
    const char* second = protocols::tips_of(d->arms()) > 1 ? " --device virtual" : "";
    return "run '" + definition_of(GetParam()).string() + "' --device mouse" + second +
           " --window --out '" + folder_.path().string() + "' --subject S01 " + more;
  }
  fs::path partial() const { return folder_ / "S01.h5.partial"; }
  bool has_begun() const {
    try {
      return !record::SessionReader(partial()).begun().empty();
    } catch (const std::exception&) {  // not there yet, or being written
      return false;
    }
  }
  /// Leaves texts and pages until a pass has begun, then the session.
  void sit_at_the_mouse(const std::string& title, bool closes) const {
    test::LiveCommand session(run(""));
    ASSERT_TRUE(session.reaches([&] {
      display_.try_key(title, ' ');
      display_.try_key(title, VirtualDisplay::kEnter);
      return has_begun();
    })) << session.errors();
    if (closes) {
      display_.ask_to_close(title);
    } else {
      display_.press_key(title, VirtualDisplay::kEscape);
    }
    EXPECT_EQ(session.wait().status, 1) << session.errors();
  }
  static void expect_whole(const fs::path& file) {
    const record::SessionReader reader(file);
    const record::Integrity report = record::check_session(reader, known_tables());
    EXPECT_TRUE(report.ok) << testing::PrintToString(report.problems);
  }

  test::TemporaryFolder folder_;
  VirtualDisplay display_{800, 600};
};

TEST_P(MouseSessionTest, IsEndedByAPersonAndResumedAndEndedByTheExperimenter) {
  const std::vector<std::string> names = shipped_names();
  const auto place = std::find(names.begin(), names.end(), GetParam()) - names.begin();
  const std::string title = load_experiment(definition_of(GetParam())).definition->screen.title;
  ASSERT_NO_FATAL_FAILURE(sit_at_the_mouse(title, place % 2 == 1));
  expect_whole(partial());
  const test::CommandResult alone =
      test::run_command("haptrial run '" + definition_of(GetParam()).string() + "' --out '" +
                        folder_.path().string() + "' --subject S01 --resume");
  EXPECT_EQ(alone.status, 2) << "a virtual participant would finish a person's session";
  EXPECT_THAT(alone.errors, testing::HasSubstr("was recorded with a person, on the device mouse; "
                                               "resume it with --device mouse, not virtual"));
  test::LiveCommand session(run("--resume --console"));
  test::ConsolePerson experimenter(session.line_after("console: "));
  ASSERT_TRUE(experimenter.sees("instructions")) << session.errors();
  ASSERT_TRUE(experimenter.ask("end")) << session.errors();
  EXPECT_EQ(session.wait().status, 0) << session.errors();
  ASSERT_TRUE(fs::exists(folder_ / "S01.h5"));
  expect_whole(folder_ / "S01.h5");
}

INSTANTIATE_TEST_SUITE_P(Shipped, MouseSessionTest, testing::ValuesIn(shipped_names()),
                         [](const auto& tested) { return tested.param; });

}  // namespace
}  // namespace haptrial::experiments::live_mouse_sessions_test
