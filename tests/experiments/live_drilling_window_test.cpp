// A drilling on the real clock in a window without a monitor: every key of the definition does what
// it is for, is recorded, and is seen again in the replay.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "core/bone/record/drilling_tables.h"
#include "core/bone/simulator/simulator.h"
#include "core/record/read/session_reader.h"
#include "core/render/bone/bone_stills.h"
#include "tests/core/render/flat/pixels.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/experiments/small_drilling.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial {
namespace {

namespace fs = std::filesystem;
using bone::Function;
using render::Image;
using testing::HasSubstr;

constexpr int kWidth = 640;  // of the window
constexpr int kHeight = 480;

using Rows = std::vector<record::ToolRow>;
constexpr double kLimit = 3600.0;  // of a drilling, which the finish key ends [s]

/// The rows of a drilling in which a function's key, and no other, was held.
Rows held_rows(const Rows& rows, Function function) {
  Rows held;
  std::ranges::copy_if(rows, std::back_inserter(held), [&](const record::ToolRow& row) {
    return row.active && row.keys == bone::bit(function);
  });
  return held;
}

bool long_enough(const Rows& held) { return held.size() > 300; }

bool carries(const Rows& held) {
  return std::ranges::any_of(held, [](const record::ToolRow& row) { return row.mode == 3; });
}

class LiveDrillingWindowTest : public testing::Test {
 protected:
  void SetUp() override { display_.emplace(kWidth, kHeight); }
  /// A small drilling with every kind of tool, stills and a key for everything.
  void write_study(const std::string& carry, bool stereo) {
    const fs::path file = test::write_small_drilling(
        folder_.path(), kLimit,
        {{"in_hand", "in_hand = [\"cutting\", \"saw\", \"miniplate\", \"forceps\", \"suction\"]"},
         {"strokes_to_suction", "strokes_to_suction = 1000"},
         {"carry", "carry = [\"" + carry + "\"]\napply = [\"A\"]\ndetach = [\"D\"]"},
         {"full_screen", "full_screen = false"},
         {"stereo", std::string("stereo = ") + (stereo ? "true" : "false") + "\nstills = 2"}});
    std::string text = test::read_text(file);
    text = test::replaced(
        text, "[tools.diamond]\ntype = \"burr\"\nkind = \"diamond\"\ndiameter = 0.003  # [m]",
        "[tools.saw]\ntype = \"cut_plane\"\nwidth = 0.06\nheight = 0.04\ndepth = "
        "0.01\n[tools.miniplate]\ntype = \"plate\"\n"
        "shape = \"straight\"\n[tools.forceps]\ntype = \"grip\"\nreach = 0.01");
    text = test::replaced(text, "zoom_out = [\"O\"]", "zoom_out = [\"O\"]\nstill = [\"B\"]");
    text = test::replaced(text, "photodiode = \"off\"",
                          "photodiode = \"off\"\nparticipant_steers = true");
    text = test::replaced(text, "width = 1280", "width = " + std::to_string(kWidth));
    text = test::replaced(text, "height = 720", "height = " + std::to_string(kHeight));
    test::write_text(file,
                     text +
                         "\n[cavity]\nbeside = \"facial nerve\"\noffset = [0.0, 0.0025, 0.0]\n"
                         "radius = 0.003\nmargin = 0.0005\n");
  }
  std::string run(const std::string& more) const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / "out").string() + "' --window " + more;
  }
  fs::path partial() const { return folder_ / "out" / "S01.h5.partial"; }
  fs::path file() const { return folder_ / "out" / "S01.h5"; }
  bool drills(test::LiveCommand& session) const {
    return session.reaches([&] {
      display_->try_key("haptrial", test::VirtualDisplay::kEnter);  // to begin
      std::error_code ignored;
      return fs::exists(partial(), ignored) &&
             record::SessionReader(partial()).count<record::RemovalRow>() > 0;
    });
  }
  Image screen() const { return {kWidth, kHeight, display_->screenshot()}; }
  bool shows_still() const {
    const Eigen::Vector4d place =
        render::BoneStills::place_of(Image{kWidth / 2, kHeight / 2, {}}, kWidth, kHeight);
    return render::has_colour(screen(), static_cast<int>(place[0]) - 1,
                              static_cast<int>(place[1]) + 5, {0.55, 0.55, 0.55});
  }
  void tap(char key) const { display_->press_key("haptrial", static_cast<unsigned long>(key)); }
  /// Holds a key until the file says that the function was held so long, and that it ended.
  void hold(char key, Function function, const std::function<bool(const Rows&)>& enough) const {
    const std::uint64_t before = record::SessionReader(partial()).count<record::ToolRow>();
    display_->hold_key("haptrial", static_cast<unsigned long>(key));
    test::wait_until([&] { return enough(held_rows(rows_from(before), function)); });
    display_->release_key("haptrial", static_cast<unsigned long>(key));
    test::wait_until([&] { return rows_from(before).back().keys == 0; });
  }
  Rows rows_from(std::uint64_t first) const {
    const record::SessionReader reader(partial());
    return reader.rows<record::ToolRow>(first, reader.count<record::ToolRow>() - first);
  }

  test::TemporaryFolder folder_;
  std::optional<test::VirtualDisplay> display_;
};

/// Events while a function's key was held.
struct Held {
  std::set<int> modes;
  std::set<int> tools;
  std::set<bool> power;
};

Held while_held(const Rows& rows, Function function) {
  Held held;
  for (const record::ToolRow& row : held_rows(rows, function)) {
    held.modes.insert(row.mode);
    held.tools.insert(row.tool);
    held.power.insert(row.power);
  }
  return held;
}

TEST_F(LiveDrillingWindowTest, EveryKeyDoesItsPartAndTheReplayKnows) {
  write_study("G", false);
  test::LiveCommand session(run(""));
  ASSERT_TRUE(drills(session)) << session.errors();
  EXPECT_FALSE(shows_still());
  hold('b', Function::kStill, long_enough);
  test::wait_until([&] { return shows_still(); });
  hold('b', Function::kStill, long_enough);
  hold('b', Function::kStill, long_enough);
  test::wait_until([&] { return !shows_still(); });  // after the last none
  for (const auto& [key, function] : std::vector<std::pair<char, Function>>{
           {'m', Function::kCameraMove},
           {'v', Function::kCameraTurn},
           {'i', Function::kZoomIn},
           {'o', Function::kZoomOut},
           // The virtual hand turns the view now and then: nothing is carried meanwhile.
           {'g', Function::kCarry},
           {'t', Function::kNextTool},
           {'a', Function::kApply},
           {'a', Function::kApply},
           {'a', Function::kApply},
           {'t', Function::kNextTool},
           {'a', Function::kApply},
           {'d', Function::kDetach},
           {' ', Function::kPower}}) {
    hold(key, function, function == Function::kCarry ? carries : long_enough);
  }
  tap('f');
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;

  const record::SessionReader reader(file());
  // Nothing before the first picture: neither a sample of the pass nor a cut.
  const std::vector<record::EventRow> events = reader.events();
  const auto picture = std::find_if(events.begin(), events.end(), [](const auto& event) {
    return event.kind == "first_picture";
  });
  ASSERT_NE(picture, events.end());
  const std::uint64_t first_sample = reader.passes().at(0).first_sample;
  EXPECT_LE(picture->time_ns, reader.samples(first_sample, 1).at(0).time_ns);
  for (const record::RemovalRow& row : reader.rows<record::RemovalRow>()) {
    ASSERT_GE(row.sequence, first_sample);
  }
  const auto rows = reader.rows<record::ToolRow>();
  EXPECT_THAT(while_held(rows, Function::kCameraMove).modes, testing::Contains(1));
  EXPECT_THAT(while_held(rows, Function::kCameraTurn).modes, testing::Contains(2));
  EXPECT_THAT(while_held(rows, Function::kCarry).modes, testing::Contains(3));
  EXPECT_THAT(while_held(rows, Function::kNextTool).tools, testing::IsSupersetOf({1, 2}));
  EXPECT_THAT(while_held(rows, Function::kApply).tools, testing::IsSupersetOf({1, 2}));
  EXPECT_THAT(while_held(rows, Function::kDetach).tools, testing::Contains(2));
  EXPECT_FALSE(while_held(rows, Function::kPower).modes.empty());
  EXPECT_LT(static_cast<double>(rows.size()), 1000.0 * kLimit) << "finish ended it before its time";
  int asked = 0;
  std::uint32_t before = 0;
  for (const record::ToolRow& row : rows) {
    asked += (row.keys & ~before & bone::bit(Function::kStill)) != 0 ? 1 : 0;
    before = row.keys;
  }
  EXPECT_EQ(asked, 3);
  double narrowest = 10.0;
  double first = 0.0;
  for (const record::CameraRow& row : reader.rows<record::CameraRow>()) {
    first = first == 0.0 ? row.field_of_view : first;
    narrowest = std::min(narrowest, row.field_of_view);
  }
  EXPECT_LT(narrowest, 0.9 * first) << "0.3 s of zoom";
  EXPECT_GT(reader.rows<record::ProcedureRow>().at(0).cut, 0.0) << "the cut plane cut";

  const test::CommandResult replay = test::run_command("haptrial replay '" + file().string() + "'");
  EXPECT_EQ(replay.status, 0) << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("trial 1: the same bone"));
}

/// The two halves of the window, each with bone that the other does not have in the same places.
TEST_F(LiveDrillingWindowTest, TwoEyesAreShownAndKeysOfTheDefinitionDoNotSteer) {
  write_study("R", true);
  test::LiveCommand session(run("--console"));
  test::ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(drills(session)) << session.errors();
  const Image image = screen();
  int same = 0;
  std::array<int, 2> bright{};
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth / 2; ++x) {
      const Eigen::Vector3d left = render::pixel(image, x, y);
      const Eigen::Vector3d right = render::pixel(image, kWidth / 2 + x, y);
      bright[0] += left.sum() > 200.0 ? 1 : 0;
      bright[1] += right.sum() > 200.0 ? 1 : 0;
      same += left == right ? 1 : 0;
    }
  }
  EXPECT_GT(bright[0], 300);
  EXPECT_NEAR(bright[0], bright[1], 0.3 * bright[0]);
  EXPECT_LT(same, kWidth / 2 * kHeight - 300);
  hold('r', Function::kCarry, carries);  // and repeats nothing
  EXPECT_EQ(person.status()["aborted_passes"], 0);
  tap('s');  // not of the definition: skips
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  const record::SessionReader reader(file());
  ASSERT_EQ(reader.passes().size(), 1u);
  EXPECT_EQ(reader.passes()[0].status, record::PassStatus::kAborted);
  EXPECT_THAT(while_held(reader.rows<record::ToolRow>(), Function::kCarry).modes,
              testing::Contains(3));
}

TEST_F(LiveDrillingWindowTest, EscapeStopsASessionThatNobodyAttends) {
  write_study("G", false);
  test::LiveCommand session(run(""));
  ASSERT_TRUE(drills(session)) << session.errors();
  display_->press_key("haptrial", 0xff1b);
  const test::CommandResult ended = session.wait();
  EXPECT_NE(ended.status, 0);
  EXPECT_THAT(ended.errors, HasSubstr("; continue with --resume"));
  EXPECT_TRUE(fs::exists(partial()));
}

}  // namespace
}  // namespace haptrial
