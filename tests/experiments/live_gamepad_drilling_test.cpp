// A game controller drills the shipped bone in a window, and hints are seen there. A pipe stands
// for the controller.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <thread>

#include "core/bone/hint/hint_rows.h"
#include "core/bone/record/drilling_tables.h"
#include "core/record/read/session_reader.h"
#include "core/render/gl/image.h"
#include "tests/experiments/command.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/event_records.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial::live_gamepad_drilling_test {
namespace {

namespace fs = std::filesystem;
using test::VirtualDisplay;
using testing::HasSubstr;

constexpr const char* kTitle = "haptrial";

/// Folder for the documents' pictures: the whole window and the bone as it is shipped, pictures
/// kept there.
const char* kept_pictures() { return std::getenv("HAPTRIAL_KEEP_PICTURES"); }

/// A file of safe values for the documents' picture; else what is hidden is hinted at, alone.
std::string hints() {
  const char* file = std::getenv("HAPTRIAL_SAFE_VALUES");
  return file != nullptr ? "\n[hints]\nfile = \"" + std::string(file) + "\"\n"
                         : "\n[hints]\nkinds = [\"hidden\"]\nfewest = 1\n";
}

class LiveGamepadDrillingTest : public testing::Test {
 protected:
  void SetUp() override {
    display_.emplace(width_, height_);
    std::string text =
        test::read_text(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/first_drilling.toml");
    text = test::replaced(text, "card = true", "card = false");
    text = test::replaced(text, "time_limit = 120.0", "time_limit = 3600.0");
    if (kept_pictures() == nullptr) {  // what takes time
      text = test::replaced(text, "width = 1280", "width = " + std::to_string(width_));
      text = test::replaced(text, "height = 720", "height = " + std::to_string(height_));
      text = test::replaced(text, "seed = 1 ", "spacing = 0.0008\nseed = 1 ");
    }
    text += "\n[gamepad]\ninput = \"" + (folder_ / "pad").string() + "\"\n" + hints();
    test::write_text(folder_ / "study.toml", text);
    signal(SIGPIPE, SIG_IGN);
    ASSERT_EQ(mkfifo((folder_ / "pad").c_str(), 0600), 0);
  }
  fs::path file() const { return folder_ / "out/P01.h5"; }
  template <class Row>
  std::uint64_t rows() const {
    try {
      return record::SessionReader(file().string() + ".partial").count<Row>();
    } catch (const std::exception&) {  // not there yet
      return 0;
    }
  }
  double tilt() const {  // of the tool in the last row [rad]
    const record::SessionReader reader(file().string() + ".partial");
    const std::uint64_t last = reader.count<record::ToolRow>() - 1;
    return reader.rows<record::ToolRow>(last, 1)[0].orientation.angularDistance(
        Eigen::Quaterniond::Identity());
  }
  bool tells(const std::string& kind) const {
    const auto events = record::SessionReader(file().string() + ".partial").events();
    return std::ranges::find(events, kind, &record::EventRow::kind) != events.end();
  }
  void put(int type, int code, int value) {
    if (writer_ < 0) {
      test::wait_until([&] {  // somebody reads
        writer_ = open((folder_ / "pad").c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC);
        return writer_ >= 0;
      });
    }
    std::vector<std::byte> bytes;
    test::add_record(bytes, type, code, value);
    test::add_record(bytes, EV_SYN, SYN_REPORT, 0);
    EXPECT_EQ(write(writer_, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  }
  void stick(int axis, double share) { put(EV_ABS, axis, static_cast<int>(32767 * share)); }
  void hang_up() {
    close(writer_);
    writer_ = -1;
  }
  void TearDown() override {
    if (writer_ >= 0) {
      hang_up();
    }
  }
  void keep(const std::string& name) const {
    if (const char* folder = kept_pictures()) {
      render::write_png(fs::path(folder) / name,
                        render::Image{width_, height_, display_->screenshot()});
    }
  }

  int width_{kept_pictures() != nullptr ? 1280 : 640};
  int height_{kept_pictures() != nullptr ? 720 : 480};
  int writer_{-1};
  test::TemporaryFolder folder_;
  std::optional<VirtualDisplay> display_;
};

TEST_F(LiveGamepadDrillingTest, SticksTriggersAndButtonsDrillAndALossIsRecorded) {
  test::LiveCommand session("run '" + (folder_ / "study.toml").string() + "' --out '" +
                            (folder_ / "out").string() + "' --device gamepad --window");
  ASSERT_TRUE(session.reaches([&] {
    display_->try_key(kTitle, VirtualDisplay::kEnter);
    return rows<record::ToolRow>() > 0;
  })) << session.errors();
  put(EV_KEY, BTN_SOUTH, 1);
  put(EV_ABS, ABS_RZ, 255);
  ASSERT_TRUE(session.reaches([&] { return rows<record::RemovalRow>() > 0; }))
      << "the right trigger takes the burr into the bone";
  // Strokes from side to side under a burr that is pressed on; deep holes have hidden walls.
  const int strokes = kept_pictures() != nullptr ? 40 : 12;
  for (int stroke = 0; stroke < strokes || rows<record::RemovalRow>() <= 50; ++stroke) {
    stick(ABS_X, stroke % 2 == 0 ? 0.8 : -0.8);
    put(EV_ABS, ABS_RZ, stroke % 4 == 3 ? 0 : 200);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    if (stroke >= 8 && rows<record::HintRow>() > 0) {
      keep("gamepad-hint-" + std::to_string(stroke) + ".png");
    }
  }
  stick(ABS_X, 0.0);
  put(EV_ABS, ABS_RZ, 0);
  stick(ABS_RX, 1.0);
  ASSERT_TRUE(session.reaches([&] { return tilt() > 0.1; })) << session.errors();
  hang_up();  // the burr stops, and the hand with it
  ASSERT_TRUE(session.reaches([&] { return tells("gamepad_lost"); })) << session.errors();
  put(EV_ABS, ABS_Z, 255);
  ASSERT_TRUE(session.reaches([&] { return tells("gamepad_back"); })) << session.errors();
  display_->press_key(kTitle, 'f');
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output + ended.errors, HasSubstr("the game controller"));

  const record::SessionReader reader(file());
  EXPECT_EQ(reader.info().device, "gamepad");
  EXPECT_FALSE(reader.info().simulated);
  std::vector<std::string> events;
  for (const record::EventRow& event : reader.events()) {
    events.push_back(event.kind);
  }
  EXPECT_THAT(events, testing::Contains("gamepad_lost"));
  EXPECT_THAT(events, testing::Contains("gamepad_back"));
  const auto tool = reader.rows<record::ToolRow>();
  EXPECT_FALSE(tool.back().power);
  EXPECT_GT(tool.back().orientation.angularDistance(Eigen::Quaterniond::Identity()), 0.1);
  EXPECT_GT(reader.count<record::RemovalRow>(), 50u);
  EXPECT_EQ(reader.passes().at(0).condition, "hints on");
  const test::CommandResult replay = test::run_command("haptrial replay '" + file().string() + "'");
  EXPECT_EQ(replay.status, 0) << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("trial 1: the same bone"));
}

TEST_F(LiveGamepadDrillingTest, WithoutATableThereIsASentence) {
  const std::string shipped = HAPTRIAL_SOURCE_DIR "/experiments/first_drilling.toml";
  const auto none = test::run_command("haptrial run '" + shipped + "' --device gamepad --window " +
                                      "--out '" + (folder_ / "none").string() + "'");
  EXPECT_EQ(none.status, 2);
  EXPECT_THAT(none.errors, HasSubstr("--device gamepad needs a table [gamepad]"));
  const auto blind = test::run_command("haptrial run '" + shipped + "' --device gamepad");
  EXPECT_EQ(blind.status, 2);
  EXPECT_THAT(blind.errors, HasSubstr("--device gamepad takes its pointer"));
}

// README's first drilling: mouse and keyboard alone drill the shipped bone in a window.

constexpr unsigned kLeft = 1;
constexpr unsigned kWheelUp = 4;
constexpr unsigned kWheelDown = 5;
constexpr unsigned long kRightKey = 0xff53;

class LiveMouseDrillingTest : public testing::Test {
 protected:
  void SetUp() override {
    display_.emplace(width_, height_);
    std::string text =
        test::read_text(fs::path(HAPTRIAL_SOURCE_DIR) / "experiments/first_drilling.toml");
    text = test::replaced(text, "card = true", "card = false");
    text = test::replaced(text, "time_limit = 120.0", "time_limit = 3600.0");
    if (kept_pictures() == nullptr) {  // what takes time
      text = test::replaced(text, "width = 1280", "width = " + std::to_string(width_));
      text = test::replaced(text, "height = 720", "height = " + std::to_string(height_));
      text = test::replaced(text, "seed = 1 ", "spacing = 0.0008\nseed = 1 ");
    }
    test::write_text(folder_ / "study.toml", text);
  }
  fs::path file() const { return folder_ / "out/P01.h5"; }
  template <class Row>
  std::uint64_t rows() const {
    try {
      return record::SessionReader(file().string() + ".partial").count<Row>();
    } catch (const std::exception&) {  // not there yet
      return 0;
    }
  }
  double tilt() const {  // of the tool in the last row [rad]
    const record::SessionReader reader(file().string() + ".partial");
    const std::uint64_t last = reader.count<record::ToolRow>() - 1;
    return reader.rows<record::ToolRow>(last, 1)[0].orientation.angularDistance(
        Eigen::Quaterniond::Identity());
  }
  void roll(unsigned wheel, int steps) const {
    for (int i = 0; i < steps; ++i) {
      display_->press_button(kTitle, wheel);
      display_->release_button(kTitle, wheel);
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
  }
  void move(double x, double y) const {  // as shares of the window
    display_->move_pointer(static_cast<int>(x * width_), static_cast<int>(y * height_));
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
  }
  void keep(const std::string& name) const {
    if (const char* folder = kept_pictures()) {
      render::write_png(fs::path(folder) / name,
                        render::Image{width_, height_, display_->screenshot()});
    }
  }

  int width_{kept_pictures() != nullptr ? 1280 : 640};
  int height_{kept_pictures() != nullptr ? 720 : 480};
  test::TemporaryFolder folder_;
  std::optional<VirtualDisplay> display_;
};

TEST_F(LiveMouseDrillingTest, WheelAndLeftButtonDrillAndTheArrowsTilt) {
  test::LiveCommand session("run '" + (folder_ / "study.toml").string() + "' --out '" +
                            (folder_ / "out").string() + "' --device mouse --window");
  ASSERT_TRUE(session.reaches([&] {
    keep("first-drilling-0.png");
    display_->try_key(kTitle, VirtualDisplay::kEnter);
    return rows<record::ToolRow>() > 0;
  })) << session.errors();
  move(0.5, 0.45);
  std::this_thread::sleep_for(std::chrono::seconds(1));
  keep("first-drilling-1.png");
  display_->press_button(kTitle, kLeft);
  test::wait_until([&] {
    roll(kWheelUp, 2);
    return rows<record::RemovalRow>() > 0;
  });  // deeper and deeper it comes to the bone
  // Strokes across a field, deeper after every eight.
  constexpr int kSteps = 12;
  for (int stroke = 0; stroke < (kept_pictures() != nullptr ? 100 : 4); ++stroke) {
    roll(kWheelUp, stroke % 8 == 7 ? 1 : 0);
    for (int i = 0; i <= kSteps; ++i) {
      const double across = static_cast<double>(stroke % 2 == 0 ? i : kSteps - i) / kSteps;
      move(0.42 + 0.12 * across, 0.40 + 0.015 * (stroke % 5));
    }
  }
  keep("first-drilling-2.png");
  display_->release_button(kTitle, kLeft);
  roll(kWheelDown, 60);
  display_->hold_key(kTitle, kRightKey);
  ASSERT_TRUE(session.reaches([&] { return tilt() > 0.1; })) << session.errors();
  display_->release_key(kTitle, kRightKey);
  keep("first-drilling-3.png");
  display_->press_key(kTitle, 'f');
  const test::CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;
  EXPECT_THAT(ended.output, HasSubstr("page: " + (folder_ / "out/P01.html").string()));
  const std::string page = test::read_text(folder_ / "out/P01.html");
  EXPECT_THAT(page, HasSubstr("P01"));
  EXPECT_THAT(page, testing::Not(HasSubstr("SIMULATED"))) << "a person drilled";

  const record::SessionReader reader(file());
  EXPECT_EQ(reader.info().device, "mouse");
  EXPECT_FALSE(reader.info().simulated);
  const auto all = reader.rows<record::ToolRow>();
  std::vector<record::ToolRow> active;
  std::copy_if(all.begin(), all.end(), std::back_inserter(active),
               [](const record::ToolRow& row) { return row.active; });
  ASSERT_GT(active.size(), 1000u);
  for (std::size_t i = 0; i < 500; ++i) {
    ASSERT_EQ(active[i].immersed, 0) << "the tip begins outside of bone, tick " << i;
  }
  double hardest = 0.0;
  for (const record::ToolRow& row : active) {
    hardest = std::max(hardest, row.contact.norm());
  }
  EXPECT_GT(hardest, 0.3);
  EXPECT_LT(hardest, 8.0) << "2.4 N of the spring, and what the tool brings along";
  EXPECT_LT(active.front().orientation.angularDistance(Eigen::Quaterniond::Identity()), 1e-3);
  EXPECT_GT(active.back().orientation.angularDistance(Eigen::Quaterniond::Identity()), 0.1);
  EXPECT_EQ(reader.passes().at(0).status, record::PassStatus::kCompleted);

  const test::CommandResult replay = test::run_command("haptrial replay '" + file().string() + "'");
  EXPECT_EQ(replay.status, 0) << replay.errors;
  EXPECT_THAT(replay.output, HasSubstr("trial 1: the same bone"));
}

}  // namespace
}  // namespace haptrial::live_gamepad_drilling_test
