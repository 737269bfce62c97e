// `haptrial run --window` on a display without a monitor: what is on the screen while a session
// goes on, against what its file holds afterwards.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/record/read/integrity.h"
#include "core/record/read/session_reader.h"
#include "core/render/flat/trial_display.h"
#include "protocols/force_training/force_definition.h"
#include "tests/core/render/flat/pixels.h"
#include "tests/experiments/console_person.h"
#include "tests/experiments/frame_periods.h"
#include "tests/experiments/live_command.h"
#include "tests/experiments/shipped.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/virtual_display.h"
#include "tests/support/wait.h"

namespace haptrial::live_window_test {
namespace {

using render::Blob;
using render::Image;
using test::CommandResult;
using test::ConsolePerson;
using test::LiveCommand;
using testing::HasSubstr;

constexpr int kDisplayWidth = 1000;
constexpr int kDisplayHeight = 700;

Image part(const Image& image, int left, int top, int width, int height) {
  Image out{width, height, {}};
  for (int y = top; y < top + height; ++y) {
    const auto row = image.rgb.begin() + 3 * (static_cast<std::ptrdiff_t>(y) * image.width + left);
    out.rgb.insert(out.rgb.end(), row, row + 3 * static_cast<std::ptrdiff_t>(width));
  }
  return out;
}

/// Content of a picture of a trial.
struct Seen {
  Eigen::Vector2d marker;     // [px]
  double target_height{0.0};  // of the bars [px]
  double applied_height{0.0};
  int curve{0};  // pixels
};

class LiveWindowTest : public testing::TestWithParam<bool> {
 protected:
  void SetUp() override {
    display_.emplace(kDisplayWidth, kDisplayHeight);
    test::write_text(
        folder_ / "study.toml",
        test::attended_text({{"conditions", "conditions = [\"visuohaptic\"]"},
                             {"full_screen", full() ? "full_screen = true" : "full_screen = false"},
                             {"width", "width = 800"},
                             {"height", "height = 600"},
                             {"photodiode", "photodiode = \"run\""}}));
    definition_ = protocols::load_force_definition(folder_ / "study.toml");
    style_ = definition_->display;
    if (full()) {
      style_.width = kDisplayWidth;
      style_.height = kDisplayHeight;
    }
  }
  static bool full() { return GetParam(); }
  std::string run() const {
    return "run '" + (folder_ / "study.toml").string() + "' --subject S01 --out '" +
           (folder_ / "out").string() + "' --window --console";
  }
  Image on_monitor() const { return {kDisplayWidth, kDisplayHeight, display_->screenshot()}; }
  /// Area that the program draws on: the whole monitor, or a window in its middle.
  Image on_screen() const {
    return part(on_monitor(), (kDisplayWidth - style_.width) / 2,
                (kDisplayHeight - style_.height) / 2, style_.width, style_.height);
  }
  bool patch_is_white() const { return shade_of_patch() == 255.0; }
  double shade_of_patch() const { return render::pixel(on_screen(), 5, style_.height - 6).x(); }

  void expect_instructions() const {
    test::wait_until(
        [&] { return render::find(on_screen(), style_.marker_colour).count > 1000; });  // letters
    const Image page = on_screen();
    EXPECT_EQ(render::find(page, style_.target_colour).count, 0) << "no bar";
    EXPECT_EQ(render::find(page, style_.trajectory_colour).count, 0) << "no path";
    EXPECT_TRUE(render::has_colour(page, 2, 2, style_.background));
    EXPECT_EQ(render::has_colour(on_monitor(), 2, 2, style_.background), full())
        << "a full screen leaves nothing of the monitor, a window does";
    EXPECT_EQ(shade_of_patch(), 0.0);
  }

  /// A picture with both bars, if the moment is one.
  std::optional<Seen> look() const {
    const Image image = on_screen();
    const Blob target = render::find(image, style_.target_colour);
    const Blob applied = render::find(image, style_.applied_colour);
    const Blob marker = render::find(image, style_.marker_colour);
    if (target.bottom - target.top < 20 || applied.bottom - applied.top < 20 ||
        marker.right - marker.left > 3.0 * style_.marker_radius) {
      return std::nullopt;
    }
    return Seen{marker.centre, target.bottom - target.top + 1.0, applied.bottom - applied.top + 1.0,
                render::find(image, style_.trajectory_colour).count};
  }

  void expect_file_agrees(const std::vector<Seen>& pictures) const;
  void expect_frames(const record::SessionReader& reader) const;

  test::TemporaryFolder folder_;
  std::optional<test::VirtualDisplay> display_;
  std::optional<protocols::ForceDefinition> definition_;
  render::TrialDisplayStyle style_;
};

/// Some tick of the run had the position and the two forces that a picture showed. Of several
/// pictures: one that was taken while the server was copying is half of the frame before.
void LiveWindowTest::expect_file_agrees(const std::vector<Seen>& pictures) const {
  const record::SessionReader reader(folder_ / "out/S01.h5");
  const record::PassRow pass = reader.passes().at(0);
  const stimulus::Stimulus stimulus = stimulus::make_stimulus(
      definition_->trajectory, definition_->force_pattern, pass.stimulus_seed);
  const std::vector<Eigen::Vector3d>& points = stimulus.path.points();

  // The same scene drawn off screen says where two points of the path are: the scale and the place.
  const auto marker_at = [&](const Eigen::Vector3d& tool) {
    stimulus::Presentation scene;
    scene.show_trajectory = true;
    scene.tool = tool;
    return render::find(render::render_presentation(style_, points, scene), style_.marker_colour)
        .centre;
  };
  const Eigen::Vector2d first = marker_at(points.front());
  const Eigen::Vector2d last = marker_at(points.back());
  const double scale = (last.x() - first.x()) / (points.back().x() - points.front().x());  // [px/m]
  const double newton = style_.bar_height / style_.full_scale;                             // [px/N]
  const std::uint64_t count = pass.last_sample - pass.first_sample + 1;
  double nearest = 1e9;
  for (const record::Sample& sample : reader.samples(pass.first_sample, count)) {
    for (const Seen& seen : pictures) {
      if (sample.stage != record::Stage::kRun) {
        continue;
      }
      const Eigen::Vector3d way = scale * (sample.position - points.front());
      const double place = (first + Eigen::Vector2d(way.x(), way.z()) - seen.marker).norm();
      const double target = std::abs(newton * sample.target_force - seen.target_height);
      const double applied = std::abs(newton * sample.applied_force - seen.applied_height);
      nearest = std::min(nearest, std::max({place, target, applied}));
    }
  }
  EXPECT_LT(nearest, 2.5) << "pixels";
  stimulus::Presentation path;
  path.show_trajectory = true;
  path.tool = Eigen::Vector3d::Constant(std::nan(""));  // not drawn
  const int curve =
      render::find(render::render_presentation(style_, points, path), style_.trajectory_colour)
          .count;
  for (const Seen& seen : pictures) {
    EXPECT_GT(seen.curve, curve / 2) << "the rest is under the marker and the bars";
    EXPECT_LE(seen.curve, curve);
  }
}

void LiveWindowTest::expect_frames(const record::SessionReader& reader) const {
  const std::vector<record::FrameRow> frames = reader.frames();
  ASSERT_GT(frames.size(), 40u);
  // Xvfb has no refresh, so a timer of 60 Hz sets the pace: each period has a picture, or is
  // counted as missed. The first pictures of a kind take longer.
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].time_ns, frames[i - 1].time_ns);
  }
  EXPECT_LT(test::unaccounted_periods(frames, 60.0), 2.0);
  const record::Sample end = reader.samples(reader.sample_count() - 1, 1).front();
  EXPECT_NEAR(1e-9 * static_cast<double>(frames.back().time_ns - end.time_ns), 0.0, 60.0)
      << "to the session's end, on its clock, which did not begin with the machine's";
}

TEST_P(LiveWindowTest, ShowsWhatTheFileHolds) {
  LiveCommand session(run());
  ConsolePerson person(session.line_after("console: "));
  ASSERT_TRUE(person.sees("instructions")) << session.errors();
  expect_instructions();

  ASSERT_TRUE(person.ask("start"));
  ASSERT_TRUE(person.sees("running", "run"));
  std::vector<Seen> pictures;
  test::wait_until([&] {
    if (const auto seen = look()) {
      pictures.push_back(*seen);
    }
    return pictures.size() == 5;
  });  // path, cursor and both bars
  test::wait_until([&] { return patch_is_white(); });

  display_->press_key(definition_->screen.title, 0xff1b);  // Escape at the participant's keyboard
  ASSERT_TRUE(person.sees("stopped"));
  EXPECT_EQ(person.status()["applied_force"], 0.0);
  test::wait_until([&] { return shade_of_patch() == 0.0; });  // the run is over
  ASSERT_TRUE(person.ask("end"));
  const CommandResult ended = session.wait();
  ASSERT_EQ(ended.status, 0) << ended.errors;

  const record::SessionReader reader(folder_ / "out/S01.h5");
  EXPECT_TRUE(record::check_session(reader).ok);
  expect_frames(reader);
  expect_file_agrees(pictures);
  const CommandResult info =
      test::run_command("haptrial info '" + (folder_ / "out/S01.h5").string() + "'");
  EXPECT_THAT(info.output, HasSubstr("frames      " + std::to_string(reader.frames().size())));
}

std::string name_of(const testing::TestParamInfo<bool>& full) {
  return full.param ? "FullScreen" : "Window";
}
INSTANTIATE_TEST_SUITE_P(All, LiveWindowTest, testing::Bool(), name_of);

TEST(LiveWindowWithoutDisplayTest, IsASentenceAndLeavesNothing) {
  const test::TemporaryFolder folder;
  const CommandResult result =
      test::run_command("unset DISPLAY; haptrial run '" + test::shipped_definition().string() +
                        "' --subject S01 --window --out '" + (folder / "out").string() + "'");
  EXPECT_EQ(result.status, 1);
  EXPECT_THAT(result.errors, HasSubstr("DISPLAY"));
  EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
  EXPECT_FALSE(std::filesystem::exists(folder / "out/S01.h5.partial"));
}

}  // namespace
}  // namespace haptrial::live_window_test
